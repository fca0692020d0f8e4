"""What one plan may cost, and what was found to be no way: for who stands that stays known until it moves."""

import math
from typing import NamedTuple

from elbowroom.planning.command import Command
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperPlan
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.result import LocalPlan
from elbowroom.planning.root.path import RootPath

_SAME_PLACE = 0.3  # metres: blocked places that are taken for one
_SOON = 1.05  # seconds ahead: what is nearer is thought through at once
_NEAR = 1e-6  # metres, radians: who has moved by less stands where he stood
# Work is counted in capsules checked, some 10 to 20 ns each. These cost as much as so many of them: a triple, a node, a
# path for the upper body, the tables of all groups together, a place of the root.
_TRIPLE, _NODE, _PATH, _TABLES, _PLACE = 2.5, 10, 150_000, 500_000, 60
_PLACE_UNEVEN = 600  # a place where the ground is uneven: there it is looked up what each foot stands on
# Work of a plan after which nothing is begun but a safe end: at leisure, and in a hurry. Where something moves, to stop
# is no safe end, and more is tried at once.
_MOST, _MOST_IN_A_HURRY = 1.5e6, 5e5
_MOST_AMONG_MOVING, _MOST_AMONG_MOVING_IN_A_HURRY = 2e6, 8e5
_WAITED_FOR = 0.5  # the share of that for a plan that somebody waits for, who sees what was planned before meanwhile
_LITTLE = 5e5  # work of a plan in which it is asked why there is no path
_ORDER = Effort.GLANCE, Effort.QUICK, Effort.JOINT, Effort.REFINED  # from little to much
_REMEMBERED = 200  # root paths


def same_place(a: tuple[float, float], b: tuple[float, float]) -> bool:
    """Whether two blocked places (x, z) are one."""
    return math.dist(a, b) < _SAME_PLACE


class _Failed(NamedTuple):
    """A root path on which the upper body found no way."""

    effort: Effort
    upper: UpperPlan


class LeftOff(NamedTuple):
    """Where the plan of somebody who walks ended for what it had cost; the next one goes on there."""

    tried: int  # root paths, in the order in which they are offered
    place: tuple[float, float]  # x and z, where the last of them was blocked


class Attempts:
    """The attempts of one plan, as far as it may go, and the vain ones of the plans before."""

    def __init__(self) -> None:
        self._work, self._most = 0.0, _MOST  # of this plan, in capsules checked
        self._place = _PLACE  # what one costs on this ground
        self._seen: tuple[float, float] | None = None  # the place that ended the commanded path in the plan before
        self._stood: tuple[float, ...] | None = None  # where somebody stands
        self._failed: dict[bytes, _Failed] = {}  # the vain ones from there
        self._command: Command | None = None  # that is answered
        self.left_off: LeftOff | None = None  # where the plan before did, if this one wants the same
        self._postponed = False  # whether it was left for later to ask why there is no path

    def begin(
        self, query: MotionQuery, *, hurry: bool, stands: bool, uneven: bool = False, moving: bool = False
    ) -> None:
        """Begin a plan; `stands` says that nothing moves, the avatar neither, `moving` that something else does.

        `uneven` says that the ground is no plane: who walks there is always in a hurry.
        """
        self._work, self._postponed = 0.0, False
        self._place = _PLACE_UNEVEN if uneven else _PLACE
        leisure, haste = (_MOST_AMONG_MOVING, _MOST_AMONG_MOVING_IN_A_HURRY) if moving else (_MOST, _MOST_IN_A_HURRY)
        if hurry or (uneven and not stands and not moving):
            self._most = _WAITED_FOR * haste if query.hurry else haste
        else:
            self._most = leisure
        here, stood = (*query.root, *query.upper.tolist()) if stands else None, self._stood
        if here is None or stood is None or max(abs(a - b) for a, b in zip(here, stood, strict=True)) > _NEAR:
            self._failed.clear()
        self._stood = here
        if stands or hurry or moving or query.command != self._command:
            self.left_off = None
        self._command = query.command

    def failed(self, path: RootPath, effort: Effort) -> UpperPlan | None:
        """What was found on a root path when no less was tried on it, if that led nowhere."""
        known = self._failed.get(path.states.tobytes()) if self._failed else None
        return None if known is None or _ORDER.index(known.effort) < _ORDER.index(effort) else known.upper

    def enter_root(self, checks: int) -> None:
        """A root path was made, for which so many places and postures were looked at."""
        self._work += self._place * checks

    def enough(self, checks: int) -> bool:
        """Whether a search for a root path that has found nothing yet, and looked at so many more, is to be left."""
        self.enter_root(checks)
        return self.spent

    def enter(self, path: RootPath, effort: Effort, upper: UpperPlan) -> None:
        """A path was sought for the upper body."""
        self._work += _PATH + _work(upper.plan)
        if self._stood is not None and upper.reached < path.horizon and len(self._failed) < _REMEMBERED:
            self._failed[path.states.tobytes()] = _Failed(effort, upper)

    @property
    def spent(self) -> bool:
        """Whether this plan has cost as much as it may: nothing is begun any more, the best so far will do."""
        return self._work > self._most

    def may_ask_why(self) -> bool:
        """Whether so little was done in this plan that it may be asked why there is no path; if not, a later may."""
        self._postponed = self._work > _LITTLE
        return not self._postponed

    @property
    def thorough(self) -> bool:
        """Whether nothing was left out in this plan for what it would have cost."""
        return not (self.spent or self._postponed)

    def can_wait(self, place: tuple[float, float], ahead: float) -> bool:
        """Whether the commanded path, ending at a place (x, z) `ahead` seconds from now, need not be thought through.

        That is so where it is far off and was not in the way in the plan before: whoever steers round a bend looks at
        the wall all the time, and seldom means to walk into it.
        """
        before, self._seen = self._seen, place
        return ahead > _SOON and (before is None or not same_place(place, before))


def _work(upper: LocalPlan) -> float:
    """What a search for the upper body cost beside its path, in capsules checked."""
    work = float(sum(row.checks + _NODE * row.nodes for row in upper.evidence))
    if upper.joint is not None:
        work += _TABLES + upper.joint.checks + _TRIPLE * upper.joint.states
    return work
