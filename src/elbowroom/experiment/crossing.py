"""The paper's crossing test: get through the obstacles within 30 s (section 6.1, Table 1)."""

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.experiment.beside import BesideDesk
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.listener import Listener
from elbowroom.experiment.pacing import is_realtime, late_frames
from elbowroom.experiment.rehearsal import rehearse
from elbowroom.experiment.replans import Replans
from elbowroom.experiment.scripted_user import ScriptedUser, User
from elbowroom.planning.command import Command
from elbowroom.planning.names import EXACT
from elbowroom.planning.root.pace import at_speed
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

DT = 1 / 60  # seconds of a frame
_SIDEWAYS = 0.02  # metres, the start is drawn within this to either side


@dataclass(frozen=True)
class CrossingResult:
    """One trial: the columns of the paper's Table 1 for a single run, and the cost of its frames."""

    scene: str
    planner: str
    queue_size: int
    seed: int
    passed: bool  # through within the limit
    straight: bool  # through, and never stuck
    stuck_times: int
    passed_time_s: float | None  # None where it did not pass
    plans_total: int  # local planning calls
    plan_success_rate: float
    plan_failed_rate: float
    collision_checks: int  # all: for root paths, for local planning, and of each frame before it was shown
    local_checks: int  # those of local planning
    realtime: bool  # no second showed only one frame, by the time that frames really took
    late_frames: int  # shown later than 1/60 s after they were due, by the same measure
    frames: int
    frame_ms_p99: float
    frame_ms_worst: float
    plan_ms_worst: float
    least_clearance: float  # metres, over all frames
    replan_change_p99: float  # radians by which a plan's joints differ from those of the plan before


@dataclass(frozen=True, eq=False)
class CrossingTimes:
    """What the frames of a trial cost to compute."""

    frame_ms: Floats  # (frames,)
    plan_ms: Floats  # (plans,) of these, the frames that planned


def start_for(scene: Scene, seed: int) -> RootState:
    """The scene's start, moved a little to the side and in the stride by the seed; seed 0 starts as the scene says."""
    if seed == 0:
        return scene.start
    rng = np.random.default_rng([seed, 1])
    aside, phase = rng.uniform(-_SIDEWAYS, _SIDEWAYS), rng.uniform(0.0, 1.0)
    heading = scene.start.heading
    return scene.start._replace(
        x=scene.start.x + aside * float(np.cos(heading)), z=scene.start.z - aside * float(np.sin(heading)), phase=phase
    )


def controller_for(
    humanoid: Humanoid,
    scene: Scene,
    settings: CrossingSettings,
    motions: MotionSet = STOCK,
    desk: BesideDesk | None = None,
) -> Controller:
    """The controller at the start of a trial, with the stock motions or others; it plans at `desk`, or at once."""
    return Controller(
        humanoid,
        scene,
        planner=settings.planner,
        seed=settings.seed,
        start=start_for(scene, settings.seed),
        motions=motions,
        ahead=Lookahead(settings.queue_size, desk=desk),
    )


def warm_up(controller: Controller) -> None:
    """Run and forget the first steps, so that loading compiled kernels is not counted as the cost of a frame."""
    for command in (Command(forward=1.0), Command()):
        for _ in range(3):
            controller.step(command, DT)
    controller.reset()
    if controller.settings.planner == EXACT:
        rehearse(controller.humanoid)


def _user_of(seed: int) -> User:
    """The scripted user of a trial, who walks straight on."""
    user = ScriptedUser(np.random.default_rng([seed, 2]))
    return lambda _root, stuck, dt: user.command(stuck, dt)


def run_crossing(
    controller: Controller,
    settings: CrossingSettings,
    listener: Listener | None = None,
    user: User | None = None,
) -> CrossingResult:
    """Let the scripted user, or another, steer until the finish or the time limit; `listener` hears of every step."""
    return run_timed_crossing(controller, settings, listener, user=user)[0]


def run_timed_crossing(
    controller: Controller,
    settings: CrossingSettings,
    listener: Listener | None = None,
    desk: BesideDesk | None = None,
    user: User | None = None,
) -> tuple[CrossingResult, CrossingTimes]:
    """`run_crossing`, and the cost of every single frame; plans that were made at `desk` cost none."""
    user = user or _user_of(settings.seed)
    ledger, speed = _Ledger(), controller.motions.style.speed
    frame = controller.step(Command(), 0.0)
    while frame.time < settings.limit - 0.5 * DT and not controller.scene.finished(controller.root):
        command = at_speed(user(controller.root, frame.stuck, DT), speed)
        began, planned = time.perf_counter(), 0.0 if desk is None else desk.spent
        frame = controller.step(command, DT)
        cost = time.perf_counter() - began
        if desk is None:
            ledger.enter(frame, cost, cost)
        else:
            ledger.enter(frame, cost - (desk.spent - planned), desk.last)
        if listener is not None:
            listener(frame, DT)
    passed = controller.scene.finished(controller.root)
    return ledger.result(controller.scene.name, settings, passed, frame.time), ledger.times()


class _Ledger:
    """What the frames of a trial add up to."""

    def __init__(self) -> None:
        self._costs: list[float] = []  # seconds of computing, one for each frame
        self._plan_costs: list[float] = []
        self._found: list[bool] = []
        self._checks = self._local_checks = 0
        self._stuck_times = 0
        self._stuck = False
        self._clearance = np.inf
        self._replans = Replans()

    def enter(self, frame: Frame, cost: float, plan_cost: float) -> None:
        """Add a frame that took `cost` seconds to compute, and its plan, if it is new, `plan_cost`."""
        self._costs.append(cost)
        self._checks += 1
        self._clearance = min(self._clearance, frame.clearance)
        if frame.stuck and not self._stuck:
            self._stuck_times += 1
        self._stuck = frame.stuck
        if frame.plan is not None and frame.plan.number > len(self._found):
            self._found.append(frame.plan.found)
            self._replans.enter(frame.plan)
            self._plan_costs.append(plan_cost)
            self._checks += frame.plan.checks
            self._local_checks += frame.plan.local.checks

    def times(self) -> CrossingTimes:
        """The cost of every frame."""
        return CrossingTimes(1e3 * np.array(self._costs), 1e3 * np.array(self._plan_costs))

    def result(self, scene: str, settings: CrossingSettings, passed: bool, seconds: float) -> CrossingResult:
        """The row of the trial."""
        success = float(np.mean(self._found)) if self._found else 0.0
        costs, changes = np.array(self._costs or [0.0]), np.append(self._replans.changes, 0.0)
        return CrossingResult(
            scene=scene,
            planner=settings.planner,
            queue_size=settings.queue_size,
            seed=settings.seed,
            passed=passed,
            straight=passed and self._stuck_times == 0,
            stuck_times=self._stuck_times,
            passed_time_s=round(seconds, 3) if passed else None,
            plans_total=len(self._found),
            plan_success_rate=round(success, 4),
            plan_failed_rate=round(1.0 - success, 4) if self._found else 0.0,
            collision_checks=self._checks,
            local_checks=self._local_checks,
            realtime=is_realtime(costs, DT),
            late_frames=late_frames(costs, DT),
            frames=len(self._costs),
            frame_ms_p99=round(1e3 * float(np.percentile(costs, 99)), 3),
            frame_ms_worst=round(1e3 * float(costs.max()), 3),
            plan_ms_worst=round(1e3 * max(self._plan_costs, default=0.0), 3),
            least_clearance=round(float(self._clearance), 6),
            replan_change_p99=round(float(np.percentile(changes, 99)), 4),
        )
