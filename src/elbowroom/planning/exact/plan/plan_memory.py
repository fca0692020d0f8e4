"""All that one walker keeps from plan to plan, in one object.

There are two kinds of it. What the next plan *goes on from* is part of the question: the previous plans, which it keeps
near to; the walk that goes on as long as it is good; the postures that were added where it was blocked; which attempt
has its turn. What was *found out* only saves time: each result lies under all that it depends on, so a plan is the same
without it (`ExactSettings.remember`).

It is void as a whole or not at all: with `reset`, and with another key interval, for which there is another model. What
stands in the scene never changes. Whether something of it suits a question is said by its times and places: a walk
goes on if nothing moves, nobody is in a hurry, the command is the same and the avatar is where the plan leads.
"""

import math
from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, DofGroup
from elbowroom.planning.command import Command
from elbowroom.planning.exact.group.caches import PlanCaches, new_caches, with_set
from elbowroom.planning.exact.group.upper_body_model import PostureSet, UpperBodyModel
from elbowroom.planning.exact.plan.attempts import Attempts
from elbowroom.planning.exact.plan.full_plan import StandingPlan
from elbowroom.planning.exact.plan.ongoing import OngoingPlan
from elbowroom.planning.exact.plan.recent_plans import RecentPlans
from elbowroom.planning.exact.refine.sampling import Pool, RefinementSettings
from elbowroom.planning.model.footing import Underfoot
from elbowroom.planning.result import Blockade

Floats = NDArray[np.float64]


class PlanMemory:
    """What one walker keeps; `model` is what it walks as, `underfoot` what its feet stand on."""

    def __init__(self, model: UpperBodyModel, underfoot: Underfoot) -> None:
        self.model, self._underfoot = model, underfoot
        # what the next plan goes on from
        self.recent = RecentPlans()
        self.ongoing: OngoingPlan | None = None
        self.command: Command | None = None  # what was asked for last
        self.attempts = Attempts()
        self.blockade: Blockade | None = None  # why there was no path when that was asked last
        self.asked_at = math.inf, math.inf  # x, z of who asked
        self._added = {group: Pool(group.size, RefinementSettings().capacity) for group in LOCAL_GROUPS}
        self._sets: Mapping[DofGroup, PostureSet] = model.sets
        # what was found out
        self.standing: StandingPlan | None = None
        settings = model.settings
        horizon = round((settings.look_ahead + settings.spare) / model.interval)
        self._caches = new_caches(model, self._sets, horizon, underfoot)

    def begin(self, horizon: int) -> PlanCaches:
        """The results that a search over so many key intervals can use and add to."""
        if horizon > self._caches.horizon or not self.model.settings.remember:
            most = max(horizon, self._caches.horizon)
            self._caches = new_caches(self.model, self._sets, most, self._underfoot)
        return self._caches

    def known(self, group: DofGroup) -> Floats:
        """The postures (V, d) of a group: those of its clips, and those that were added."""
        return np.concatenate([self.model.points[group], self._added[group].postures])

    def add(self, group: DofGroup, postures: Floats) -> bool:
        """Add postures (N, d) to a group, in place of the oldest ones where they are too many; whether any is new."""
        return self._added[group].add(postures)

    def take_in(self, groups: Iterable[DofGroup]) -> None:
        """Plan with the postures that were added to some groups; they are this walker's, the model stays as it is."""
        for group in groups:
            made = self.model.set_of(group, self.known(group))
            self._sets = {**self._sets, group: made}
            self._caches = with_set(self._caches, self.model, group, made)
