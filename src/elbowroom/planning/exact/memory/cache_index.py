"""Results kept from plan to plan, each found again by what it was computed from.

A plan asks for the tables of its key intervals. Most of them were computed for the plan before, whatever number the
interval has now: what is on the shelf under the same key is taken, the rest is computed and put there. Nothing depends
on what lies on the shelf but the time that it saves.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, inner_exact_kernel

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_NEXT, _ROUND, _HAND = range(3)


@by_reference
class CacheIndex(NamedTuple):
    """Numbered places for results: their keys, and which were asked for of late."""

    keys: Floats  # (S, K)
    ids: Longs  # (S,) of the result that lies there, never used twice; -1: none
    rounds: Longs  # (S,) when it was last asked for
    clock: Longs  # (3,) next id, round, place that is looked at first when one is needed


def new_cache_index(count: int, width: int) -> CacheIndex:
    """Empty slots for keys of `width` numbers."""
    return CacheIndex(np.zeros((count, width)), np.full(count, -1), np.zeros(count, np.int64), np.zeros(3, np.int64))


@exact_kernel
def begin_round(entries: CacheIndex) -> None:
    """What is asked for from now on stays until the next round begins."""
    entries.clock[_ROUND] += 1


@exact_kernel
def find(entries: CacheIndex, key: Floats) -> int:
    """The slot under `key` (K,), or -1."""
    for s in range(entries.ids.shape[0]):
        if entries.ids[s] < 0:
            continue
        same = True
        for i in range(key.shape[0]):
            if entries.keys[s, i] != key[i]:
                same = False
                break
        if same:
            entries.rounds[s] = entries.clock[_ROUND]
            return s
    return -1


@inner_exact_kernel
def admit(entries: CacheIndex, key: Floats) -> int:
    """A slot for a new result under `key`: one that this round has not asked for, of which there must be one."""
    count = entries.ids.shape[0]
    s = entries.clock[_HAND]
    while entries.ids[s] >= 0 and entries.rounds[s] == entries.clock[_ROUND]:
        s = (s + 1) % count
    entries.clock[_HAND] = (s + 1) % count
    for k in range(key.shape[0]):
        entries.keys[s, k] = key[k]
    entries.ids[s] = entries.clock[_NEXT]
    entries.clock[_NEXT] += 1
    entries.rounds[s] = entries.clock[_ROUND]
    return int(s)
