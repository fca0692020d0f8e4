"""Clearances of a child's postures under many waists, for the joint step.

A child's capsules stand still in the chest frame, so each waist of a slice brings its own obstacles, moved into the
chest frame that this waist makes, at the moments around the key time. This is the costly part of the joint
step; so it is done slice by slice and waist by waist, as far as it is asked for.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.world.obstacles.blocks import lower_blocks
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.rows import around, how_many, move_into, room_for

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]

FAR = np.float32(1e3)  # metres: nothing near


class Lanes(NamedTuple):
    """Postures in blocks of sixteen: those of the group, and behind them the extra nodes of one key time."""

    lanes: Floats32  # (B, C, 7, 16)
    balls: Floats  # (B, C, 4)
    reach: float  # metres from the frame


@exact_kernel
def clearances_under(
    postures: Lanes, places: Floats, turns: Floats, obstacles: Nearby, chosen: Bools
) -> tuple[Floats32, int]:
    """The least clearances (F, 16 B) of all postures over some moments, in each of F chains of frames.

    `places` (F, m, 3) and `turns` (F, m, 4) are the carrier's frames in the world at the moments; only `chosen` (F,)
    chains are checked, and obstacles beyond some 6 cm may be left out. Also the number of capsules checked.
    """
    blocks, lanes = postures.lanes.shape[0], postures.lanes.shape[3]
    out = np.empty((places.shape[0], blocks, lanes), np.float32)
    out[:] = FAR
    most, checks = how_many(obstacles), 0
    near, moved = room_for(obstacles, most), room_for(obstacles, most)
    for f in range(places.shape[0]):
        if not chosen[f]:
            continue
        for i in range(places.shape[1]):
            count = around(obstacles, places[f, i], postures.reach, near)
            if count == 0:
                continue
            for b in range(count):
                move_into(near, b, places[f, i], turns[f, i], moved, b)
            checks += lower_blocks(postures.lanes, postures.balls, moved, count, out[f])
    return out.reshape(places.shape[0], blocks * lanes), checks
