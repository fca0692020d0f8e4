"""One question about the way ahead, and who answers it: root path, upper body, and what to do after a contact.

A question holds all that its answer depends on, besides what the planners remember, so that it can be answered in
another thread while playback goes on.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.clips.motion_set import MotionSet
from elbowroom.control.plans.canned import canned_walk
from elbowroom.control.plans.planners import Planners
from elbowroom.control.plans.rehearsal import Held, Rehearsal, frozen_motion, partial_motions, standing_path
from elbowroom.control.settings import ControlSettings
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.planning.motion import Motion, MotionQuery, SupersededError
from elbowroom.planning.result import LocalPlan, PlanStatus
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan
from elbowroom.planning.root.query import Asked

Floats = NDArray[np.float64]


class Question(NamedTuple):
    """What to plan for."""

    query: MotionQuery
    assist: bool  # off: the canned walk
    held: Held | None  # the pose in which the avatar is held after a contact
    reserve: int  # key intervals to plan, where the planner sees farther than the queue is long


class Answer(NamedTuple):
    """What was planned, and what of it can be shown."""

    root: RootPlan
    local: LocalPlan
    path: RootPath
    uppers: Floats | None  # (n+1, LOCAL) along the path; None where there is no way
    velocities: Floats | None  # (n+1, LOCAL) where the planner has chosen them
    travel: float | None = None  # radians, the heading that it means to travel; None where that is nowhere
    climbs: bool = False  # on the ground that one climbs
    undecided: bool = False  # it leads to a stand from where one may climb: that is looked at there


class Wayfinder:
    """Answers one question at a time, whichever thread asks, with planners that remember what they have planned."""

    def __init__(
        self,
        settings: ControlSettings,
        check: BodyCheck,
        motions: MotionSet,
        planners: Planners,
        *,
        forgets: bool = False,
    ) -> None:
        """The planners are made with the first answer, if they are not made yet: that takes a while.

        `forgets`: it begins by forgetting all that they have planned.
        """
        self._settings, self._check, self._motions = settings, check, motions
        self._planners, self._forgets = planners, forgets
        self._rng = np.random.default_rng(settings.seed)

    def afresh(self) -> "Wayfinder":
        """Another with the same planners, as if newly made.

        This one may be planning still, for nobody: the other's first answer waits until it has ended, its caller not.
        """
        return Wayfinder(self._settings, self._check, self._motions, self._planners, forgets=True)

    def answer(self, question: Question) -> Answer | None:
        """Plan; after a contact, find a way out of it. None if nobody waits for it any more."""
        with self._planners.lock:
            memory = self._planners.root.memory
            try:
                question.query.go_on()
                if self._forgets:
                    self._forgets = False
                    self._planners.forget()
                    memory = self._planners.root.memory
                root, local = self._search(question)
            except SupersededError:
                self._planners.root.memory = memory
                return None
            found = local.status is PlanStatus.FOUND
            line = self._planners.root.memory.line
            travel = None if line is None else line.heading
            answer = Answer(root, local, root.path, local.configurations if found else None, local.velocities, travel)
            return self._way_out(answer, question) if question.held is not None else answer

    def _search(self, question: Question) -> Motion:
        """A root path and its upper body; from the planner as one if it can do that."""
        query = question.query
        self._planners.root.others = query.others
        planner = self._planners.motion
        if question.assist and planner is not None:
            far = query._replace(horizon=max(query.horizon, question.reserve))
            return planner.plan_motion(self._planners.root, far)
        root = self._planners.root.plan(Asked(query.root, query.command, query.horizon, query.interval, query.time))
        if not question.assist:
            return Motion(root, canned_walk(root.path, query.upper, self._motions))
        return Motion(root, self._planners.upper.plan(root.path, query.upper, self._rng))

    def _way_out(self, answer: Answer, question: Question) -> Answer:
        """What can follow a contact: a motion that does not touch again within the first key interval, if there is one.

        Hard against an obstacle nearly every move of a limb touches it. So to keep the pose is a way out too: where the
        plan's way begins too close by, or, without a plan, where the root leads away: whoever walked in can walk out.
        Where even that touches, the root stands and the limbs free themselves, together or one before the other.
        """
        assert question.held is not None
        path, motion, upper = answer.path, answer.uppers, question.query.upper
        rehearsal = Rehearsal(question.held, self._check)
        if motion is not None and rehearsal.is_playable(path, motion):
            return answer
        frozen = frozen_motion(path, upper)
        useful = motion is not None or rehearsal.leads_away(path, frozen)
        if useful and rehearsal.is_playable(path, frozen):
            return answer._replace(uppers=frozen, velocities=None)
        standing = standing_path(path, question.held.root)
        freed = self._planners.upper.plan(standing, upper, self._rng).configurations
        parts = partial_motions(freed, upper) if len(freed) else []
        part = next((part for part in parts if rehearsal.is_playable(standing, part)), None)
        return answer._replace(path=standing, uppers=part, velocities=None)
