"""The control loop of the paper's Figure 4: plan, play, reset."""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control import steering
from elbowroom.control.body_check import BodyCheck, configuration
from elbowroom.control.canned import canned_walk, standing_posture
from elbowroom.control.frame import Frame, Phase, PlanReport
from elbowroom.control.key_frame_queue import KeyFrameQueue, Playback
from elbowroom.control.rehearsal import Rehearsal, frozen_motion, partial_motions, standing_path
from elbowroom.control.settings import ControlSettings
from elbowroom.errors import InputError
from elbowroom.planning.command import Command
from elbowroom.planning.motion import Lead, Motion, MotionPlanner, MotionQuery
from elbowroom.planning.names import DEFAULT_PLANNER
from elbowroom.planning.planner import make_planner
from elbowroom.planning.root_path import RootPath
from elbowroom.planning.root_plan import RootPlanKind
from elbowroom.planning.root_planner import RootPlanner
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

LONGEST_TURN = 1 / 40  # seconds: a longer step is played in several turns, each of them checked
LONGEST_STEP = 60.0  # seconds
_SETTLE = 0.06  # seconds: time constant with which the legs come to a stand where the avatar is held, or lead over
_STILL = 0.02  # m/s and rad/s: slower is standing
_SAME = 1e-6  # radians
_LEAD_POSES = 8  # poses of the interval in play that a planner may look at
_FAR = 0.15  # metres of clearance that no part of the body crosses within a frame


class Controller:
    """Turns commands into poses that touch nothing, one `step` at a time.

    It reads no clock: time is the sum of the `dt` it was given, chance comes from the seed, so the same steps give the
    same frames bit for bit. It owns what lives: the queue, the planners with their growing activity graphs, the pose.
    """

    def __init__(
        self,
        humanoid: Humanoid,
        scene: Scene,
        *,
        planner: str = DEFAULT_PLANNER,
        queue_size: int = 5,
        interval: float = ControlSettings.interval,
        seed: int = 0,
        assist: bool = True,
        start: RootState | None = None,
    ) -> None:
        """Stand the humanoid at the scene's start, or at `start`.

        Raises `InputError` for settings out of range and where the standing avatar touches an obstacle.
        """
        self.humanoid = humanoid
        self.scene = scene
        self.settings = ControlSettings(planner, queue_size, interval, seed, assist)
        self.start = scene.start if start is None else start
        self._check = BodyCheck(humanoid, scene)
        self._root_planner = RootPlanner(humanoid, scene)
        self.reset()

    def reset(self) -> None:
        """Back to the start, as if newly made."""
        self._rng = np.random.default_rng(self.settings.seed)
        self._root_planner.reset()
        self._planner = make_planner(self.settings.planner, self.humanoid, self.scene)
        self._queue = KeyFrameQueue(self.settings.queue_size, self.settings.interval)
        self._assist = self.settings.assist
        self._plan_report: PlanReport | None = None
        self._command = Command()
        self._flow = self._next = Phase.PLAN
        self._held = self._blocked = self._resting = False
        self._stance = np.zeros(3)
        self._stand_at_start()

    def _stand_at_start(self) -> None:
        root = self.start._replace(forward=0.0, lateral=0.0, turn=0.0).as_array()
        upper = standing_posture(root)
        clearance = self._check.clearance(root, upper)
        if clearance < 0.0:
            place = f"x {root[0]:.3g}, z {root[1]:.3g}"
            raise InputError(f"scene {self.scene.name}, start: {self.humanoid.name} touches an obstacle at {place}")
        self._free = Playback(root, upper, np.zeros_like(upper))
        self._show(self._free, clearance)

    @property
    def root(self) -> RootState:
        """The root state that is shown."""
        return RootState(*self._shown.root.tolist())

    @property
    def phase(self) -> Phase:
        """The flow that the last turn took."""
        return self._flow

    @property
    def assist(self) -> bool:
        """Whether upper-body motion is planned; off, the canned walk is shown, touching what it touches."""
        return self._assist

    @assist.setter
    def assist(self, wanted: bool) -> None:
        if wanted == self._assist:
            return
        self._assist = wanted
        self._next, self._resting = Phase.RESET, False
        if wanted and self._clearance < 0.0:
            self._show(self._free, self._check.clearance(self._free.root, self._free.upper))

    def step(self, command: Command, dt: float) -> Frame:
        """Go on by `dt` seconds under `command` and say what to show.

        A step longer than `LONGEST_TURN` is played in equal turns; `dt` 0 changes nothing. Raises `InputError` if a
        component of the command is no number, or `dt` is negative or longer than `LONGEST_STEP`.
        """
        wanted = steering.checked(command)
        if not 0.0 <= dt <= LONGEST_STEP:
            raise InputError(f"dt: {dt} is not between 0 and {LONGEST_STEP:g} seconds")
        turns = math.ceil(dt / LONGEST_TURN)
        flows = [self._turn(wanted, dt / turns) for _ in range(turns)]
        self._flow = next((flow for flow in (Phase.RESET, Phase.PLAN) if flow in flows), Phase.PLAY)
        return self._frame(wanted)

    def _turn(self, command: Command, dt: float) -> Phase:
        flow = self._choose_flow(command)
        if flow is Phase.RESET:
            self._queue.clear()
        if flow is not Phase.PLAY:
            self._plan(command)
        self._play(dt)
        return flow

    def _choose_flow(self, command: Command) -> Phase:
        """Figure 4 (b): which flow this turn takes."""
        if self._resting and command.idle:
            return Phase.PLAY
        if steering.overturned(self._command, command):
            return Phase.RESET
        if self._next is Phase.RESET:
            return Phase.PLAY if self._waits(command) else Phase.RESET
        if self._next is Phase.PLAN or self._queue.consumed > 1.0 or steering.changed(self._command, command):
            return Phase.PLAN
        return Phase.PLAY

    def _waits(self, command: Command) -> bool:
        """Whether a plan for the same wish found no way on less than an interval ago."""
        if not self._blocked or self._plan_report is None or steering.changed(self._command, command):
            return False
        return self._queue.time - self._plan_report.time < self.settings.interval

    def _plan(self, command: Command) -> None:
        """Flow A: a root path, its upper-body motion; on success the queue is refilled, else it keeps what it has."""
        time, root, upper = self._planning_start(command)
        horizon, interval = self.settings.queue_size, self.settings.interval
        query = MotionQuery(time, RootState(*root.tolist()), upper, command, horizon, interval, self._lead(time))
        root_plan, local = self._search(query)
        path = root_plan.path
        number = 1 if self._plan_report is None else self._plan_report.number + 1
        report = PlanReport(number, self._queue.time, root_plan, local)
        self._command, self._plan_report, self._next = command, report, Phase.PLAY
        self._resting = False
        self._queue.start_count()
        motion = local.configurations if report.found else None
        if self._held and self._assist:
            path, motion = self._way_out(path, motion)
        self._blocked = motion is None and self._queue.empty
        if motion is not None:
            self._queue.refill(path, motion, self._shown)
            self._resting = command.idle and self._stands_still(path, motion)

    def _search(self, query: MotionQuery) -> Motion:
        """A root path and its upper body; from the planner as one if it can do that."""
        if self._assist and isinstance(self._planner, MotionPlanner):
            return self._planner.plan_motion(self._root_planner, query)
        root = self._root_planner.plan(query.root, query.command, query.horizon, query.interval, query.time)
        if not self._assist:
            return Motion(root, canned_walk(root.path))
        return Motion(root, self._planner.plan(root.path, query.upper, self._rng))

    def _lead(self, time: float) -> Lead:
        """What is shown now, and the root's way to the key frame at `time`."""
        return Lead(
            time - self._queue.time,
            self._queue.roots_until(time, _LEAD_POSES),
            self._shown.upper,
            self._shown.upper_velocity,
        )

    def _way_out(self, path: RootPath, motion: Floats | None) -> tuple[RootPath, Floats | None]:
        """What can follow a contact: a motion that does not touch again within the first key interval, if there is one.

        Hard against an obstacle nearly every move of a limb touches it. So to keep the pose is a way out too: where the
        plan's way begins too close by, or, without a plan, where the root leads away: whoever walked in can walk out.
        Where even that touches, the root stands and the limbs free themselves, together or one before the other.
        """
        rehearsal = Rehearsal(self._queue, self._shown, self._stance, self._check)
        if motion is not None and rehearsal.is_playable(path, motion):
            return path, motion
        frozen = frozen_motion(path, self._shown.upper)
        useful = motion is not None or rehearsal.leads_away(path, frozen, self._clearance)
        if useful and rehearsal.is_playable(path, frozen):
            return path, frozen
        standing = standing_path(path, self._shown.root)
        freed = self._planner.plan(standing, self._shown.upper, self._rng).configurations
        parts = partial_motions(freed, self._shown.upper) if len(freed) else []
        return standing, next((part for part in parts if rehearsal.is_playable(standing, part)), None)

    def _planning_start(self, command: Command) -> tuple[float, Floats, Floats]:
        """Time, root state and upper body from which to plan.

        That is the next unplayed key frame (receding horizon); where nothing is left to play, or the user wants
        something else at once, it is what is shown now.
        """
        if not (self._queue.empty or steering.changed(self._command, command)):
            coming = self._queue.unplayed()
            return float(coming.times[0]), coming.roots[0], coming.uppers[0]
        root = self._shown.root.copy()
        if self._held:
            self._stance = root[3:6].copy()
        root[3:6] -= self._stance
        return self._queue.time, root, self._shown.upper

    def _stands_still(self, path: RootPath, uppers: Floats) -> bool:
        moving = path.states[:, 3:6].any() or self._stance.any() or np.abs(self._shown.upper_velocity).max() > _SAME
        return not moving and bool(np.abs(uppers - self._shown.upper).max() < _SAME)

    def _play(self, dt: float) -> None:
        """Flow B: interpolate, check, show; what touches is not shown, and leads to flow C, as does an empty queue."""
        ended = self._queue.empty
        self._queue.advance(dt)
        if self._resting:
            return
        if ended:
            self._hold(dt)
            return
        playback = self._queue.sample()
        for stance in self._stances(dt):
            posed = _in_stance(playback, stance)
            clearance = self._check.clearance(posed.root, posed.upper)
            if not self._assist or self._is_free(posed, clearance):
                self._held, self._blocked, self._stance = False, False, stance
                self._show(posed, clearance)
                break
        else:
            self._hold(dt)
        if self._queue.empty:
            self._next = Phase.RESET

    def _is_free(self, posed: Playback, clearance: float) -> bool:
        """Whether the pose can be shown: it touches nothing, nor does the way to it from the pose that is shown."""
        if clearance < 0.0 or min(clearance, self._clearance) > _FAR:
            return clearance >= 0.0
        roots, uppers = (self._shown.root, posed.root), (self._shown.upper, posed.upper)
        return self._check.clearance_between(roots, uppers) >= 0.0

    def _stances(self, dt: float) -> list[Floats]:
        """What may be left of the stance in which the legs were held: less than before; all, where that touches."""
        faded = self._stance * math.exp(-dt / _SETTLE)
        faded[np.abs(faded) < _STILL] = 0.0
        return [faded, self._stance] if self._stance.any() else [faded]

    def _hold(self, dt: float) -> None:
        """Stay in the last good pose; the legs come to a stand where they can."""
        self._held, self._next = True, Phase.RESET
        self._queue.clear()
        root = self._shown.root.copy()
        root[3:6] *= math.exp(-dt / _SETTLE)
        root[3:6][np.abs(root[3:6]) < _STILL] = 0.0
        still = Playback(root, self._shown.upper, np.zeros_like(self._shown.upper))
        clearance = self._check.clearance(still.root, still.upper)
        if self._assist and not self._is_free(still, clearance):
            still, clearance = still._replace(root=self._shown.root), self._clearance
        self._show(still, clearance)

    def _show(self, playback: Playback, clearance: float) -> None:
        self._shown, self._clearance = playback, clearance
        if clearance >= 0.0:
            self._free = playback

    def _frame(self, command: Command) -> Frame:
        return Frame(
            time=self._queue.time,
            q=configuration(self._shown.root, self._shown.upper),
            root=self._shown.root,
            phase=self._flow,
            clearance=self._clearance,
            stuck=not command.idle and (self._blocked or self._walled_in()),
            touching=self._clearance < 0.0,
            fill=self._queue.fill,
            key_frames=self._queue.unplayed(),
            goal=self._goal(),
            plan=self._plan_report,
        )

    def _walled_in(self) -> bool:
        """Whether the root stands because there is no way on for it."""
        stopped = self._plan_report is not None and self._plan_report.root.kind is RootPlanKind.STOPPED
        return stopped and not self._shown.root[3:6].any()

    def _goal(self) -> Floats:
        """The goal functions' posture now, from the last plan (11,)."""
        if self._plan_report is None:
            return self._shown.upper
        path, goals = self._plan_report.root.path, self._plan_report.local.goals
        place = min(max((self._queue.time - path.start_time) / path.interval, 0.0), len(goals) - 1.0)
        k = min(int(place), len(goals) - 2)
        goal: Floats = goals[k] + (place - k) * (goals[k + 1] - goals[k])
        return goal


def _in_stance(playback: Playback, stance: Floats) -> Playback:
    root = playback.root.copy()
    root[3:6] += stance
    return playback._replace(root=root)
