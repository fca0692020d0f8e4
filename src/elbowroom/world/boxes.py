"""Oriented boxes, a structure of arrays."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from elbowroom.geometry import quaternion

BOX_ROW = 15  # centre 3, world-to-box rotation 9 (row major), half size 3


@dataclass(frozen=True, eq=False)
class Boxes:
    """Oriented boxes in some frame, usually the world's."""

    centers: NDArray[np.float64]  # (B, 3) metres
    rotations: NDArray[np.float64]  # (B, 4) box-to-frame quaternions, xyzw
    half_sizes: NDArray[np.float64]  # (B, 3) metres

    def __len__(self) -> int:
        return len(self.centers)

    @cached_property
    def table(self) -> NDArray[np.float64]:
        """Rows for the kernels, shape (B, 15): centre, rotation matrix frame-to-box row by row, half sizes."""
        to_box = np.swapaxes(quaternion.to_matrix(self.rotations), -1, -2).reshape(-1, 9)
        return np.concatenate([self.centers, to_box, self.half_sizes], axis=1)
