"""One avatar on its way through one scene: the controller, and what a session counts about it. No clock, no socket."""

import contextlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from elbowroom.body.root import RootState
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.clips.style import STYLES
from elbowroom.clips.style_names import PLAIN_NAME, check_style_name
from elbowroom.control.controller import FORWARD, Controller
from elbowroom.control.frame import Frame
from elbowroom.control.journey import Journey
from elbowroom.control.plans.desk import PlanningDesk
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.control.settings import check_queue_size
from elbowroom.control.things.loose import Thing
from elbowroom.errors import InputError
from elbowroom.planning.command import Command, changed
from elbowroom.planning.names import DEFAULT_PLANNER, check_planner
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.way import Way
from elbowroom.planning.root.pace import at_speed
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.planning.stillness import is_still
from elbowroom.server.schema.bounds import WALK_SPEEDS
from elbowroom.server.sessions.heeded import Heeded
from elbowroom.server.sessions.walk_log import WalkLog
from elbowroom.server.stores.avatar_store import StoredAvatar
from elbowroom.server.wire.pose import NodePose
from elbowroom.world.scene import Scene

_MOTION = RootMotionSettings()
_BACK_AT_START = 1.0  # metres: so near to the start the next crossing counts again


@dataclass(frozen=True)
class WalkSettings:
    """What the menus choose about planning."""

    planner: str = DEFAULT_PLANNER
    queue_size: int = 5
    assist: bool = True
    walk_speed: float = _MOTION.walk_speed  # m/s at forward = 1; running doubles it
    style: str = PLAIN_NAME  # a stock one

    def __post_init__(self) -> None:
        check_planner(self.planner)
        check_queue_size(self.queue_size)
        check_style_name(self.style)
        if not WALK_SPEEDS[0] <= self.walk_speed <= WALK_SPEEDS[1]:
            limits = f"{WALK_SPEEDS[0]:g} to {WALK_SPEEDS[1]:g} m/s"
            raise InputError(f"walking speed {self.walk_speed:g}: allowed are {limits}")

    def in_style(self, name: str) -> "WalkSettings":
        """The same in a stock style, at the speed that it likes; raises `InputError`."""
        check_style_name(name)
        return replace(self, style=name, walk_speed=STYLES[name].speed)


class Walk:
    """A living walk; `step` advances it."""

    rounds = 0  # a walk never jumps by itself

    def __init__(
        self,
        avatar: StoredAvatar,
        scene: Scene,
        settings: WalkSettings,
        places: Sequence[RootState] = (),
        desk: PlanningDesk | None = None,
        motions: MotionSet = STOCK,
    ) -> None:
        """Stand at the first of `places` where no obstacle is in the way, else at the start; raises `InputError`.

        Plans are made at `desk`, by default at once, with the motions that the avatar has learnt. The planners are made
        here, so that the first command need not wait for them.
        """
        self.avatar = avatar
        self.scene = scene
        self.settings = settings
        self._desk = desk
        self._motions = motions
        self._controller = self._made(places)
        self._controller.prepare()
        self._log = WalkLog(self._controller)
        self.crossed = 0
        self.stuck_times = 0
        self._begin()

    def _made(self, places: Sequence[RootState]) -> Controller:
        for place in places:
            with contextlib.suppress(InputError):
                return self._controller_at(place)
        return self._controller_at(None)

    def _controller_at(self, place: RootState | None) -> Controller:
        return Controller(
            self.avatar.humanoid,
            self.scene,
            planner=self.settings.planner,
            assist=self.settings.assist,
            start=place,
            motions=self._motions,
            ahead=Lookahead(self.settings.queue_size, desk=self._desk),
        )

    def _begin(self) -> None:
        self._armed = True
        self._stuck_since_start = 0
        self._started = 0.0
        self._plan_number = 0
        self.plans_failed = 0
        self._heeded = Heeded()
        self.frame: Frame = self._controller.step(Command(), 0.0)

    def reset(self) -> None:
        """Back to the start of the scene; the counters of crossings stay."""
        self._controller.reset(self.scene.start)
        self._controller.assist = self.settings.assist
        self._log.begin()
        self._begin()

    def adjust(self, settings: WalkSettings) -> None:
        """Take over what can change while walking: assistance and walking speed."""
        self.settings = replace(self.settings, assist=settings.assist, walk_speed=settings.walk_speed)
        self._controller.assist = settings.assist

    def step(self, command: Command, dt: float) -> float | None:
        """Go on by `dt` seconds; the seconds that the crossing took if the finish was passed just now."""
        was_stuck, paced = self.frame.stuck, at_speed(command, self.settings.walk_speed)
        self.frame = self._controller.step(paced, dt)
        self._log.add(self.frame, dt)
        if self.frame.stuck and not was_stuck:
            self.stuck_times += 1
            self._stuck_since_start += 1
        self._count_plans()
        self._heeded.follow(self.frame)
        return self._crossing()

    def heeds(self, command: Command) -> bool:
        """Whether the motion that is shown was planned for this command, or for nearly the same."""
        return not changed(self._heeded.command, at_speed(command, self.settings.walk_speed))

    def node_pose(self) -> NodePose:
        """What the avatar's nodes get now."""
        return self.avatar.poser.node_pose(self.frame.q, self.frame.root)

    @property
    def place(self) -> RootState:
        """Where the avatar is."""
        return self._controller.root

    @property
    def navigator(self) -> Navigator:
        """Finds ways in the scene; threads may ask it."""
        return self._controller.navigator

    @property
    def journey(self) -> Journey | None:
        """The walk to a place that goes on, or has ended last."""
        return self._controller.journey

    @property
    def surroundings(self) -> Scene:
        """The scene as it is now: what was pushed is where it is."""
        return self._controller.surroundings

    @property
    def things(self) -> Mapping[int, Thing]:
        """What was pushed since the start, by its number among the scene's obstacles."""
        return self._controller.things

    def push(self, number: int, place: tuple[float, float] | None) -> None:
        """Push an obstacle to a place, or let go where that is None; raises `InputError`."""
        if place is None:
            self._controller.let_go()
        else:
            self._controller.push(number, place)

    def set_out(self, way: Way) -> None:
        """Go along a way, at the walking speed that is set."""
        self._controller.set_out(way, at_speed(FORWARD, self.settings.walk_speed))

    def recording(self) -> bytes:
        """What was shown since the start, as a `.elbow` file; raises `InputError`."""
        return self._log.recording()

    @property
    def plans(self) -> int:
        """Local plans since the last reset."""
        return self._plan_number

    @property
    def late_plans(self) -> int:
        """Plans since the last reset that came too late to be shown."""
        return self._controller.late_plans

    @property
    def finished(self) -> bool:
        """Whether the finish has been passed since the avatar was last at the start."""
        return not self._armed

    @property
    def stuck_since_start(self) -> int:
        """Times stuck since the avatar was last at the start."""
        return self._stuck_since_start

    def _count_plans(self) -> None:
        report = self.frame.plan
        if report is not None and report.number != self._plan_number:
            self._plan_number = report.number
            self.plans_failed += not report.found

    def _crossing(self) -> float | None:
        root, start = self._controller.root, self.scene.start
        if (root.x - start.x) ** 2 + (root.z - start.z) ** 2 < _BACK_AT_START**2:
            self._wait_for_start(root)
            return None
        if not self._armed or not self.scene.finished(root):
            return None
        self._armed = False
        self.crossed += 1
        return self.frame.time - self._started

    def _wait_for_start(self, root: RootState) -> None:
        """Time and counters of a crossing run from the moment when the avatar sets off."""
        if not self._armed or is_still(root.as_array()[3:5]):
            self._armed, self._stuck_since_start, self._started = True, 0, self.frame.time
