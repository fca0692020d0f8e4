"""Clearance of capsules from obstacles: exact distances in batches, float32.

Segments are a structure of arrays: `(C, 6, N)`, rows ax, ay, az, bx, by, bz of C capsules in N configurations.
Clearance is the distance from the capsule's axis to the obstacle less the capsule's radius: negative where they
overlap. An axis that enters an obstacle has distance 0, so the clearance is never below minus the radius: it is no
measure of how deep the overlap is. Rounding stays below 1e-6 m while coordinates are below some 2 m, and grows with
them: move distant obstacles into a frame near the body (`rows.seen_from`, `rows.about`).

The innermost loops are in the files of the pairs of shapes: here configurations are cut into tiles of sixteen, padded
to whole ones.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.jit import brief_kernel, helper, inner_kernel, kernel, plain
from elbowroom.world.obstacles.layout import LANES, PER_METRE, ROW, TILE, Nearby
from elbowroom.world.obstacles.pairs.tiles import fill_tile_rows, lower_squares, lower_to_squares, same_kind
from elbowroom.world.obstacles.passing_by import Boxes, apart_from, boxes_round

_FIRST = plain(0)
_TILES = 32  # tiles that are treated together: they stay in the first-level cache
_FEW = 1  # obstacles of which none is passed by: to look into it costs no more
_PAIRS = 256  # pairs of a tile and an obstacle that are treated in one go
_METRES: Any = np.float32(1.0 / PER_METRE)
_INFINITE: Any = np.float32(np.inf)
_ZERO: Any = np.float32(0.0)
_MORE: Any = np.float32(PER_METRE * (1.0 + 1e-6))  # metres in units of tiles, and no less by rounding

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]


def clearance(segments: ArrayLike, radii: ArrayLike, near: Nearby, farthest: float = math.inf) -> Floats32:
    """The least clearance of every configuration, metres, shape (N,); infinite where there is nothing, or no capsule.

    `segments` (C, 6, N), `radii` (C,), all in one frame with the obstacles. Clearance above `farthest` metres is given
    as `farthest`: the less, the sooner it is done among meshes.
    """
    capsules, sizes = _prepared(segments, radii)
    out = np.full(capsules.shape[2], farthest, np.float32)
    lower_clearance(capsules, sizes, near, out)
    return out


def clearance_of(segments: ArrayLike, radii: ArrayLike, near: Nearby) -> float:
    """The least clearance of one posture, `segments` (C, 6): the same check, bit for bit, with capsules as lanes."""
    lanes = np.ascontiguousarray(np.asarray(segments, np.float32).T)
    return float(_posture_clearance(lanes, np.ascontiguousarray(radii, np.float32), near))


def clearance_from_each(segments: ArrayLike, radii: ArrayLike, near: Nearby) -> Floats32:
    """The least clearance of one posture, `segments` (C, 6), from every obstacle, metres, shape (B,)."""
    lanes = np.ascontiguousarray(np.asarray(segments, np.float32).T)
    out = np.empty(len(near.rows), np.float32)
    _clearance_from_each(lanes, np.ascontiguousarray(radii, np.float32), near, out)
    return out


def pairwise_clearance(segments: ArrayLike, radii: ArrayLike, near: Nearby) -> Floats32:
    """The clearance of every capsule from every obstacle in every configuration, metres, shape (C, B, N)."""
    capsules, sizes = _prepared(segments, radii)
    out = np.empty((capsules.shape[0], len(near.rows), capsules.shape[2]), np.float32)
    _pairwise_into(capsules, sizes, near, out)
    return out


def _prepared(segments: ArrayLike, radii: ArrayLike) -> tuple[Floats32, Floats32]:
    """The one array layout that the kernels are compiled for."""
    return np.ascontiguousarray(segments, np.float32), np.ascontiguousarray(radii, np.float32)


@inner_kernel
def _fill_tiles(segment: Floats32, start: int, count: int, tiles: Floats32) -> None:
    """Copy `count` configurations of one capsule (6, N); what is left of the last tile repeats the last of them."""
    whole, width = count // LANES, np.uint64(min(count, LANES))  # a known width would be unrolled, number by number
    rest, last = whole * LANES, start + count - 1
    for k in range(6):
        row = np.uint64(k)
        for t in range(whole):
            source, target = np.uint64(start + t * LANES), np.uint64(t * TILE + k * LANES)
            for i in range(width):
                tiles[target + i] = segment[row, source + i]
        if count > rest:
            for i in range(LANES):
                tiles[whole * TILE + k * LANES + i] = segment[k, min(start + rest + i, last)]


@inner_kernel
def _lower_all(
    tiles: Floats32, used: int, rows: Floats32, packed: Floats32, boxes: Boxes, pairs: Longs, squares: Floats32
) -> None:
    """Lower the squares of the tiles in use to those from all obstacles that they do not pass by.

    `boxes` are those round the obstacles; `pairs` (_PAIRS, 2) is scratch.
    """
    passing, count = boxes.dear and boxes.sides.shape[1] > _FEW, _FIRST
    apart = np.empty((used if passing else 0, boxes.sides.shape[1]), np.float32)
    for t in range(apart.shape[0]):
        apart_from(tiles, t, squares, boxes.sides, apart[t])
    for b in range(rows.shape[0] // ROW):
        if count > 0 and not same_kind(rows, b, b - 1):
            lower_squares(tiles, rows, packed, pairs, count, squares)
            count = _FIRST
        for t in range(used):
            pairs[count, 0], pairs[count, 1] = t, b
            count += not passing or apart[t, b] <= _ZERO
            if count == _PAIRS:
                lower_squares(tiles, rows, packed, pairs, count, squares)
                count = _FIRST
    lower_squares(tiles, rows, packed, pairs, count, squares)


@inner_kernel
def _infinitely_far(values: Floats32) -> None:
    for i in range(np.uint64(values.shape[0])):
        values[i] = _INFINITE


@kernel
def clearance_into(segments: Floats32, radii: Floats32, near: Nearby, out: Floats32) -> None:
    """`clearance` for other kernels: C-contiguous float32 arrays, the result written to `out` (N,)."""
    _infinitely_far(out)
    lower_clearance(segments, radii, near, out)


@kernel
def lower_clearance(segments: Floats32, radii: Floats32, near: Nearby, out: Floats32) -> None:
    """Lower `out` (N,) to the clearances where these are less. Meshes are passed by that are farther than it says."""
    rows, pairs = np.empty(near.rows.shape[0] * ROW, np.float32), np.empty((_PAIRS, 2), np.int64)
    fill_tile_rows(near.rows, near.rows.shape[0], rows)
    boxes = boxes_round(near)
    scratch = np.empty(_TILES * (TILE + 2 * LANES), np.float32)
    tiles, lanes = scratch[: _TILES * TILE], scratch[_TILES * TILE :]
    for start in range(0, out.shape[0], _TILES * LANES):
        count = min(_TILES * LANES, out.shape[0] - start)
        used = (count + LANES - 1) // LANES
        squares, least = lanes[: used * LANES], lanes[used * LANES : 2 * used * LANES]
        for i in range(np.uint64(used * LANES)):
            least[i] = out[min(start + i, out.shape[0] - 1)]
        for c in range(segments.shape[0]):
            _fill_tiles(segments[c], start, count, tiles)
            _as_squares(least, radii[c], squares)
            _lower_all(tiles, used, rows, near.packed, boxes, pairs, squares)
            lower_to_squares(squares, radii[c], least)
        for i in range(np.uint64(count)):
            out[start + i] = least[i]


@helper
def _as_squares(least: Floats32, radius: float, squares: Floats32) -> None:
    """The squared distances of axes beyond which nothing lowers clearances (N,), or a little more than these."""
    for i in range(np.uint64(squares.shape[0])):
        away = max(least[i] + radius, _ZERO) * _MORE
        squares[i] = away * away


@kernel
def _pairwise_into(segments: Floats32, radii: Floats32, near: Nearby, out: Floats32) -> None:
    for c in range(segments.shape[0]):
        for b in range(near.rows.shape[0]):
            one = Nearby(near.rows[b : b + 1], near.packed)
            clearance_into(segments[c : c + 1], radii[c : c + 1], one, out[c, b])


@brief_kernel
def _posture_clearance(capsules: Floats32, radii: Floats32, near: Nearby) -> Any:
    """The least clearance of `capsules` (6, C), as lanes of one loop."""
    least, found = _INFINITE, np.empty(capsules.shape[1], np.float32)
    clearance_of_each(capsules, radii, near, found)
    for i in range(found.shape[0]):
        least = min(least, found[i])
    return least


@inner_kernel
def clearance_of_each(capsules: Floats32, radii: Floats32, near: Nearby, out: Floats32) -> None:
    """The clearance of each of `capsules` (6, C) from the nearest of the obstacles, to `out` (C,)."""
    _infinitely_far(out)
    lower_each(capsules, radii, near, out)


@inner_kernel
def lower_each(capsules: Floats32, radii: Floats32, near: Nearby, out: Floats32) -> None:
    """Lower `out` (C,) to the clearances of each of `capsules` (6, C) where these are less."""
    count = capsules.shape[1]
    if count == 0:
        return
    used = (count + LANES - 1) // LANES
    tiles, squares = np.empty(used * TILE, np.float32), np.empty(used * LANES, np.float32)
    for i in range(used * LANES):
        away = max(out[min(i, count - 1)] + radii[min(i, count - 1)], _ZERO) * _MORE
        squares[i] = away * away
    rows = np.empty(near.rows.shape[0] * ROW, np.float32)
    fill_tile_rows(near.rows, near.rows.shape[0], rows)
    _fill_tiles(capsules, _FIRST, count, tiles)
    _lower_all(tiles, used, rows, near.packed, boxes_round(near), np.empty((_PAIRS, 2), np.int64), squares)
    for i in range(count):
        out[i] = min(out[i], math.sqrt(squares[i]) * _METRES - radii[i])


@kernel
def _clearance_from_each(capsules: Floats32, radii: Floats32, near: Nearby, out: Floats32) -> None:
    for b in range(near.rows.shape[0]):
        out[b] = _posture_clearance(capsules, radii, Nearby(near.rows[b : b + 1], near.packed))
