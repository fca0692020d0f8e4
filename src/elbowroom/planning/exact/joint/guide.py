"""From the decoupled search's tables to the joint step, and from its answer back to paths that are proven as shown.

The joint step decides at key times and by the groups' edges. Its answer guides the groups' own searches: what it chose
costs nothing there, everything else is dearer, and each group's path is proven as playback will show it. An edge that
turns out to touch is closed in the product, which is searched again.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.exact.group.problem import Group, GroupPath, GroupTask, Guide, extras_of
from elbowroom.planning.exact.joint.step import GroupNodes, PathSurroundings
from elbowroom.planning.exact.lattice.lattice import EXTRA, HOLD, PREVIOUS
from elbowroom.planning.exact.lattice.postures import BLOCK
from elbowroom.planning.exact.sweep.motion_bounds import SWEEP, RootSweeps
from elbowroom.world.obstacles.layout import Spans

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

_LATE_SAMPLES = (SWEEP // 2, 3 * SWEEP // 4)  # of the interval before a key time
_EARLY_SAMPLES = (0, SWEEP // 4, SWEEP // 2)  # of the interval after it
_DEARER = np.float32(0.5)  # squared radians: what a posture costs more that the guide did not choose


def waist_nodes(group: Group, task: GroupTask, path: GroupPath, keeping: float) -> GroupNodes:
    """The waist's nodes with the costs of its own search, which found `path`."""
    extras, alone = _alone(group, task, keeping)
    base = path.cost.copy()
    _only_start(base)
    return GroupNodes(group.postures, extras, base, alone, task.goals, task.margins)


def child_nodes(group: Group, task: GroupTask, keeping: float, most: float) -> GroupNodes:
    """A child's nodes, whatever is near; `most` is the greatest margin that may be asked for."""
    extras, base = _alone(group, task, keeping)
    margins = np.minimum(task.margins, most)
    _only_start(base)
    margins[0] = -np.inf
    return GroupNodes(group.postures, extras, base, base, task.goals, margins)


def _alone(group: Group, task: GroupTask, keeping: float) -> tuple[Floats, Floats32]:
    """The extra nodes' postures (n+1, EXTRA, d), and the costs (n+1, W+EXTRA) of all nodes where nothing is near."""
    extras, needed, previous = extras_of(group, task)
    known = group.postures.configurations
    depths, width = len(extras), len(group.postures.lanes) * BLOCK
    base = np.full((depths, width + EXTRA), np.inf, np.float32)
    base[:, : len(known)] = np.sum((known - task.goals[:, None]) ** 2, axis=2)
    base[:, width:] = np.where(needed, np.sum((extras - task.goals[:, None]) ** 2, axis=2), np.inf)
    last = np.arange(depths), previous
    base[last] -= np.minimum(np.float32(keeping), np.float32(0.5) * base[last])
    return extras, base


def _only_start(base: Floats32) -> None:
    """Leave at the first key time the start alone, in costs (n+1, W+EXTRA)."""
    base[0] = np.inf
    base[0, base.shape[1] - EXTRA + HOLD] = 0.0


def surroundings(states: Floats, sweeps: RootSweeps, roots: Indices, obstacles: Spans) -> PathSurroundings:
    """The pelvis at the moments around each key time at which a posture has to be free.

    `roots` (n,) are the entries of `sweeps` through which the root goes.
    """
    count, moments = len(states), len(_LATE_SAMPLES) + len(_EARLY_SAMPLES)
    places, turns = np.empty((count, moments, 3)), np.empty((count, moments, 4))
    for t in range(count):
        samples = [(t - 1, sample) for sample in _LATE_SAMPLES] if t > 0 else []
        samples += [(t, sample) for sample in _EARLY_SAMPLES] if t < count - 1 else [(t - 1, SWEEP)]
        for i in range(moments):
            interval, sample = samples[min(i, len(samples) - 1)]
            places[t, i], turns[t, i] = sweeps.places[roots[interval], sample], sweeps.turns[roots[interval], sample]
    return PathSurroundings(states, places, turns, obstacles)


def guide(nodes: GroupNodes, chosen: Indices) -> Guide:
    """The guide of a group through its nodes (n+1,) of the joint path."""
    width, depths = nodes.base.shape[1] - EXTRA, np.arange(len(chosen))
    keys = np.empty_like(nodes.goals)
    added = np.full(nodes.base.shape, _DEARER, np.float32)
    for t, node in enumerate(chosen):
        keys[t] = nodes.postures.configurations[node] if node < width else nodes.extras[t, node - width]
    added[depths, chosen] = 0.0
    added[:, width + PREVIOUS] = 0.0
    return Guide(keys, added)
