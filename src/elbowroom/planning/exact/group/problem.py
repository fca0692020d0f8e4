"""One local group as its search sees it: what is known of it, what it has to do, and what was found."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.exact.lattice.extra_nodes import extra_nodes
from elbowroom.planning.exact.lattice.postures import Postures
from elbowroom.planning.exact.sweep.motion_bounds import LimbSweeps
from elbowroom.planning.exact.sweep.node_clearances import NodeClearances
from elbowroom.world.obstacles.layout import Spans

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]


class Group(NamedTuple):
    """One group for a key interval: what is known of it once and for all, and its shelves."""

    postures: Postures
    levers: Floats  # (C, 3) as `levers_of`
    limits: Floats  # (d, 2) of the joints
    speed: float  # the greatest over all components together, rad/s, and
    acceleration: float  # rad/s^2
    tables: NodeClearances
    ways: LimbSweeps


class Weights(NamedTuple):
    """What a search prefers and where it ends; see `ExactSettings`."""

    step: float
    near: float
    comfort: float
    keeping: float
    rounds: int


class GroupTask(NamedTuple):
    """What one group has to do."""

    goals: Floats  # (n+1, d)
    previous: Floats  # (n+1, d) what the last plan had
    start: Floats  # (d,)
    velocity: Floats  # (d,) there
    margins: Floats  # (n+1,) clearance of a node; less where the start has less, so that who stands close by can go
    motion_margins: Floats  # (n,) clearance of the motion at the looks; less where the start has less
    extra: Floats32  # (n+1, W+OWN) added to the nodes' prices
    roots: Longs  # (n,) slots of the root ways
    carriers: Longs  # (n,) slots of the waist's ways, for an arm
    obstacles: Spans  # in the world, in each key interval
    interval: float
    harsh: bool  # whether it may begin as hard as it takes, if there is no other way
    settled: bool  # whether it goes on from a way that is proven: then the start lowers no clearance


class GroupPath(NamedTuple):
    """What was found."""

    reached: int  # n if there is a way, else the depth that none got beyond
    keys: Floats  # (reached+1, d)
    velocities: Floats  # (reached+1, d) of the curve
    entries: Longs  # (n,) of the ways through the intervals
    cost: Floats32  # (n+1, W+OWN) of the nodes, infinite where one is not free
    most: float  # metres: no greater clearance was asked for, since the start has less
    checks: int  # capsules checked
    nodes: int
    rounds: int  # motions that were tried


def extra_postures(group: Group, task: GroupTask) -> tuple[Floats, Bools, Longs]:
    """The postures of each key time alone (n+1, OWN, d), which of them are needed, and the last plan's nodes (n+1,).

    A posture that is among the others already needs no node of its own.
    """
    postures = group.postures
    return extra_nodes(
        postures.configurations, postures.columns, postures.step, task.goals, task.previous, task.start, task.settled
    )  # fmt: skip
