"""What the controller shows in one moment, and why."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL
from elbowroom.body.gait.foot_state import standing
from elbowroom.body.gait.stride import feet_standing
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.pose import Pose, pose_of
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.key_frame_queue import KeyFrames
from elbowroom.planning.command import Command
from elbowroom.planning.result import LocalPlan, PlanStatus
from elbowroom.planning.root.plan import RootPlan

Floats = NDArray[np.float64]

STANDING = Command()


class Phase(Enum):
    """The flow of the control loop (the paper's Figure 4) that a turn took."""

    PLAN = "plan"  # flow A
    PLAY = "play"  # flow B
    RESET = "reset"  # flow C


@dataclass(frozen=True, eq=False)
class PlanReport:
    """One planning call: where it started, what it found, what it cost."""

    number: int  # 1 for the first
    time: float  # seconds, when its result was taken over
    command: Command  # what it was made for
    root: RootPlan  # the path of the legs, and how it was found
    local: LocalPlan  # the upper-body motion along it

    @property
    def found(self) -> bool:
        """Whether the path got its upper-body motion."""
        return self.local.status is PlanStatus.FOUND

    @property
    def checks(self) -> int:
        """The collision checks of both searches."""
        return self.root.checks + self.local.checks

    def goal_at(self, time: float) -> Floats:
        """What the goal functions would show (LOCAL,) at a time, in seconds."""
        path, goals = self.root.path, self.local.goals
        place = min(max((time - path.start_time) / path.interval, 0.0), len(goals) - 1.0)
        k = min(int(place), len(goals) - 2)
        goal: Floats = goals[k] + (place - k) * (goals[k + 1] - goals[k])
        return goal


@dataclass(frozen=True, eq=False)
class Frame:
    """A pose that may be shown: with assistance on it touches nothing."""

    time: float  # seconds since the start, by the sum of all dt
    q: Floats  # (DOF,) the configuration, see `body.dof`
    root: Floats  # (SHOWN,) the root state (7,), the feet, and how hips, chest and head are carried, see `body.root`
    phase: Phase  # the flow that the last turn took
    clearance: float  # metres from the nearest obstacle, negative where touching, infinite where there is none
    stuck: bool  # the user pushes, and planning has found no way on for the root or for the limbs
    touching: bool  # part of the body is in an obstacle: with assistance off, or hit by what moves and leaves no way
    fill: int  # unplayed key frames in the queue
    key_frames: KeyFrames  # the unplayed key frames
    plan: PlanReport | None  # the last planning call
    command: Command = STANDING  # what was obeyed: the user's, or that of a walk to a place

    @property
    def goal(self) -> Floats:
        """What the goal functions would show now (LOCAL,); what is shown, where nothing was planned."""
        return self.q[DOF - LOCAL :] if self.plan is None else self.plan.goal_at(self.time)

    def pose(self, humanoid: Humanoid) -> Pose:
        """The pose in the terms of VRM, for who draws the avatar that walks: rotations of bones, places of joints."""
        return pose_of(humanoid, self.q, self.root)

    @property
    def contacts(self) -> NDArray[np.bool_]:
        """Which feet, left and right, stand on the ground, (2,): where legs have room, one that does does not move."""
        return contacts_of(self.root)


def contacts_of(root: Floats) -> NDArray[np.bool_]:
    """Which feet, left and right, stand on the ground (2,) at a root state with feet, or of the cycle (7,)."""
    return standing(root) if len(root) > ROOT_STATE else feet_standing(1.0, root[None])[0]
