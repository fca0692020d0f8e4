"""How an obstacle is written down for the kernels: a pose and a shape, one row of numbers whatever its kind.

Only this package reads rows. Elsewhere they are handed on as they are, in `Nearby` and `Spans`.
"""

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

ROW = 18
CENTER = 0  # three numbers: the middle of the box that holds the shape, metres
TURN = 3  # nine: the rotation from the frame to the shape's own axes, row by row
HALF = 12  # three: half lengths of that box along the shape's own axes, metres
ROUNDING = 15  # by how much the shape reaches beyond that box to every side, metres
KIND = 16
DATA = 17  # where a hull or a mesh begins among those that are packed, in lines

LINE = 16  # numbers of a line of what is packed: a head, a triangle, or two edges
EDGE = 8  # begin, step, squared length, one over it

LANES = 16  # float32 lanes of the widest vector register
TILE = 7 * LANES  # numbers of a tile: one capsule in sixteen configurations, rows ax, ay, az, bx, by, bz, radius
PER_METRE = 32.0  # tiles' distances are in parts of a metre: a power of two, so changing units does not round


class ShapeKind(IntEnum):
    """Which kernel tells the distance from a shape."""

    BOX = 0
    ROUNDED = 1  # a box with rounded edges: a point for a sphere, a line for a capsule
    CYLINDER = 2
    HULL = 3
    MESH = 4  # triangles, of which both sides count, and nothing between them


class Nearby(NamedTuple):
    """B obstacles in some frame: opaque outside of this package. Shapes of varying size lie packed beside the rows."""

    rows: Floats  # (B, ROW)
    packed: Floats32  # flat


class Spans(NamedTuple):
    """The same B obstacles in each of n spans of time, or in each of n frames: opaque outside of this package."""

    rows: Floats  # (n, B, ROW)
    packed: Floats32  # flat
