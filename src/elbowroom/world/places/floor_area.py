"""Where the ground of a place is floor: beyond its edges nobody is led, although nothing stands there."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from elbowroom.world.places.floors import Floor

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

_STRIDE = 0.2  # metres: gaps that are no wider are stepped over, as at thresholds


@dataclass(frozen=True, eq=False)
class FloorArea:
    """A grid of squares over the ground."""

    origin: tuple[float, float]  # x, z of its corner, metres
    cell: float  # metres
    there: Flags  # (nx, nz)

    @classmethod
    def of(cls, floor: Floor) -> "FloorArea":
        """The area of a floor, thresholds included."""
        cell, around = floor.columns.cell, round(_STRIDE / floor.columns.cell) + 1
        reach = round(0.5 * _STRIDE / cell)
        disc = np.hypot(*np.mgrid[-reach : reach + 1, -reach : reach + 1]) <= reach
        closed = ndimage.binary_closing(np.pad(floor.there, around), disc)[around:-around, around:-around]
        return cls(floor.columns.origin, cell, closed)

    def holds(self, x: Floats, z: Floats) -> Flags:
        """Whether there is floor at places; any shape."""
        ix = np.floor((x - self.origin[0]) / self.cell).astype(np.int64)
        iz = np.floor((z - self.origin[1]) / self.cell).astype(np.int64)
        inside = (ix >= 0) & (ix < self.there.shape[0]) & (iz >= 0) & (iz < self.there.shape[1])
        found: Flags = inside.copy()
        found[inside] = self.there[ix[inside], iz[inside]]
        return found
