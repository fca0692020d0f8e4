"""The floor that a captured motion stood on."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_REACH = 0.1  # metres that a motion must cover to show a slope
_STEEPEST = 0.03  # slope: steeper is no floor
_ROUNDS = 8  # fits, each to the lower half by the one before
_GROUNDED = 2.0  # percent of the points that may be lower than the floor


def plane_below(points: Floats, places: Floats) -> Floats:
    """Height (F,) at `places` (F, 3) of the plane that the lower of the points (N, 3) lie on; Y is up.

    It is level if the points do not reach far, or if it would slope more than a floor does.
    """
    middle = points[:, [0, 2]].mean(axis=0)
    across = points[:, [0, 2]] - middle
    design = np.column_stack([np.ones(len(points)), across])
    ridge = np.diag([0.0, 1.0, 1.0]) * len(points) * _REACH**2
    plane, away = np.zeros(3), points[:, 1]
    for _ in range(_ROUNDS):
        low = away <= np.median(away)
        inner = design[low]
        plane = np.linalg.solve(inner.T @ inner + ridge, inner.T @ points[low, 1])
        away = points[:, 1] - design @ plane
    if np.linalg.norm(plane[1:]) > _STEEPEST:
        plane, away = np.zeros(3), points[:, 1]
    height: Floats = (places[:, [0, 2]] - middle) @ plane[1:] + plane[0] + np.percentile(away, _GROUNDED)
    return height
