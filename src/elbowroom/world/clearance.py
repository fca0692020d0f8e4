"""Clearance of capsules from oriented boxes: exact distances in batches, float32.

Segments are a structure of arrays: `(C, 6, N)`, rows ax, ay, az, bx, by, bz of C capsules in N configurations.
Clearance is the distance from the capsule's axis to the box less the capsule's radius: negative where they overlap.
An axis that enters a box has distance 0, so the clearance is never below minus the radius: it is no measure of how
deep the overlap is. Rounding stays below 1e-6 m while coordinates are below some 2 m, and grows with them: move
distant obstacles into a frame near the body (`tables_in_frames`).

The innermost loop is in `capsule_tiles`: here configurations are cut into tiles of sixteen, padded to whole ones.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.jit import kernel, plain
from elbowroom.world.capsule_tiles import BOX, LANES, PER_METRE, TILE, lower_squares, lower_to_squares

_FIRST = plain(0)
_TILES = 32  # tiles that are treated together: they stay in the first-level cache
_PAIRS = 256  # pairs of a tile and a box that are treated in one go
_SCALE: Any = np.float32(PER_METRE)
_METRES: Any = np.float32(1.0 / PER_METRE)
_INFINITE: Any = np.float32(np.inf)

Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]


def clearance(segments: ArrayLike, radii: ArrayLike, table: ArrayLike) -> Floats32:
    """The least clearance of every configuration, metres, shape (N,); infinite where there are no boxes or capsules.

    `segments` (C, 6, N), `radii` (C,), `table` (B, 15) as in `Boxes.table`, all in one frame.
    """
    capsules, sizes, rows = _prepared(segments, radii, table)
    out = np.empty(capsules.shape[2], np.float32)
    clearance_into(capsules, sizes, rows, out)
    return out


def clearance_of(segments: ArrayLike, radii: ArrayLike, table: ArrayLike) -> float:
    """The least clearance of one posture, `segments` (C, 6): the same check, bit for bit, with capsules as lanes."""
    lanes = np.ascontiguousarray(np.asarray(segments, np.float32).T)
    rows = np.ascontiguousarray(table, np.float32)
    return float(_posture_clearance(lanes, np.ascontiguousarray(radii, np.float32), rows))


def pairwise_clearance(segments: ArrayLike, radii: ArrayLike, table: ArrayLike) -> Floats32:
    """The clearance of every capsule from every box in every configuration, metres, shape (C, B, N)."""
    capsules, sizes, rows = _prepared(segments, radii, table)
    out = np.empty((capsules.shape[0], rows.shape[0], capsules.shape[2]), np.float32)
    _pairwise_into(capsules, sizes, rows, out)
    return out


def _prepared(segments: ArrayLike, radii: ArrayLike, table: ArrayLike) -> tuple[Floats32, Floats32, Floats32]:
    """The one array layout that the kernels are compiled for."""
    return (
        np.ascontiguousarray(segments, np.float32),
        np.ascontiguousarray(radii, np.float32),
        np.ascontiguousarray(table, np.float32),
    )


@kernel
def box_rows(table: Floats32 | NDArray[np.float64], count: int) -> Floats32:
    """The first `count` boxes of a table (B, 15), flat and in the units of `lower_squares`; centres stay in metres."""
    rows = np.empty(count * BOX, np.float32)
    fill_box_rows(table, count, rows)
    return rows


@kernel
def fill_box_rows(table: Floats32 | NDArray[np.float64], count: int, rows: Floats32) -> None:
    """`box_rows`, written to `rows` (15 B,)."""
    for b in range(count):
        for k in range(BOX):
            rows[b * BOX + k] = table[b, k] if k < 3 else table[b, k] * _SCALE


@kernel
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


@kernel
def _lower_all(tiles: Floats32, used: int, rows: Floats32, pairs: Longs, squares: Floats32) -> None:
    """Lower the squares of the tiles in use to those from all boxes; `pairs` (_PAIRS, 2) is scratch."""
    count = _FIRST
    for b in range(rows.shape[0] // BOX):
        for t in range(used):
            pairs[count, 0], pairs[count, 1] = t, b
            count += 1
            if count == _PAIRS:
                lower_squares(tiles, rows, pairs, count, squares)
                count = _FIRST
    lower_squares(tiles, rows, pairs, count, squares)


@kernel
def _infinitely_far(values: Floats32) -> None:
    for i in range(np.uint64(values.shape[0])):
        values[i] = _INFINITE


@kernel
def clearance_into(segments: Floats32, radii: Floats32, table: Floats32, out: Floats32) -> None:
    """`clearance` for other kernels: C-contiguous float32 arrays, the result written to `out` (N,)."""
    rows, pairs = box_rows(table, table.shape[0]), np.empty((_PAIRS, 2), np.int64)
    scratch = np.empty(_TILES * (TILE + 2 * LANES), np.float32)
    tiles, lanes = scratch[: _TILES * TILE], scratch[_TILES * TILE :]
    for start in range(0, out.shape[0], _TILES * LANES):
        count = min(_TILES * LANES, out.shape[0] - start)
        used = (count + LANES - 1) // LANES
        squares, least = lanes[: used * LANES], lanes[used * LANES : 2 * used * LANES]
        _infinitely_far(least)
        for c in range(segments.shape[0]):
            _fill_tiles(segments[c], start, count, tiles)
            _infinitely_far(squares)
            _lower_all(tiles, used, rows, pairs, squares)
            lower_to_squares(squares, radii[c], least)
        for i in range(np.uint64(count)):
            out[start + i] = least[i]


@kernel
def _pairwise_into(segments: Floats32, radii: Floats32, table: Floats32, out: Floats32) -> None:
    for c in range(segments.shape[0]):
        for b in range(table.shape[0]):
            clearance_into(segments[c : c + 1], radii[c : c + 1], table[b : b + 1], out[c, b])


@kernel
def _posture_clearance(capsules: Floats32, radii: Floats32, table: Floats32) -> Any:
    """The least clearance of `capsules` (6, C), as lanes of one loop."""
    count, least = capsules.shape[1], _INFINITE
    if count == 0:
        return least
    used = (count + LANES - 1) // LANES
    tiles, squares = np.empty(used * TILE, np.float32), np.empty(used * LANES, np.float32)
    squares[:] = _INFINITE
    _fill_tiles(capsules, _FIRST, count, tiles)
    _lower_all(tiles, used, box_rows(table, table.shape[0]), np.empty((_PAIRS, 2), np.int64), squares)
    for i in range(count):
        least = min(least, math.sqrt(squares[i]) * _METRES - radii[i])
    return least
