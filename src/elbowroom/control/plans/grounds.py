"""The two grounds of one avatar: that which it walks on, and that which it climbs where it finds no other way.

Who walks takes steps of up to a quarter of a metre; what is higher is in the way, and one goes round it. Who stands
before it, and finds no way on, looks at the same place as somebody who climbs: on ground that is reached by higher
steps. Where that leads on one is there from then on, and goes slowly, until both grounds are the same all about. Who
still comes to stand there is not stuck yet: that is undecided.
"""

import math
from contextlib import suppress
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.clips.motion_set import MotionSet
from elbowroom.control.plans.planning_scene import PlanningScene
from elbowroom.control.plans.wayfinder import Answer, Question
from elbowroom.control.settings import ControlSettings
from elbowroom.control.steering import direction
from elbowroom.planning.command import Command
from elbowroom.planning.model.highest_step import as_climbed, as_stepped, highest_climb
from elbowroom.planning.root.plan import RootPlanKind
from elbowroom.planning.stillness import is_still
from elbowroom.world.ground.ground import Ground, heights_beside
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_SLOWER = 0.4  # of the speed that is asked for
_ASKS = 0.1  # of full speed: who asks for less may as well stand
_ON = 0.1  # metres that a plan must lead on
_AGAIN = 1.0  # seconds until one looks again whether one can climb
_ABOUT, _ASIDE, _CELL = 8, 4, 0.1  # cells that are compared, and to either side of a way; their size in metres
_SAME, _NOWHERE = 1e-3, -1e6  # metres: heights that are not told apart, and that of no ground


class Grounds:
    """What one avatar walks and climbs in; `answer` is asked in another thread, one question at a time."""

    def __init__(self, humanoid: Humanoid, scene: Scene, settings: ControlSettings, motions: MotionSet) -> None:
        """As for `PlanningScene`."""
        self.walked = PlanningScene(humanoid, as_stepped(scene, humanoid), settings, motions)
        self._made_of = humanoid, scene, settings, motions
        self._again = 0.0  # seconds, when it is worth a look whether one can climb

    @cached_property
    def climbed(self) -> PlanningScene | None:
        """Where it climbs, made when it is first looked for; None where that leads no farther."""
        humanoid, scene, settings, motions = self._made_of
        climbed = as_climbed(scene, humanoid)
        return None if climbed is None else PlanningScene(humanoid, climbed, settings, motions)

    def around(self, *, climbs: bool) -> PlanningScene:
        """Where it walks, or climbs, if that leads anywhere else."""
        return (self.climbed or self.walked) if climbs else self.walked

    def forget(self) -> None:
        """Forget all that was planned, as if newly made."""
        self.walked.forget()
        with suppress(AttributeError):
            del self.climbed
        self._again = 0.0

    def answer(self, question: Question, *, climbs: bool, may_climb: bool) -> Answer | None:
        """Plan for who walks, or climbs; tells by `Answer.climbs` which of both from then on.

        Who walks and `may_climb` does so where there is no other way on.
        """
        root, command = question.query.root, question.query.command
        if climbs and self._differ(root, _about(root), _ABOUT):
            return self._climbing(question)
        answer = self.walked.wayfinder.answer(question)
        if answer is None or not (may_climb and _finds_no_way(answer, question)) or question.query.time < self._again:
            return answer
        if not is_still(np.array(root[3:6])):
            there = RootState.of(answer.path.states[-1])
            return answer._replace(undecided=self._differ(there, _ahead(there, command), 0))
        over = self._climbing(question) if self._differ(root, _ahead(root, command), 0) else None
        if over is not None and _leads_on(over):
            return over
        self._again = question.query.time + _AGAIN
        return answer

    def _climbing(self, question: Question) -> Answer | None:
        """Plan for who climbs."""
        if self.climbed is None:
            return None
        answer = self.climbed.wayfinder.answer(_slower(question))
        return None if answer is None else answer._replace(climbs=True)

    def _differ(self, root: RootState, places: Floats, first: int) -> bool:
        """Whether higher steps lead anywhere else at some `places` (rows, columns, 2), of which a row is here."""
        if self._higher is None:
            return False
        one, other = (
            np.maximum(heights_beside(ground, float(root.height), first, places), _NOWHERE)
            for ground in (self.walked.scene.ground, self._higher)
        )
        return bool(np.abs(one - other).max() > _SAME)

    @cached_property
    def _higher(self) -> Ground | None:
        """The ground as higher steps reach it; what is not plain has all that is level in it already."""
        ground, highest = self.walked.scene.ground, highest_climb(self._made_of[0])
        if not ground.plain:
            return ground._replace(step=highest) if highest > ground.step else None
        return None if self.climbed is None else self.climbed.scene.ground


def _about(root: RootState) -> Floats:
    """Places (rows, columns, 2), x and z, to all sides of a root, which stands in the middle of them."""
    cells = _CELL * np.arange(-_ABOUT, _ABOUT + 1.0)
    x, z = np.meshgrid(root.x + cells, root.z + cells)
    return np.stack([x, z], axis=-1)


def _ahead(root: RootState, command: Command) -> Floats:
    """Places (rows, columns, 2), x and z, from a root on where a command leads it, not those beside a stair."""
    onward, aside = _CELL * np.arange(_ABOUT + 1.0)[:, None], _CELL * np.arange(-_ASIDE, _ASIDE + 1.0)
    x, z = direction(command, root.heading).tolist()
    return np.stack([root.x + onward * x + aside * z, root.z + onward * z - aside * x], axis=-1)


def _slower(question: Question) -> Question:
    """The same, asked by somebody who takes his time."""
    asked = question.query.command
    command = replace(asked, forward=_SLOWER * asked.forward, strafe=_SLOWER * asked.strafe, run=False)
    return question._replace(query=question.query._replace(command=command))


def _finds_no_way(answer: Answer, question: Question) -> bool:
    """Whether the root is asked to go on, and finds no way."""
    asked = question.assist and question.query.command.speed > _ASKS
    return asked and answer.root.kind is RootPlanKind.STOPPED


def _leads_on(answer: Answer) -> bool:
    """Whether there is a way on, and it is one."""
    if answer.uppers is None or answer.root.kind is RootPlanKind.STOPPED:
        return False
    first, last = answer.path.states[0], answer.path.states[-1]
    return math.dist(first[:2], last[:2]) > _ON
