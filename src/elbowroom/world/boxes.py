"""Oriented boxes, a structure of arrays."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.geometry import quaternion
from elbowroom.jit import kernel

BOX_ROW = 15  # centre 3, world-to-box rotation 9 (row major), half size 3


@dataclass(frozen=True, eq=False)
class Boxes:
    """Oriented boxes in some frame, usually the world's."""

    centers: NDArray[np.float64]  # (B, 3) metres
    rotations: NDArray[np.float64]  # (B, 4) box-to-frame quaternions, xyzw
    half_sizes: NDArray[np.float64]  # (B, 3) metres

    def __len__(self) -> int:
        return len(self.centers)

    @classmethod
    def empty(cls) -> "Boxes":
        """No box at all."""
        return cls(np.empty((0, 3)), np.empty((0, 4)), np.empty((0, 3)))

    @cached_property
    def table(self) -> NDArray[np.float64]:
        """Rows for the kernels, shape (B, 15): centre, rotation matrix frame-to-box row by row, half sizes."""
        to_box = np.swapaxes(quaternion.to_matrix(self.rotations), -1, -2).reshape(-1, 9)
        return np.concatenate([self.centers, to_box, self.half_sizes], axis=1)

    @cached_property
    def table32(self) -> NDArray[np.float32]:
        """`table` in the kernels' own precision, C-contiguous."""
        return np.ascontiguousarray(self.table, np.float32)

    @cached_property
    def corners(self) -> NDArray[np.float64]:
        """The eight corners of every box, shape (B, 8, 3)."""
        signs = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
        offsets = signs * self.half_sizes[:, None, :]
        return self.centers[:, None, :] + quaternion.rotate(self.rotations[:, None, :], offsets)

    def in_frame(self, position: ArrayLike, rotation: ArrayLike) -> "Boxes":
        """The same boxes seen from a frame at `position` (3,) with frame-to-here `rotation` (4,)."""
        back = quaternion.conjugate(rotation)
        centers = quaternion.rotate(back, self.centers - np.asarray(position, np.float64))
        return Boxes(centers, quaternion.multiply(back, self.rotations), self.half_sizes)


def tables_in_frames(table: ArrayLike, positions: ArrayLike, rotations: ArrayLike) -> NDArray[np.float32]:
    """Box tables as seen from n frames, shape (n, B, 15), float32.

    `table` (B, 15) as in `Boxes.table`; `positions` (n, 3) and `rotations` (n, 4), frame-to-world, unit quaternions.
    The arithmetic is float64: obstacles far from the world's origin lose nothing once they are near the frame's.
    """
    rows = np.ascontiguousarray(table, np.float64)
    places = np.ascontiguousarray(positions, np.float64)
    turns = np.ascontiguousarray(rotations, np.float64)
    out = np.empty((len(places), len(rows), BOX_ROW), np.float32)
    _move_tables(rows, places, turns, out)
    return out


@kernel
def _move_tables(
    table: NDArray[np.float64],
    positions: NDArray[np.float64],
    rotations: NDArray[np.float64],
    out: NDArray[np.float32],
) -> None:
    """With R, p the frame and M, c the box: x_box = M (R x + p - c) = (M R) (x - R'(c - p))."""
    frame = np.empty((3, 3))
    for n in range(positions.shape[0]):
        x, y, z, w = rotations[n, 0], rotations[n, 1], rotations[n, 2], rotations[n, 3]
        frame[0, 0], frame[0, 1], frame[0, 2] = (
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        )
        frame[1, 0], frame[1, 1], frame[1, 2] = (
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
        )
        frame[2, 0], frame[2, 1], frame[2, 2] = (
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        )
        for b in range(table.shape[0]):
            row = table[b]
            x, y, z = row[0] - positions[n, 0], row[1] - positions[n, 1], row[2] - positions[n, 2]
            for k in range(3):
                out[n, b, k] = frame[0, k] * x + frame[1, k] * y + frame[2, k] * z
                out[n, b, 12 + k] = row[12 + k]
                for i in range(3):
                    m = 3 + 3 * i
                    out[n, b, m + k] = row[m] * frame[0, k] + row[m + 1] * frame[1, k] + row[m + 2] * frame[2, k]
