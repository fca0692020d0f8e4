"""One walk of a dataset: drawn by its number, walked, judged."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.clip import Clip, motions_of
from elbowroom.clips.motion_set import MotionSet
from elbowroom.clips.style import style_named
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.dataset.company import Company, NoRoomError, company_of
from elbowroom.dataset.draw import DrawnWalk, draw
from elbowroom.dataset.hands import HANDS, TOUR, UsersWay
from elbowroom.dataset.row import Row, others_in, row_of
from elbowroom.dataset.spec import STOCK, STYLE, DatasetSpec, level
from elbowroom.experiment.crossing import DT, start_for
from elbowroom.experiment.gauntlet.course import CourseMaker, NoCourseError
from elbowroom.experiment.judge.apart import ShownWalker, judge_apart
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.verdict import judge
from elbowroom.experiment.opened import Openable, opened
from elbowroom.experiment.table1.tasks import AvatarFile, NamedScene
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene

_STEP = 0.1  # metres between the points of a course's route


class Setting(NamedTuple):
    """Who walks where, from where, and where to."""

    humanoid: Humanoid
    scene: Scene
    way: UsersWay


@dataclass(frozen=True)
class SwingFile:
    """The motions of who walks as in a clip (FILE, FILE#CLIP) or a style (style:NAME); `stock` are the stock ones."""

    name: str

    def open(self) -> MotionSet:
        """Read it."""
        if self.name.startswith(STYLE):
            return motions_of(style=style_named(self.name.removeprefix(STYLE)))
        return motions_of(None if self.name == STOCK else Clip.load(self.name))


@dataclass(frozen=True)
class WalkTask:
    """A walk as a task for a process of its own: its row, or why there is none."""

    spec: DatasetSpec
    number: int

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """Avatar and motions, and the scene unless it is made by a seed."""
        drawn = draw(self.spec, self.number)
        scene = () if level(drawn.place) is not None else (NamedScene(drawn.place),)
        others = (_avatar(name) for name in dict.fromkeys(drawn.others) if name != drawn.avatar)
        return (_avatar(drawn.avatar), SwingFile(drawn.swing), *scene, *others)

    def run(self) -> Row | str:
        """Walk and judge."""
        drawn = draw(self.spec, self.number)
        try:
            setting = setting_of(drawn)
        except NoCourseError:
            return "the seed gives no course for this body"
        controller = controller_of(self.spec, drawn, setting)
        try:
            company = company_on(drawn, setting, controller)
        except NoRoomError as error:
            return str(error)
        steps = list(steps_of(self.spec, drawn, setting, controller, company))
        walkers = [_shown(setting.humanoid, [frame for _, frame in steps])]
        walkers += [_shown(one.humanoid, one.frames) for one in company.companions]
        fault = _fault(walkers, setting.scene)
        if fault is not None:
            return fault
        row = row_of(self.number, drawn, self.spec.fps, setting.humanoid, setting.scene, steps)
        return row | others_in(company, drawn.others, self.spec.fps)


def setting_of(drawn: DrawnWalk) -> Setting:
    """Avatar and place of a walk; raises `NoCourseError` where a seed gives this body no course."""
    avatar, wanted = _avatar(drawn.avatar), level(drawn.place)
    humanoid = opened(avatar)
    if wanted is None:
        scene = opened(NamedScene(drawn.place))
        finish = scene.finish.position
        return Setting(humanoid, scene, UsersWay(np.array([(scene.start.x, scene.start.z), finish])))
    course = _maker(avatar).course(wanted, drawn.seed)
    route = course.line.points(np.arange(0.0, course.line.length, _STEP))
    return Setting(humanoid, course.scene, UsersWay(route, course.line))


def controller_of(spec: DatasetSpec, drawn: DrawnWalk, setting: Setting) -> Controller:
    """The controller at the start of a walk."""
    start = setting.scene.start if setting.way.line is not None else start_for(setting.scene, drawn.seed)
    motions = opened(SwingFile(drawn.swing))
    return Controller(
        setting.humanoid, setting.scene, planner=spec.planner, seed=drawn.seed, start=start, motions=motions
    )


def steps_of(
    spec: DatasetSpec, drawn: DrawnWalk, setting: Setting, controller: Controller, company: Company
) -> Iterator[tuple[Command, Frame]]:
    """The walk, 60 frames a second: until the finish, or its time is over; a tour goes on past the finish."""
    hand = HANDS[drawn.steering](setting.way, controller, np.random.default_rng([drawn.seed, 1]))
    frame = None
    for number in range(round(spec.seconds / DT)):
        command = hand(number * DT, controller.root, frame is not None and frame.stuck)
        company.tell()
        frame = controller.step(command, DT)
        company.step(number * DT)
        yield command, frame
        if drawn.steering != TOUR and setting.scene.finished(controller.root):
            return


def company_on(drawn: DrawnWalk, setting: Setting, controller: Controller) -> Company:
    """Those who walk about the walker; raises `NoRoomError`."""
    humanoids = [opened(_avatar(name)) for name in drawn.others]
    return company_of(controller, humanoids, setting.scene, drawn.seed)


def _shown(humanoid: Humanoid, frames: Sequence[Frame]) -> ShownWalker:
    q, roots = np.stack([frame.q for frame in frames]), np.stack([frame.root for frame in frames])
    return ShownWalker(humanoid, ShownMotion.at_rate(q, roots, 1.0 / DT))


def _fault(walkers: Sequence[ShownWalker], scene: Scene) -> str | None:
    """What the judge finds wrong with a walk: something touches the place, itself, or the walker one of the others."""
    for one in walkers:
        verdict = judge(one.motion, one.humanoid, scene)
        if not verdict.clean or verdict.itself.touching:
            bodies = [verdict.capsules, verdict.itself, *([] if verdict.mesh is None else [verdict.mesh])]
            return _touches(max(body.touching for body in bodies), max(body.deepest for body in bodies))
    for one, other in combinations(walkers, 2):
        apart = judge_apart(one, other)
        if apart.touching:
            return _touches(apart.touching, apart.deepest)
    return None


def _touches(poses: int, deepest: float) -> str:
    return f"touches in {poses} poses, {1e3 * deepest:.1f} mm deep"


def _avatar(name: str) -> AvatarFile:
    return AvatarFile(None if name == STOCK else Path(name))


@lru_cache(maxsize=8)
def _maker(avatar: AvatarFile) -> CourseMaker:
    return CourseMaker.of(opened(avatar))
