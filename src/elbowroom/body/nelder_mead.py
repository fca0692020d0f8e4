"""The downhill simplex method: least values of a function of a few variables, without derivatives.

J. A. Nelder & R. Mead, "A simplex method for function minimization", Computer Journal 7 (1965), with the usual
coefficients: reflection 1, expansion 2, contraction and shrinkage 1/2. The steps are those of SciPy's, whose import
takes longer than all the rest of a start.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Function = Callable[[Floats], float]


class _SpentError(Exception):
    """No evaluations are left."""


class _Simplex:
    """n+1 points, the best first, and the function's values there."""

    def __init__(self, function: Function, points: Floats, evaluations: int) -> None:
        self._function, self._left = function, evaluations
        self.points = points.copy()
        self.values = np.array([self._at(point) for point in self.points])
        self.sort()

    def _at(self, point: Floats) -> float:
        if self._left == 0:
            raise _SpentError
        self._left -= 1
        return self._function(point)

    def sort(self) -> None:
        order = np.argsort(self.values)
        self.points, self.values = self.points[order], self.values[order]

    def is_small(self, size: float, spread: float) -> bool:
        flat = np.abs(self.values[0] - self.values[1:]).max() <= spread
        return bool(flat and np.abs(self.points[1:] - self.points[0]).max() <= size)

    def step(self) -> None:
        """Replace the worst point by a better one, or draw all points towards the best."""
        middle, worst = np.add.reduce(self.points[:-1], 0) / (len(self.points) - 1), self.points[-1]
        reflected = 2.0 * middle - worst
        value = self._at(reflected)
        if value < self.values[0]:
            expanded = 3.0 * middle - 2.0 * worst
            farther = self._at(expanded)
            self._replace(*((expanded, farther) if farther < value else (reflected, value)))
        elif value < self.values[-2]:
            self._replace(reflected, value)
        elif not self._contracted(middle, worst, value):
            self._shrink()

    def _contracted(self, middle: Floats, worst: Floats, reflected: float) -> bool:
        outside = reflected < self.values[-1]
        point = 1.5 * middle - 0.5 * worst if outside else 0.5 * middle + 0.5 * worst
        value = self._at(point)
        better = value <= reflected if outside else value < self.values[-1]
        if better:
            self._replace(point, value)
        return bool(better)

    def _replace(self, point: Floats, value: float) -> None:
        self.points[-1], self.values[-1] = point, value

    def _shrink(self) -> None:
        for j in range(1, len(self.points)):
            self.points[j] = self.points[0] + 0.5 * (self.points[j] - self.points[0])
            self.values[j] = self._at(self.points[j])


def least_point(function: Function, simplex: Floats, evaluations: int, size: float, spread: float) -> Floats:
    """The best point (n,) found from a first simplex (n+1, n), of which at least all points are evaluated.

    Ends after so many `evaluations`, or when the points lie within `size` of the best and their values within `spread`.
    """
    found = _Simplex(function, simplex, max(evaluations, len(simplex)))
    while not found.is_small(size, spread):
        try:
            found.step()
        except _SpentError:
            found.sort()
            break
        found.sort()
    best: Floats = found.points[0]
    return best
