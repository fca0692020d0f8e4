"""Rows of obstacles: made from shapes and poses, moved into frames, bounded, picked out by place."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.geometry import quaternion
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel
from elbowroom.world.obstacles.layout import CENTER, DATA, HALF, KIND, ROUNDING, ROW, TURN, Nearby, Spans
from elbowroom.world.obstacles.meshes.packed import Packed, pack
from elbowroom.world.obstacles.shapes import Shape

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_SIGNS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


def rows_of(shapes: Sequence[Shape], centers: ArrayLike, rotations: ArrayLike, packed: Packed | None = None) -> Nearby:
    """Obstacles of these shapes (B) whose origins are at `centers` (B, 3), turned by quaternions `rotations` (B, 4).

    `packed` holds their hulls and meshes, perhaps with those of others; where absent they are packed by themselves.
    """
    held = packed or pack(shapes)
    rows = np.empty((len(shapes), ROW))
    turns = quaternion.to_matrix(np.asarray(rotations, np.float64).reshape(-1, 4))
    places = np.asarray(centers, np.float64).reshape(-1, 3)
    rows[:, TURN:HALF] = np.swapaxes(turns, -1, -2).reshape(-1, 9)
    rows[:, HALF:ROUNDING] = np.array([shape.half for shape in shapes]).reshape(-1, 3)
    rows[:, ROUNDING] = [shape.rounding for shape in shapes]
    rows[:, KIND] = [shape.kind for shape in shapes]
    rows[:, DATA] = [held.begin(shape) for shape in shapes]
    middles = np.array([shape.middle for shape in shapes]).reshape(-1, 3)
    off = middles.any(axis=1)
    rows[:, CENTER:TURN] = places
    rows[off, CENTER:TURN] += np.einsum("bij,bj->bi", turns[off], middles[off])
    return Nearby(rows, held.lines)


def some_of(near: Nearby, chosen: NDArray[np.bool_]) -> Nearby:
    """The `chosen` (B,) obstacles."""
    return Nearby(near.rows[chosen], near.packed)


def numbered(near: Nearby, numbers: Longs) -> Nearby:
    """The obstacles of these numbers (N,)."""
    return Nearby(near.rows[numbers], near.packed)


def spans_of(spans: Spans, numbers: Longs) -> Spans:
    """The spans of these numbers (N,)."""
    return Spans(spans.rows[numbers], spans.packed)


def is_empty(near: Nearby) -> bool:
    """Whether there is nothing."""
    return not len(near.rows)


def number_of(near: Nearby) -> int:
    """The number of obstacles."""
    return len(near.rows)


def has_room_for(room: Nearby, near: Nearby) -> bool:
    """Whether a room was made for obstacles with the shapes that these have, and for as many."""
    alike = near.packed is room.packed or not (len(near.packed) or len(room.packed))
    return alike and len(near.rows) <= len(room.rows)


def any_in(spans: Spans) -> bool:
    """Whether there is anything in any of the spans."""
    return bool(spans.rows.size)


def span_count(spans: Spans) -> int:
    """The number of spans."""
    return len(spans.rows)


def span_of(spans: Spans, k: int) -> Nearby:
    """The obstacles in one of the spans."""
    return Nearby(spans.rows[k], spans.packed)


def one_of(near: Nearby, b: int) -> Nearby:
    """One of the obstacles."""
    return Nearby(near.rows[b : b + 1], near.packed)


def joined(one: Nearby, other: Nearby) -> Nearby:
    """The obstacles of both; at most one of them has something packed, or it is the same."""
    if not len(other.rows):
        return one
    if not len(one.rows):
        return other
    return Nearby(np.concatenate([one.rows, other.rows]), one.packed if len(one.packed) else other.packed)


def about(near: Nearby, x: float, z: float, height: float = 0.0) -> Nearby:
    """The same as seen from a place on the ground: so that single precision holds anywhere."""
    rows = near.rows.copy()
    rows[:, 0] -= x
    rows[:, 1] -= height
    rows[:, 2] -= z
    return Nearby(rows, near.packed)


def corners_of(near: Nearby) -> Floats:
    """The corners (B, 8, 3) of boxes that hold the obstacles."""
    rows = near.rows
    half = rows[:, HALF:ROUNDING] + rows[:, ROUNDING, None]
    offsets = np.einsum("bji,bcj->bci", rows[:, TURN:HALF].reshape(-1, 3, 3), _SIGNS * half[:, None])
    corners: Floats = rows[:, None, CENTER:TURN] + offsets
    return corners


def bounds_of(near: Nearby) -> tuple[Floats, Floats]:
    """The least and the greatest coordinates (B, 3) of boxes along the frame's axes that hold the obstacles."""
    rows = near.rows
    turns, half = np.abs(rows[:, TURN:HALF].reshape(-1, 3, 3)), rows[:, HALF:ROUNDING]
    reach = np.einsum("bij,bi->bj", turns, half) + rows[:, ROUNDING, None]
    return rows[:, CENTER:TURN] - reach, rows[:, CENTER:TURN] + reach


@helper
def at_span(spans: Spans, k: int) -> Nearby:
    """The obstacles in one of the spans."""
    return Nearby(spans.rows[k], spans.packed)


@helper
def row_of(near: Nearby, b: int) -> Nearby:
    """One of the obstacles, for kernels."""
    return Nearby(near.rows[b : b + 1], near.packed)


@helper
def first_of(near: Nearby, count: int) -> Nearby:
    """The first obstacles, for kernels."""
    return Nearby(near.rows[:count], near.packed)


@helper
def how_many(near: Nearby) -> int:
    """The number of obstacles, for kernels."""
    return int(near.rows.shape[0])


@exact_kernel
def room_for(near: Nearby, count: int) -> Nearby:
    """Room for so many of the obstacles, to be written to by other kernels."""
    return Nearby(np.empty((count, ROW)), near.packed)


@exact_kernel
def shift(near: Nearby, count: int, origin: Floats) -> None:
    """Have the first `count` obstacles as seen from `origin` (3,)."""
    for b in range(count):
        for i in range(3):
            near.rows[b, i] -= origin[i]


@exact_kernel
def move_into(near: Nearby, b: int, place: Floats, turn: Floats, out: Nearby, at: int) -> None:
    """Obstacle b as seen from a frame at `place` (3,) with the unit quaternion `turn` (4,), as obstacle `at` of `out`.

    With R, p the frame and M, c the obstacle: x_own = M (R x + p - c) = (M R) (x - R'(c - p)).
    """
    x, y, z, w = turn[0], turn[1], turn[2], turn[3]
    xx, xy, xz = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)
    yx, yy, yz = 2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
    zx, zy, zz = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)
    own, moved = near.rows[b], out.rows[at]
    dx, dy, dz = own[0] - place[0], own[1] - place[1], own[2] - place[2]
    moved[0] = xx * dx + yx * dy + zx * dz
    moved[1] = xy * dx + yy * dy + zy * dz
    moved[2] = xz * dx + yz * dy + zz * dz
    for m in range(TURN, HALF, 3):
        p, q, r = own[m], own[m + 1], own[m + 2]
        moved[m], moved[m + 1] = p * xx + q * yx + r * zx, p * xy + q * yy + r * zy
        moved[m + 2] = p * xz + q * yz + r * zz
    for i in range(HALF, ROW):
        moved[i] = own[i]


@inner_exact_kernel
def shifted_into(near: Nearby, b: int, place: tuple[float, float, float], out: Nearby, at: int) -> None:
    """Obstacle b as seen from a place (x, height, z), as obstacle `at` of `out`."""
    for k in range(ROW):
        out.rows[at, k] = near.rows[b, k]
    for i in range(3):
        out.rows[at, i] -= place[i]


@exact_kernel
def around(near: Nearby, place: Floats, reach: float, out: Nearby) -> int:
    """Copy the obstacles whose box comes within `reach` of a place (3,) to `out`; their number."""
    count = 0
    for b in range(near.rows.shape[0]):
        own = near.rows[b]
        x, y, z, limit, square = place[0] - own[0], place[1] - own[1], place[2] - own[2], reach + own[ROUNDING], 0.0
        for i in range(3):
            along = own[TURN + 3 * i] * x + own[TURN + 3 * i + 1] * y + own[TURN + 3 * i + 2] * z
            square += max(abs(along) - own[HALF + i], 0.0) ** 2
        if square < limit * limit:
            for i in range(ROW):
                out.rows[count, i] = own[i]
            count += 1
    return count


def grown_aside(spans: Spans, margin: float) -> Spans:
    """Obstacles that are `margin` metres larger to every side of their own X and Z."""
    rows = spans.rows.copy()
    rows[..., [HALF, HALF + 2]] += margin
    return Spans(rows, spans.packed)


def seen_from(near: Nearby, positions: ArrayLike, rotations: ArrayLike) -> Spans:
    """The obstacles as seen from n frames at `positions` (n, 3), turned by unit quaternions `rotations` (n, 4).

    The arithmetic is float64: obstacles far from the world's origin lose nothing once they are near the frame's.
    """
    places = np.ascontiguousarray(positions, np.float64)
    out = np.empty((len(places), *near.rows.shape))
    _see_from(near, places, np.ascontiguousarray(rotations, np.float64), out)
    return Spans(out, near.packed)


@exact_kernel
def _see_from(near: Nearby, positions: Floats, rotations: Floats, out: Floats) -> None:
    for n in range(positions.shape[0]):
        for b in range(near.rows.shape[0]):
            move_into(near, b, positions[n], rotations[n], Nearby(out[n], near.packed), b)
