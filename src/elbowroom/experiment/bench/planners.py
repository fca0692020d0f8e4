"""Our planners and a general one on the same crossings: who gets through, how long planning takes, how it looks."""

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.control.frame import Frame
from elbowroom.errors import InputError
from elbowroom.experiment.bench.general import GeneralPlan, check_installed, plan_generally
from elbowroom.experiment.bench.general_problem import crossing_problem
from elbowroom.experiment.bench.settings import PlannersSettings
from elbowroom.experiment.crossing import DT, controller_for, run_timed_crossing, warm_up
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.gauntlet.course import make_course
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.experiment.opened import Openable, opened
from elbowroom.experiment.parallel import Workers
from elbowroom.experiment.table1.tasks import AvatarFile, NamedScene
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.planner import PLANNERS
from elbowroom.planning.root.path import RootPath
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

GENERAL = "rrt-connect"
_COURSES = 1000  # of a level among which straight ones are looked for


@dataclass(frozen=True)
class PlannerRun:
    """One planner on one crossing."""

    where: str
    planner: str
    seed: int
    through: bool  # straight, for ours: never stuck; found, for the general one
    planning_seconds: float  # all planning of the crossing together
    longest_plan_ms: float  # the longest wait for one plan
    checks: (
        int  # as each counts them: capsule-box groups of `exact`, candidates of `figure6`, motions of the general one
    )
    touching: int  # of the judge's poses, 240 a second
    away: float  # radians from the natural walk, root mean square over the upper body's joints and the motion
    swing: float  # rad/s, mean speed of the upper body


@dataclass(frozen=True)
class PlannersReport:
    """All runs."""

    settings: PlannersSettings
    runs: tuple[PlannerRun, ...]

    def cells(self) -> Iterator[tuple[str, str, list[PlannerRun]]]:
        """The runs by place and planner, in the order in which they were made."""
        keys = dict.fromkeys((run.where, run.planner) for run in self.runs)
        for where, planner in keys:
            yield where, planner, [run for run in self.runs if (run.where, run.planner) == (where, planner)]


@dataclass(frozen=True)
class StraightCourse:
    """A random course whose line is straight."""

    level: int
    seed: int

    def open(self) -> Scene:
        """Make it."""
        return make_course(self.level, self.seed).scene


@dataclass(frozen=True)
class PlannerTask:
    """One planner on one crossing, as a task for a process of its own."""

    where: str
    place: NamedScene | StraightCourse
    planner: str  # ours by name, or `GENERAL`
    seed: int
    limit: float  # seconds

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """Avatar and scene."""
        return AvatarFile(None), self.place

    def run(self) -> PlannerRun:
        """Cross, and be judged."""
        humanoid, scene = opened(AvatarFile(None)), opened(self.place)
        if self.planner == GENERAL:
            return _general(humanoid, scene, self.where, self.seed, self.limit)
        return _ours(humanoid, scene, self.where, self.planner, self.seed, self.limit)


def run(
    settings: PlannersSettings, tick: Callable[[int], None] = lambda _: None, workers: Workers | None = None
) -> PlannersReport:
    """Every planner on every crossing: here one after another, or by `workers`.

    Raises `InputError` where OMPL or coal is missing.
    """
    check_installed()
    tasks = [
        PlannerTask(where, place, planner, seed, settings.limit)
        for where, place, seed in _crossings(settings)
        for planner in (*PLANNERS, GENERAL)
    ]
    done: dict[int, PlannerRun] = {}
    results = ((k, task.run()) for k, task in enumerate(tasks)) if workers is None else workers.run(tasks)
    for place, result in results:
        done[place] = result
        tick(len(done))
    return PlannersReport(settings, tuple(done[k] for k in range(len(tasks))))


def amount(settings: PlannersSettings) -> int:
    """How many runs there will be."""
    return (len(settings.scenes) + len(settings.levels)) * settings.trials * (len(PLANNERS) + 1)


def as_dict(report: PlannersReport) -> dict[str, object]:
    """Settings and runs."""
    return {"settings": asdict(report.settings), "runs": [asdict(run) for run in report.runs]}


def _crossings(settings: PlannersSettings) -> Iterator[tuple[str, NamedScene | StraightCourse, int]]:
    for name in settings.scenes:
        yield from ((f"scene {name}", NamedScene(name), seed) for seed in range(settings.trials))
    for level in settings.levels:
        seeds = _straight_courses(level, settings.trials)
        yield from ((f"level {level}", StraightCourse(level, seed), seed) for seed in seeds)


def _straight_courses(level: int, count: int) -> Iterator[int]:
    for seed in range(_COURSES):
        if make_course(level, seed).line.straight:
            yield seed
            count -= 1
        if count == 0:
            return
    raise InputError(f"level {level}: fewer straight courses among {_COURSES} than asked for")


def _ours(humanoid: Humanoid, scene: Scene, where: str, planner: str, seed: int, limit: float) -> PlannerRun:
    # A gauntlet's scene is its seed's; only the user's start and patience vary with a scene's seeds.
    settings = CrossingSettings(planner=planner, seed=seed if where.startswith("scene") else 0, limit=limit)
    controller = controller_for(humanoid, scene, settings)
    warm_up(controller)
    shown: list[Frame] = []

    def listen(frame: Frame, dt: float) -> None:
        del dt
        shown.append(frame)

    result, times = run_timed_crossing(controller, settings, listen)
    motion = ShownMotion.at_rate(
        np.stack([frame.q for frame in shown]), np.stack([frame.root for frame in shown]), 1.0 / DT
    )
    waits = times.plan_ms if len(times.plan_ms) else np.zeros(1)
    costs = float(waits.sum()) / 1e3, float(waits.max()), result.local_checks
    return _judged(humanoid, scene, motion, (where, planner, seed), result.straight, costs)


def _general(humanoid: Humanoid, scene: Scene, where: str, seed: int, limit: float) -> PlannerRun:
    plan: GeneralPlan = plan_generally(humanoid, scene, limit, seed)
    if not plan.found:
        return PlannerRun(
            where, GENERAL, seed, False, plan.seconds, 1e3 * plan.seconds, plan.motions, 0, np.nan, np.nan
        )
    motion = plan.shown(crossing_problem(humanoid, scene))
    costs = plan.seconds, 1e3 * plan.seconds, plan.motions
    return _judged(humanoid, scene, motion, (where, GENERAL, seed), True, costs)


def _judged(
    humanoid: Humanoid,
    scene: Scene,
    motion: ShownMotion,
    about: tuple[str, str, int],
    through: bool,
    costs: tuple[float, float, int],
) -> PlannerRun:
    verdict = judge(motion, humanoid, scene, JudgeSettings(mesh=False))
    upper = motion.q[:, DofGroup.ROOT.size :]
    goals = natural_walk()(RootPath(0.0, DT, motion.roots))
    away = float(np.sqrt(np.mean((upper - goals) ** 2)))
    swing = float(np.linalg.norm(np.diff(upper, axis=0), axis=1).mean() / DT)
    return PlannerRun(*about, through, *costs, verdict.capsules.touching, away, swing)
