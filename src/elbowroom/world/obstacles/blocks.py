"""Clearance of whole blocks of postures around the key times, and of single capsules along a motion."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, inner_kernel, plain
from elbowroom.world.obstacles.layout import HALF, LANES, PER_METRE, ROUNDING, ROW, TILE, Nearby
from elbowroom.world.obstacles.pairs.tiles import fill_tile_rows, lower_squares, lower_to_squares, same_kind

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

COMFORT = 0.06  # metres: how much nearer something is than this, nobody asks
_ROUNDING = 1e-5  # metres: balls are held against obstacles in single precision
_COMFORT: Any = np.float32(COMFORT + _ROUNDING)
_PER_METRE: Any = np.float32(PER_METRE)
_NONE = plain(0)
_PAIRS = 512  # pairs of a tile and an obstacle that are collected before they are checked
_FAR = np.float32(np.inf)
_NO_BALL = np.float32(-1.0)  # the square of a radius to which nothing is near
_ZERO = np.float32(0.0)
_QUARTER = np.float32(0.25)
_LAST = LANES - 1


class ClearanceScratch(NamedTuple):
    """What checks of T tiles of capsules against B obstacles work on, and C capsules in sixteen places."""

    rows: Floats32  # (B * ROW,) obstacles as `lower_squares` takes them
    spread: Floats32  # (5, W) balls by components, W >= T a multiple of `LANES`
    squares: Floats32  # (T * 16,)
    pairs: Longs  # (_PAIRS + T, 2)
    lanes: Floats32  # (C, 7, 16) capsules with radii
    tiles: Floats32  # the same, flat
    balls: Floats  # (C, 1, 4) around them
    apart: Floats32  # (16,)


@inner_exact_kernel
def clearance_scratch(tiles: int, capsules: int, count: int) -> ClearanceScratch:
    """Room for checks of so many tiles, or of single capsules, against up to `count` obstacles."""
    flat = np.empty(capsules * TILE, np.float32)
    return ClearanceScratch(
        np.empty(count * ROW, np.float32),
        np.empty((5, (tiles + LANES - 1) // LANES * LANES), np.float32),
        np.empty(tiles * LANES, np.float32),
        np.empty((_PAIRS + tiles, 2), np.int64),
        flat.reshape(capsules, TILE // LANES, LANES),
        flat,
        np.empty((capsules, 1, 4)),
        np.empty(LANES, np.float32),
    )


@inner_exact_kernel
def spread_balls(balls: Floats, out: Floats32) -> None:
    """Balls (B, C, 4) by components (5, W): x, y, z, and the square of radius and comfort in the units of tiles.

    Those beyond B C, up to a multiple of `LANES`, are such that nothing is near them. The last row is left as it is.
    """
    parts = balls.shape[1]
    total = balls.shape[0] * parts
    t = 0
    for b in range(balls.shape[0]):
        for c in range(parts):
            reach = (balls[b, c, 3] + COMFORT + _ROUNDING) * PER_METRE
            out[0, t], out[1, t], out[2, t], out[3, t] = balls[b, c, 0], balls[b, c, 1], balls[b, c, 2], reach * reach
            t += 1
    for t in range(total, (total + LANES - 1) // LANES * LANES):
        out[0, t], out[1, t], out[2, t], out[3, t] = 0.0, 0.0, 0.0, -1.0


@inner_exact_kernel
def some_blocks(tiles: Floats32, balls: Floats32, parts: int, blocks: Longs) -> tuple[Floats32, Floats32]:
    """Some blocks (K,) of those in flat `tiles`, of so many parts each, and their `balls`, spread as of all."""
    count = blocks.shape[0] * parts
    own, spread = np.empty(count * TILE, np.float32), np.empty((5, (count + LANES - 1) // LANES * LANES), np.float32)
    spread[:] = _NO_BALL
    for k in range(blocks.shape[0]):
        for c in range(parts):
            source, target = blocks[k] * parts + c, k * parts + c
            for i in range(4):
                spread[i, target] = balls[i, source]
            for i in range(np.uint64(TILE)):
                own[target * TILE + i] = tiles[source * TILE + i]
    return own, spread


@inner_kernel
def _beyond_reach(balls: Floats32, rows: Floats32, b: int, out: Floats32) -> int:
    """How far (W,) balls as `spread_balls` are out of reach of the box round obstacle b; how many are within.

    Negative where they are within.
    """
    row = rows[b * ROW : (b + 1) * ROW]
    rounding = row[ROUNDING]
    cx, cy, cz = row[0], row[1], row[2]
    hx, hy, hz = row[HALF] + rounding, row[HALF + 1] + rounding, row[HALF + 2] + rounding
    m = (row[3], row[4], row[5], row[6], row[7], row[8], row[9], row[10], row[11])
    within = 0
    for t in range(np.uint64(out.shape[0])):
        x, y, z = balls[0, t] - cx, balls[1, t] - cy, balls[2, t] - cz
        p = max(abs(m[0] * x + m[1] * y + m[2] * z) - hx, _ZERO)
        q = max(abs(m[3] * x + m[4] * y + m[5] * z) - hy, _ZERO)
        r = max(abs(m[6] * x + m[7] * y + m[8] * z) - hz, _ZERO)
        out[t] = p * p + q * q + r * r - balls[3, t]
        within += out[t] < _ZERO
    return within


@inner_exact_kernel
def lower_blocks_in(
    scratch: ClearanceScratch, tiles: Floats32, spread: Floats32, near: Nearby, count: int, out: Floats32
) -> int:
    """`lower_blocks` with scratch memory, for lanes that lie flat and balls as `spread_balls` leaves them."""
    total = tiles.shape[0] // TILE
    rows, squares, pairs, parts = scratch.rows, scratch.squares, scratch.pairs, total // out.shape[0]
    fill_tile_rows(near.rows, count, rows)
    for t in range(total):
        reach = _reach_of(tiles, t)
        for i in range(np.uint64(LANES)):
            squares[t * LANES + i] = reach
    found, checks, beyond = _NONE, 0, spread[4, : (total + LANES - 1) // LANES * LANES]
    for b in range(count):
        if found > 0 and not same_kind(rows, b, b - 1):
            lower_squares(tiles, rows, near.packed, pairs, found, squares)
            checks, found = checks + found * LANES, _NONE
        if _beyond_reach(spread, rows, b, beyond) > 0:
            for t in range(total):
                pairs[found, 0], pairs[found, 1] = t, b
                found += beyond[t] < 0.0
        if found >= _PAIRS or b == count - 1:
            lower_squares(tiles, rows, near.packed, pairs, found, squares)
            checks, found = checks + found * LANES, _NONE
    if checks > 0:
        for t in range(total):
            lanes, reach = squares[t * LANES : (t + 1) * LANES], _reach_of(tiles, t)
            if _leave_within(lanes, reach) > 0:
                lower_to_squares(lanes, tiles[t * TILE + (TILE - LANES)], out[t // parts])
    return checks


@helper
def _reach_of(tiles: Floats32, t: int) -> Any:
    """The squared distance from the axes of a tile beyond which nothing is asked for."""
    reach = (tiles[t * TILE + (TILE - LANES)] + _COMFORT) * _PER_METRE
    return reach * reach


@inner_kernel
def _leave_within(squares: Floats32, reach: float) -> int:
    """Make those of the squared distances (16,) infinite that are not below `reach`; how many are."""
    limit, within = np.float32(reach), 0
    for i in range(np.uint64(squares.shape[0])):
        within += squares[i] < limit
        squares[i] = squares[i] if squares[i] < limit else _FAR
    return within


@exact_kernel
def lower_blocks(lanes: Floats32, balls: Floats, near: Nearby, count: int, out: Floats32) -> int:
    """Lower `out` (B, 16) to the clearance of blocks of postures from the first `count` obstacles, all in one frame.

    What is farther away than `COMFORT` is left out. Returns the capsules that were checked.
    """
    scratch = clearance_scratch(lanes.shape[0] * lanes.shape[1], lanes.shape[1], near.rows.shape[0])
    spread_balls(balls, scratch.spread)
    return int(lower_blocks_in(scratch, lanes.reshape(lanes.size), scratch.spread, near, count, out))


@inner_exact_kernel
def place_capsules(
    segments: Floats32, count: int, radii: Floats32, places: Floats, turns: Floats, lanes: Floats32
) -> None:
    """The first `count` capsules (C, 6, N) in frames at `places` (N, 3), `turns` (N, 4), as lanes (C, 7, W) outside.

    The lanes beyond these repeat the last.
    """
    for n in range(count):
        x, y, z, w = turns[n, 0], turns[n, 1], turns[n, 2], turns[n, 3]
        xx, xy, xz = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)
        yx, yy, yz = 2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
        zx, zy, zz = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)
        for c in range(segments.shape[0]):
            for e in range(0, 6, 3):
                a, b, d = segments[c, e, n], segments[c, e + 1, n], segments[c, e + 2, n]
                lanes[c, e, n] = places[n, 0] + xx * a + xy * b + xz * d
                lanes[c, e + 1, n] = places[n, 1] + yx * a + yy * b + yz * d
                lanes[c, e + 2, n] = places[n, 2] + zx * a + zy * b + zz * d
    for c in range(segments.shape[0]):
        for e in range(6):
            last = lanes[c, e, count - 1]
            for n in range(count, lanes.shape[2]):
                lanes[c, e, n] = last
        for n in range(lanes.shape[2]):
            lanes[c, 6, n] = radii[c]


@inner_kernel
def _ball_around(lanes: Floats32, scratch: Floats32, ball: Floats) -> None:
    """The ball (4,), centre and radius, around a capsule (7, 16) in all lanes, about the middle of first and last."""
    ax, ay, az, bx, by, bz = lanes[0], lanes[1], lanes[2], lanes[3], lanes[4], lanes[5]
    x = _QUARTER * (ax[0] + bx[0] + ax[_LAST] + bx[_LAST])
    y = _QUARTER * (ay[0] + by[0] + ay[_LAST] + by[_LAST])
    z = _QUARTER * (az[0] + bz[0] + az[_LAST] + bz[_LAST])
    for i in range(np.uint64(scratch.shape[0])):
        a = (ax[i] - x) * (ax[i] - x) + (ay[i] - y) * (ay[i] - y) + (az[i] - z) * (az[i] - z)
        b = (bx[i] - x) * (bx[i] - x) + (by[i] - y) * (by[i] - y) + (bz[i] - z) * (bz[i] - z)
        scratch[i] = max(a, b)
    farthest = _ZERO
    for i in range(scratch.shape[0]):
        farthest = max(farthest, scratch[i])
    ball[0], ball[1], ball[2], ball[3] = x, y, z, lanes[6, 0] + np.sqrt(farthest)


@inner_exact_kernel
def capsule_clearances_in(scratch: ClearanceScratch, near: Nearby, count: int, out: Floats32) -> int:
    """`capsule_clearances` of the capsules in the scratch memory."""
    for c in range(scratch.lanes.shape[0]):
        _ball_around(scratch.lanes[c], scratch.apart, scratch.balls[c, 0])
    spread_balls(scratch.balls, scratch.spread)
    return int(lower_blocks_in(scratch, scratch.tiles, scratch.spread, near, count, out))


@exact_kernel
def capsule_clearances(lanes: Floats32, near: Nearby, count: int, out: Floats32) -> int:
    """Lower `out` (C, 16) to the clearance of each capsule in each lane (C, 7, 16).

    What is farther away than `COMFORT` is left out. Returns how many were checked.
    """
    scratch = clearance_scratch(lanes.shape[0], lanes.shape[0], near.rows.shape[0])
    scratch.lanes[:] = lanes
    return int(capsule_clearances_in(scratch, near, count, out))


@inner_exact_kernel
def least_of(rows: Floats32, scratch: Floats32) -> float:
    """The least number in rows (C, 16) of clearances; `scratch` (16,)."""
    for i in range(np.uint64(LANES)):
        scratch[i] = rows[0, i]
    for c in range(1, rows.shape[0]):
        row = rows[c]
        for i in range(np.uint64(LANES)):
            scratch[i] = min(scratch[i], row[i])
    least = scratch[0]
    for i in range(1, LANES):
        least = min(least, scratch[i])
    return float(least)
