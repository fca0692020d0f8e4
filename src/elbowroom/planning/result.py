"""What a search hands back: how it ended, what it found, and what that cost."""

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup


class PlanStatus(Enum):
    """How a search ended."""

    FOUND = "found"  # there is motion for the whole path
    EXHAUSTED = "exhausted"  # every way was tried
    OUT_OF_BUDGET = "out of budget"  # stopped after the allowed number of collision checks


@dataclass(frozen=True, eq=False)
class SearchResult:
    """The outcome of one search in a C-T roadmap."""

    status: PlanStatus
    path: NDArray[np.float64]  # (n+1, d) configurations at the key times, radians; (0, d) unless FOUND
    vertices: NDArray[np.int32]  # (n+1,) their vertices in the activity graph; (0,) unless FOUND
    checks: int  # collision checks: one for each candidate that was tested
    nodes: int  # nodes taken from the stack
    enhanced: int  # vertices added to the activity graph
    nanoseconds: int  # wall time of the search, its validity tables included


class GroupEvidence(NamedTuple):
    """What the search for one group cost."""

    group: DofGroup
    status: PlanStatus
    checks: int
    nodes: int
    enhanced: int
    nanoseconds: int


class JointEvidence(NamedTuple):
    """What searching all groups together cost, and how it ended.

    FOUND: the cheapest way through the product of all postures that the searches had, by steps that had not been found
    to touch; EXHAUSTED: the proof that the product has none.
    """

    status: PlanStatus
    states: int  # triples of waist, left and right arm that were settled
    checks: int  # capsules checked to fill its tables
    nanoseconds: int


class BlockadeKind(Enum):
    """Why there is no way on."""

    NO_POSTURE = "no posture"  # obstacles close every posture at the place
    OUT_OF_REACH = "out of reach"  # they close every posture that could be reached there in time
    MOTION = "motion"  # postures are free, and every motion that was tried between them touches


@dataclass(frozen=True)
class Blockade:
    """A certificate that the upper body has no way on: the slice that ends it and the obstacles that close it.

    Each of the obstacles is needed: without it a posture there would be free.
    """

    kind: BlockadeKind
    time: float  # seconds, the key time
    place: tuple[float, float]  # x and z of the root then, metres
    ahead: float  # metres that the root walks until there
    obstacles: tuple[int, ...]  # their numbers in the scene; none for MOTION


class LocalPlan(NamedTuple):
    """Upper-body motion for a root path, or the status of the first group that found none."""

    status: PlanStatus  # how the search ended
    configurations: NDArray[np.float64]  # (n+1, LOCAL) at the key times; (0, LOCAL) unless FOUND
    goals: NDArray[np.float64]  # (n+1, LOCAL) what the goal functions asked for
    evidence: tuple[GroupEvidence, ...]  # of the groups that were searched, in order
    joint: JointEvidence | None = None  # of the groups together, where one after the other led nowhere
    blockade: Blockade | None = None  # why this is not the whole way that was asked for, if the planner can say it
    velocities: NDArray[np.float64] | None = None  # (n+1, LOCAL) of the curve there, if the planner chose them

    @property
    def checks(self) -> int:
        """Collision checks of all groups."""
        return sum(group.checks for group in self.evidence) + (self.joint.checks if self.joint else 0)

    @property
    def nodes(self) -> int:
        """Nodes taken from the stack in all groups."""
        return sum(group.nodes for group in self.evidence)

    @property
    def enhanced(self) -> int:
        """Vertices added to the activity graphs."""
        return sum(group.enhanced for group in self.evidence)
