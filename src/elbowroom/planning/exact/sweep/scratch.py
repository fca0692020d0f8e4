"""What the kernels of a search work on, kept for the next: the smaller the work, the dearer new arrays are."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import ROOT_STATE
from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, inner_exact_kernel, plain
from elbowroom.planning.exact.lattice.postures import BLOCK, Postures
from elbowroom.planning.model.limb import Limb, LimbScratch, limb_scratch
from elbowroom.world.obstacles.blocks import (
    ClearanceScratch,
    capsule_clearances_in,
    clearance_scratch,
    place_capsules,
    spread_balls,
)
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.rows import has_room_for, number_of, room_for, shift

_BLOCK = plain(BLOCK)  # postures that are posed at once
_FEW, _SPARE = 8, 2  # obstacles for which there is room at least, and room for so many times those that there are

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]


@by_reference
class Scratch(NamedTuple):
    """Room for sixteen looks at a limb with C capsules and d components, past B obstacles."""

    checks: ClearanceScratch
    limb: LimbScratch
    stem: LimbScratch  # of the limb that carries it
    near: Nearby  # some of the B obstacles
    framed: Nearby  # the same in the limb's frame
    tiles: Floats32  # blocks of all postures, flat
    spread: Floats32  # (5, W) balls around all postures, as `spread_balls` leaves them
    blocks: Floats32  # (W/16, 16) of all postures
    segments: Floats32  # (C, 6, 16) in the limb's frame
    coarse: Floats32  # (C, 16) clearances at the looks
    found: Floats32  # (C, 16) clearances between them
    configurations: Floats  # (16, d)
    states: Floats  # (16, 7) of the root
    level: Floats  # (16, 2) zeros: hips that are not lowered
    places: Floats  # (16, 3) of frames
    turns: Floats  # (16, 4)
    at: Floats  # (16, 3) places seen from the first
    shares: Floats  # (16,) of the interval
    key: Floats  # (1 + 4 d,) of a limb's way
    axis: Floats  # (6,) of a capsule


@exact_kernel
def new_scratch(postures: Postures, stem: Limb, obstacles: Nearby, most: int) -> Scratch:
    """Room for a search among `postures` on the waist's limb `stem`, past up to `most` such obstacles."""
    limb = postures.limb
    count, size = limb.radii.shape[0], postures.configurations.shape[1]
    checks = clearance_scratch(postures.lanes.shape[0] * count, count, most)
    spread = np.empty(checks.spread.shape, np.float32)
    spread_balls(postures.balls, spread)
    return Scratch(
        checks,
        limb_scratch(limb, _BLOCK),
        limb_scratch(stem, _BLOCK),
        room_for(obstacles, most),
        room_for(obstacles, most),
        postures.lanes.reshape(postures.lanes.size),
        spread,
        np.empty((postures.lanes.shape[0], BLOCK), np.float32),
        np.empty((count, 6, BLOCK), np.float32),
        np.empty((count, BLOCK), np.float32),
        np.empty((count, BLOCK), np.float32),
        np.empty((BLOCK, size)),
        np.empty((BLOCK, ROOT_STATE)),
        np.zeros((BLOCK, 2)),
        np.empty((BLOCK, 3)),
        np.empty((BLOCK, 4)),
        np.empty((BLOCK, 3)),
        np.empty(BLOCK),
        np.empty(1 + 4 * size),
        np.empty(6),
    )


class ScratchShelf:
    """The scratches of searches among the same postures, whoever makes them: one for each search at a time."""

    def __init__(self, postures: Postures, stem: Limb) -> None:
        """`stem`: the waist's limb."""
        self._made_of = postures, stem
        self._free: list[Scratch] = []

    @contextmanager
    def taken(self, obstacles: Nearby) -> Iterator[Scratch]:
        """Room for a search past no more than these obstacles, for nobody else meanwhile."""
        try:
            scratch = self._free.pop()
        except IndexError:  # another thread may have been quicker
            scratch = None
        if scratch is None or not has_room_for(scratch.near, obstacles):
            scratch = new_scratch(*self._made_of, obstacles, _SPARE * max(number_of(obstacles), _FEW))
        try:
            yield scratch
        finally:
            self._free.append(scratch)


@inner_exact_kernel
def held_against(
    scratch: Scratch,
    radii: Floats32,
    near: int,
    count: int,
    origin: Floats,
    places: Floats,
    turns: Floats,
    out: Floats32,
) -> int:
    """Lower `out` (C, 16) to the clearances of the room's first `count` capsules from its first `near` obstacles.

    The capsules are in frames at `places` (N, 3), `turns` (N, 4); all is reckoned from `origin`, a place near to them.
    Returns the capsules that were checked.
    """
    at = scratch.at
    for n in range(count):
        for i in range(3):
            at[n, i] = places[n, i] - origin[i]
    shift(scratch.near, near, origin)
    place_capsules(scratch.segments, count, radii, at, turns, scratch.checks.lanes)
    return int(capsule_clearances_in(scratch.checks, scratch.near, near, out))
