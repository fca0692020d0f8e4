"""The clearance of the postures of a group in one key interval, while the frame that carries them moves.

A posture belongs to a key time, and stays there for half a key interval to either side: so each interval gives the
postures of the key time before it an `early` row and those of the key time after it a `late` one, which looks at the
key time itself too. The goal's own posture at these two key times rides along.

Postures are looked at when somebody asks for them, a block of sixteen at a time: of those among meshes, where a look is
dear, most are never asked for.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.exact.lattice.postures import BLOCK, Postures
from elbowroom.planning.exact.memory.cache_index import CacheIndex, admit, find, new_cache_index
from elbowroom.planning.exact.sweep.motion_bounds import SWEEP
from elbowroom.planning.exact.sweep.scratch import Scratch, held_against
from elbowroom.planning.model.limb import pose_into
from elbowroom.world.obstacles.blocks import least_of, lower_blocks_in, some_blocks
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.rows import around, move_into

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_MOMENTS = 4  # parts of an interval, at whose ends postures are looked at
_STRIDE = SWEEP // _MOMENTS
HELD_AT_START, HELD_EARLY, HELD_LATE = plain(0), plain(1), plain(2)  # parts of an interval
_EARLY, _LATE = 2, 2  # up to this moment they belong to the key time before, from this one on to that after
_FAR = np.float32(1e3)
_ONE, _BOTH, _FIRST = plain(1), plain(2), plain(0)  # postures; place


@by_reference
class NodeClearances(NamedTuple):
    """Tables by interval; the key is the carrier's way and the goals at both ends."""

    entries: CacheIndex
    early: Floats32  # (S, W + 1) clearance of every posture, then of the goal; more than any where none was looked at
    late: Floats32  # (S, W + 1)
    seen: Bools  # (S, W/16 + 1) the blocks of postures that were looked at, then whether the goals were


def new_node_clearances(count: int, size: int, width: int) -> NodeClearances:
    """Room for `count` tables of `width` lanes of postures with `size` components."""
    return NodeClearances(
        new_cache_index(count, 1 + 2 * size),
        np.empty((count, width + 1), np.float32),
        np.empty((count, width + 1), np.float32),
        np.empty((count, width // BLOCK + 1), np.bool_),
    )


@helper
def interval_table(scratch: Scratch, tables: NodeClearances, carrier: int, goals: Floats) -> int:
    """The slot of the table of an interval: what was looked at earlier is in it.

    `carrier` is the number of the carrier's way, `goals` (2, d) are those at the interval's ends.
    """
    size = goals.shape[1]
    key = scratch.key[: 1 + 2 * size]
    key[0] = carrier
    for i in range(size):
        key[1 + i], key[1 + size + i] = goals[0, i], goals[1, i]
    at = find(tables.entries, key)
    if at < 0:
        at = admit(tables.entries, key)
        tables.early[at, :], tables.late[at, :] = _FAR, _FAR
        tables.seen[at, :] = False
    return int(at)


@helper
def look_at_nodes(
    scratch: Scratch,
    tables: NodeClearances,
    at: int,
    blocks: Longs,
    postures: Postures,
    carrier: tuple[Floats, Floats],
    goals: Floats,
    obstacles: Nearby,
) -> int:
    """Look at some blocks (K,) of an interval, the number after the last being that of the goals, if nobody has yet.

    `at` is the slot of the interval's table, the `carrier` are its frames: places (SWEEP+1, 3), turns (SWEEP+1, 4);
    `obstacles` are in the world. Returns the capsules that had to be checked.
    """
    early, late, seen, (places, turns) = tables.early[at], tables.late[at], tables.seen[at], carrier
    width, count, checks = early.shape[0] - 1, 0, 0
    unseen = np.empty(blocks.shape[0], np.int64)
    for b in blocks:
        if seen[b]:
            continue
        seen[b] = True
        if b * BLOCK < width:
            unseen[count] = b
            count += 1
        else:
            early[width], late[width], checks = _goals_held(scratch, postures, goals, places, turns, obstacles)
    if count > 0:
        checks += _moments(scratch, postures, unseen[:count], places, turns, obstacles, early, late)
    return checks


@inner_exact_kernel
def _set_frame(places: Floats, turns: Floats, sample: int, own_places: Floats, own_turns: Floats, n: int) -> None:
    """Have the frame at a look of `places` (N, 3), `turns` (N, 4) as number `n` among one's own."""
    for i in range(3):
        own_places[n, i] = places[sample, i]
    for i in range(4):
        own_turns[n, i] = turns[sample, i]


@helper
def _goals_held(
    scratch: Scratch, postures: Postures, goals: Floats, places: Floats, turns: Floats, obstacles: Nearby
) -> tuple[Any, Any, int]:
    """The clearances of an interval's goals (2, d), the first held early and the second late, and capsules checked."""
    near, segments, found = (
        around(obstacles, places[0], postures.reach + 0.5, scratch.near),
        scratch.segments,
        scratch.found,
    )
    configurations, own_places, own_turns = scratch.configurations, scratch.places, scratch.turns
    if near == 0:
        return _FAR, _FAR, 0
    for i in range(goals.shape[1]):
        configurations[0, i], configurations[1, i] = goals[0, i], goals[1, i]
    pose_into(postures.limb, scratch.limb, configurations, _BOTH, _FIRST, segments)
    total = _EARLY + _MOMENTS + 1 - _LATE
    for n in range(total):
        sample = (n + 1 if n < _EARLY else n - _EARLY + _LATE) * _STRIDE
        _set_frame(places, turns, sample, own_places, own_turns, n)
    for c in range(segments.shape[0]):
        for i in range(6):
            first, second = segments[c, i, 0], segments[c, i, 1]
            for n in range(total):
                segments[c, i, n] = first if n < _EARLY else second
        found[c, :] = _FAR
    checks = held_against(scratch, postures.limb.radii, near, total, places[0], own_places, own_turns, found)
    early, late = _FAR, _FAR
    for c in range(found.shape[0]):
        for n in range(_EARLY):
            early = min(early, found[c, n])
        for n in range(_EARLY, total):
            late = min(late, found[c, n])
    return early, late, checks


@helper
def _moments(
    scratch: Scratch,
    postures: Postures,
    blocks: Longs,
    places: Floats,
    turns: Floats,
    obstacles: Nearby,
    early: Floats32,
    late: Floats32,
) -> int:
    """The clearance of some blocks (K,) of postures at the moments of an interval, into `early` and `late` (W+1,).

    Returns the capsules that were checked.
    """
    near, framed, reach, checks = scratch.near, scratch.framed, postures.reach, 0
    tiles, spread = some_blocks(scratch.tiles, scratch.spread, scratch.segments.shape[0], blocks)
    rows, within = scratch.blocks[: blocks.shape[0]], scratch.checks
    for moment in range(1, _MOMENTS + 1):
        place, turn = places[moment * _STRIDE], turns[moment * _STRIDE]
        count = around(obstacles, place, reach, near)
        if count == 0:
            continue
        for b in range(count):
            move_into(near, b, place, turn, framed, b)
        rows[:] = _FAR
        checks += lower_blocks_in(within, tiles, spread, framed, count, rows)
        if moment <= _EARLY:
            _lower(early, blocks, rows)
        if moment >= _LATE:
            _lower(late, blocks, rows)
    return checks


@inner_exact_kernel
def _lower(row: Floats32, blocks: Longs, found: Floats32) -> None:
    """Lower some blocks (K,) of a row to what was found for them (K, 16)."""
    for k in range(blocks.shape[0]):
        lanes, block = row[blocks[k] * BLOCK : (blocks[k] + 1) * BLOCK], found[k]
        for i in range(np.uint64(BLOCK)):
            lanes[i] = min(lanes[i], block[i])


@exact_kernel
def held_clearance(
    scratch: Scratch,
    postures: Postures,
    configuration: Floats,
    places: Floats,
    turns: Floats,
    obstacles: Nearby,
    part: int,
) -> tuple[float, int]:
    """The clearance of a single posture (d,) in one of the parts of an interval, and the capsules that were checked."""
    late = (_LATE, _MOMENTS + 1)
    begin, end = (0, 1) if part == HELD_AT_START else (1, _EARLY + 1) if part == HELD_EARLY else late
    near, segments = around(obstacles, places[0], postures.reach + 0.5, scratch.near), scratch.segments
    configurations, found = scratch.configurations, scratch.found
    own_places, own_turns = scratch.places, scratch.turns
    if near == 0:
        return float(_FAR), 0
    for i in range(configuration.shape[0]):
        configurations[0, i] = configuration[i]
    pose_into(postures.limb, scratch.limb, configurations, _ONE, _FIRST, segments)
    total = end - begin
    for n in range(total):
        sample = (begin + n) * _STRIDE
        _set_frame(places, turns, sample, own_places, own_turns, n)
    for c in range(segments.shape[0]):
        for i in range(6):
            for n in range(1, total):
                segments[c, i, n] = segments[c, i, 0]
        found[c, :] = _FAR
    checks = held_against(scratch, postures.limb.radii, near, total, places[0], own_places, own_turns, found)
    return least_of(found, scratch.checks.apart), checks
