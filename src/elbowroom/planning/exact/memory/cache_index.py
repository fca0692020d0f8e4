"""Results kept from plan to plan, each found again by what it was computed from.

A plan asks for the tables of its key intervals. Most of them were computed for the plan before, whatever number the
interval has now: what is on the shelf under the same key is taken, the rest is computed and put there. Nothing depends
on what lies on the shelf but the time that it saves.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, exact_lean_kernel

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

SAME = 1e-6  # keys this near to each other, in each component, are one
_NEXT, _ROUND, _HAND = range(3)


class Slots(NamedTuple):
    """Numbered places for results: their keys, and which were asked for of late."""

    keys: Floats  # (S, K)
    ids: Longs  # (S,) of the result that lies there, never used twice; -1: none
    rounds: Longs  # (S,) when it was last asked for
    clock: Longs  # (3,) next id, round, place that is looked at first when one is needed


def new_slots(count: int, width: int) -> Slots:
    """Empty slots for keys of `width` numbers."""
    return Slots(np.zeros((count, width)), np.full(count, -1), np.zeros(count, np.int64), np.zeros(3, np.int64))


@exact_kernel
def begin_round(slots: Slots) -> None:
    """What is asked for from now on stays until the next round begins."""
    slots.clock[_ROUND] += 1


@exact_lean_kernel
def find(slots: Slots, key: Floats) -> int:
    """The slot under `key` (K,), or -1."""
    for s in range(slots.ids.shape[0]):
        if slots.ids[s] < 0:
            continue
        same = True
        for i in range(key.shape[0]):
            if abs(slots.keys[s, i] - key[i]) > SAME:
                same = False
                break
        if same:
            slots.rounds[s] = slots.clock[_ROUND]
            return s
    return -1


@exact_lean_kernel
def admit(slots: Slots, key: Floats) -> int:
    """A slot for a new result under `key`: one that this round has not asked for, of which there must be one."""
    count = slots.ids.shape[0]
    s = slots.clock[_HAND]
    while slots.ids[s] >= 0 and slots.rounds[s] == slots.clock[_ROUND]:
        s = (s + 1) % count
    slots.clock[_HAND] = (s + 1) % count
    for k in range(key.shape[0]):
        slots.keys[s, k] = key[k]
    slots.ids[s] = slots.clock[_NEXT]
    slots.clock[_NEXT] += 1
    slots.rounds[s] = slots.clock[_ROUND]
    return int(s)
