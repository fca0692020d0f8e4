"""The faces of a file, however they are written."""

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Write(Protocol):
    """Writes triangles."""

    def __call__(self, triangles: Ints, owners: Ints) -> bytes:
        """Triangles (T, 3) of vertices as the file has faces; all else of each as its owner (T,), a face, has it."""
        ...


class Faces(NamedTuple):
    """What is known of them."""

    points: Floats  # (V, 3) the vertices of the file
    corners: Ints  # (N,) of all faces, one after the other
    sizes: Ints  # (F,) of each
    span: tuple[int, int]  # bytes of the file in which they are
    written: Write
