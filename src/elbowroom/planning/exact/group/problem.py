"""One local group as its search sees it: what is known of it, what it has to do, and what was found."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.planning.exact.lattice.extra_nodes import ExtraNodes, extra_nodes
from elbowroom.planning.exact.lattice.postures import Postures
from elbowroom.planning.exact.sweep.motion_bounds import LimbSweeps
from elbowroom.planning.exact.sweep.node_clearances import NodeClearances
from elbowroom.world.obstacles.layout import Spans

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]


@by_reference
class Group(NamedTuple):
    """One group for a key interval: its postures, its limits, and what was computed for them."""

    postures: Postures
    levers: Floats  # (C, 3) as `levers_of`
    limits: Floats  # (d, 2) of the joints
    speed: float  # the greatest over all components together, rad/s, and
    acceleration: float  # rad/s^2
    tables: NodeClearances
    sweeps: LimbSweeps


class Weights(NamedTuple):
    """What a search prefers and where it ends; see `ExactSettings`."""

    step: float  # of an edge's squared length
    near: float  # of each squared metre that a node lacks of comfort
    comfort: float  # metres
    keeping: float  # squared radians that a node of the last plan costs less
    rounds: int  # paths that may turn out to touch


class GroupTask(NamedTuple):
    """What one group has to do."""

    goals: Floats  # (n+1, d)
    previous: Floats  # (n+1, d) what the last plan had
    start: Floats  # (d,)
    velocity: Floats  # (d,) there
    margins: Floats  # (n+1,) clearance of a node; less where the start has less, so that who stands close by can go
    motion_margins: Floats  # (n,) clearance of the motion at its samples; less where the start has less
    added: Floats32  # (n+1, W+EXTRA) added to the costs of the nodes
    roots: Longs  # (n,) cache entries of the root's sweeps
    carriers: Longs  # (n,) cache entries of the waist's sweeps, for a group that hangs on it
    obstacles: Spans  # in the world, in each key interval
    interval: float  # seconds
    harsh: bool  # whether it may begin as hard as it takes, if there is no other path
    settled: bool  # whether it goes on from a path that is proven: then the start lowers no clearance
    whole: bool = False  # whether all nodes are looked at, also those that the search could do without


class GroupPath(NamedTuple):
    """The outcome of a group's search."""

    reached: int  # n if there is a path, else the depth that none got beyond
    keys: Floats  # (reached+1, d)
    velocities: Floats  # (reached+1, d) of the curve
    entries: Longs  # (n,) cache entries of its sweeps through the intervals
    cost: Floats32  # (n+1, W+EXTRA) of the nodes, infinite where one is not free; too little where nobody looked
    most: float  # metres: no greater clearance was asked for, since the start has less
    checks: int  # capsules checked
    nodes: int  # settled
    rounds: int  # paths that were tried


class Guide(NamedTuple):
    """A path that a group's search is to follow."""

    keys: Floats  # (n+1, d)
    added: Floats32  # (n+1, W+EXTRA) what leaving it costs


def extras_of(group: Group, task: GroupTask) -> ExtraNodes:
    """The extra nodes of a task."""
    postures = group.postures
    return extra_nodes(
        postures.configurations, postures.columns, postures.step, task.goals, task.previous, task.start, task.settled
    )  # fmt: skip
