"""From the decoupled search's tables to the joint step, and from its answer back to ways that are proven as shown.

The joint step decides at key times and by the groups' steps. Its answer guides the groups' own searches: what it chose
costs nothing there, everything else is dearer, and each group's way is proven as playback will show it. A step that
turns out to touch is closed in the product, which is searched again.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.exact.group.problem import Group, GroupPath, GroupTask, extra_postures
from elbowroom.planning.exact.joint.step import GroupNodes, Surroundings
from elbowroom.planning.exact.lattice.lattice import EXTRA, HOLD, KEPT
from elbowroom.planning.exact.lattice.postures import BLOCK
from elbowroom.planning.exact.sweep.motion_bounds import SWEEP, RootSweeps
from elbowroom.world.obstacles.layout import Spans

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

_LATE_LOOKS = (SWEEP // 2, 3 * SWEEP // 4)  # of the interval before a key time
_EARLY_LOOKS = (0, SWEEP // 4, SWEEP // 2)  # of the interval after it
_DEARER = np.float32(0.5)  # squared radians: what a posture costs more that the guide did not choose


class Guide(NamedTuple):
    """One group's part of the joint step's answer."""

    keys: Floats  # (n+1, d)
    extra: Floats32  # (n+1, W+OWN) what its search has to pay for leaving it


def waist_nodes(group: Group, task: GroupTask, way: GroupPath, keeping: float) -> GroupNodes:
    """The waist's nodes, priced as in its own search."""
    own, alone = _alone(group, task, keeping)
    base = way.cost.copy()
    _only_start(base)
    return GroupNodes(group.postures, own, base, alone, task.goals, task.margins)


def arm_nodes(group: Group, task: GroupTask, keeping: float, most: float) -> GroupNodes:
    """An arm's nodes, whatever is near; `most` is the greatest margin that may be asked for."""
    own, base = _alone(group, task, keeping)
    margins = np.minimum(task.margins, most)
    _only_start(base)
    margins[0] = -np.inf
    return GroupNodes(group.postures, own, base, base, task.goals, margins)


def _alone(group: Group, task: GroupTask, keeping: float) -> tuple[Floats, Floats32]:
    """The postures (n+1, OWN, d) of each key time alone, and the prices (n+1, W+OWN) of all nodes in the open."""
    own, needed, previous = extra_postures(group, task)
    known = group.postures.configurations
    depths, width = len(own), len(group.postures.lanes) * BLOCK
    base = np.full((depths, width + EXTRA), np.inf, np.float32)
    base[:, : len(known)] = np.sum((known - task.goals[:, None]) ** 2, axis=2)
    base[:, width:] = np.where(needed, np.sum((own - task.goals[:, None]) ** 2, axis=2), np.inf)
    last = np.arange(depths), previous
    base[last] -= np.minimum(np.float32(keeping), np.float32(0.5) * base[last])
    return own, base


def _only_start(base: Floats32) -> None:
    base[0] = np.inf
    base[0, base.shape[1] - EXTRA + HOLD] = 0.0


def surroundings(states: Floats, ways: RootSweeps, roots: Indices, obstacles: Spans) -> Surroundings:
    """The pelvis at the moments around each key time, where its postures have to be free."""
    count, moments = len(states), len(_LATE_LOOKS) + len(_EARLY_LOOKS)
    places, turns = np.empty((count, moments, 3)), np.empty((count, moments, 4))
    for t in range(count):
        samples = [(t - 1, sample) for sample in _LATE_LOOKS] if t > 0 else []
        samples += [(t, sample) for sample in _EARLY_LOOKS] if t < count - 1 else [(t - 1, SWEEP)]
        for i in range(moments):
            interval, sample = samples[min(i, len(samples) - 1)]
            places[t, i], turns[t, i] = ways.places[roots[interval], sample], ways.turns[roots[interval], sample]
    return Surroundings(states, places, turns, obstacles)


def guide(nodes: GroupNodes, chosen: Indices) -> Guide:
    """The guide of a group for its nodes (n+1,) of the joint way."""
    width, depths = nodes.base.shape[1] - EXTRA, np.arange(len(chosen))
    keys = np.empty_like(nodes.goals)
    extra = np.full(nodes.base.shape, _DEARER, np.float32)
    for t, node in enumerate(chosen):
        keys[t] = nodes.postures.configurations[node] if node < width else nodes.own[t, node - width]
    extra[depths, chosen] = 0.0
    extra[:, width + KEPT] = 0.0
    return Guide(keys, extra)
