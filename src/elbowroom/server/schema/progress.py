"""How the session goes: the state in numbers, what is planned, what has happened."""

from dataclasses import dataclass, field
from typing import Literal

from elbowroom.server.schema.bounds import GroupName, PhaseName, Reason, Vector


@dataclass(frozen=True)
class GroupReport:
    """How the last plan of one group ended and what it cost."""

    group: GroupName
    status: str  # "found", "exhausted", "out of budget"
    checks: int
    nodes: int
    enhanced: int
    ms: float


@dataclass(frozen=True)
class Nearest:
    """The nearest obstacle: which capsule, which obstacle, and the two points."""

    capsule: str
    obstacle: str
    on_body: Vector
    on_obstacle: Vector
    distance: float  # negative: touching


@dataclass(frozen=True)
class Blocked:
    """Why the upper body has no way on, proved by the planner."""

    reason: Reason
    obstacles: list[str]  # names of the obstacles that together close it, each of them needed
    ahead: float  # metres along the way
    place: tuple[float, float]  # x, z


@dataclass(frozen=True)
class Status:
    """The state in numbers, about ten times a second."""

    time: float  # session clock, as in the pose frames
    sim_time: float
    phase: PhaseName
    stuck: bool
    root_kind: str  # "straight", "evasion", "detour", "shortened", "stopped"; "" before the first plan
    plan_status: str  # "found", "exhausted", "out of budget"; "" before the first plan
    groups: list[GroupReport]
    plans: int  # local plans since the last reset
    plans_failed: int
    checks: int  # collision checks of the last plan
    planning_ms: float  # of the last plan
    frame_ms_p50: float  # computing one frame, over the last seconds
    frame_ms_p95: float
    late_ms_p99: float  # how long after it was due a frame was ready
    # Median, 99th percentile and longest wait until the motion is what a new command wants.
    answer_ms: tuple[float, float, float] | None
    late_plans: int  # plans since the last reset that came too late to be shown
    look_ahead: float  # seconds of motion in the last plan
    queue_fill: int
    queue_size: int
    crossed: int  # times that the finish was passed
    stuck_times: int
    clearance: float | None  # None: nothing near
    nearest: Nearest | None  # None: nothing near, or the capsules are not asked for
    blocked: Blocked | None  # None: there is a way on


@dataclass(frozen=True)
class Plan:
    """What is planned ahead, ten times a second while the overlay is on. Segments: ax, ay, az, bx, by, bz a capsule."""

    times: list[float]  # sim time of each key frame
    root: list[Vector]  # x, z, heading at each key frame
    ghosts: list[list[float]]  # capsule segments of the body at each key frame
    goal: list[float]  # capsule segments of the posture that the goal functions ask for now
    chosen: list[float]  # capsule segments of the posture shown now
    heights: list[float]  # of the ground at each key frame, metres


@dataclass(frozen=True)
class Loading:
    """Something that takes a while has begun or ended; what was there before goes on meanwhile."""

    what: Literal["scene", "avatar", "planner", "clip"]
    name: str
    active: bool


@dataclass(frozen=True)
class Crossed:
    """The finish was passed."""

    seconds: float  # simulated time since the start
    stuck_times: int  # since the start
    count: int


@dataclass(frozen=True)
class Going:
    """How it stands with a walk to a place; told when that changes."""

    state: Literal["walking", "arrived", "given up", "taken over", "refused"]
    place: tuple[float, float, float]  # x, height, z
    reason: str  # why it was refused or given up; else empty
    nearest: tuple[float, float, float] | None  # where one can stand instead, of a place that was refused


@dataclass(frozen=True)
class Pushed:
    """Where an obstacle is that was pushed; told while it moves. With a new epoch all are back where they were."""

    obstacle: int  # its number among the scene's obstacles
    epoch: int  # as in the pose frames
    time: float  # simulated, as in the pose frames
    center: Vector  # of its origin
    yaw: float  # radians


@dataclass(frozen=True)
class Notice:
    """A sentence for the user."""

    level: Literal["info", "warning", "error"]
    message: str


@dataclass(frozen=True)
class Pong:
    """The answer to a ping."""

    t: float  # as in the ping
    time: float = field(default=0.0)  # session clock
