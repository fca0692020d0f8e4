"""The message schema of a live session: one source, from which the TypeScript types are generated.

Messages travel over one WebSocket as JSON text, `{"type": "input", ...}` with field names in camelCase; poses travel
from the server as binary frames (`pose_frame`). Units: metres, radians, seconds unless a name says otherwise;
quaternions xyzw. A field that is None says "unchanged" in a client's message and "nothing to tell" in a server's.
"""

from dataclasses import dataclass, field
from typing import Annotated, Literal

PROTOCOL = 1  # raised with every change that an older client would misread
MAX_MESSAGE = 64 * 1024  # bytes in a client's text message
MAX_UPLOAD = 64 * 1024 * 1024  # bytes in an avatar file dropped on the page
QUEUE_SIZES = (3, 4, 5, 6, 7)
WALK_SPEEDS = (0.2, 2.0)  # m/s, slowest and fastest
INPUT_TIMEOUT = 1.0  # seconds without any message after which the keys count as released


@dataclass(frozen=True)
class Range:
    """Bounds of a number, both included."""

    low: float
    high: float


@dataclass(frozen=True)
class Length:
    """The most characters of a text or items of a list."""

    most: int


Heading = Annotated[float, Range(-1e4, 1e4)]
Share = Annotated[float, Range(-1.0, 1.0)]
Sequence = Annotated[int, Range(0, 2**32 - 1)]
Name = Annotated[str, Length(128)]
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
GroupName = Literal["root", "waist", "leftArm", "rightArm"]
PhaseName = Literal["plan", "play", "reset"]
Reason = Literal["noPosture", "outOfReach", "motion"]


# --- from the client ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Input:
    """What the keys, sticks and pads say now; sent on every change and at least four times a second while held."""

    seq: Sequence  # grows with every input; frames tell the last one that they obey
    forward: Share = 0.0
    strafe: Share = 0.0  # positive to the avatar's left
    turn: Share = 0.0  # positive turns left
    direction: Heading | None = None  # wanted heading in the world (camera-relative steering)
    run: bool = False


@dataclass(frozen=True)
class Configure:
    """Choices of the menus; what is None stays."""

    scene: Name | None = None
    avatar: Name | None = None
    planner: Name | None = None
    queue_size: Annotated[int, Range(QUEUE_SIZES[0], QUEUE_SIZES[-1])] | None = None
    assist: bool | None = None  # False plays the canned walk, right through everything
    walk_speed: Annotated[float, Range(*WALK_SPEEDS)] | None = None  # m/s at forward = 1
    clip: Name | None = None  # play this clip; "" walks again
    clip_as_planned: bool | None = None  # play only what the planning degrees of freedom keep of it


@dataclass(frozen=True)
class ClockMessage:
    """Pause, slow motion and single steps of simulated time."""

    paused: bool | None = None
    speed: Annotated[float, Range(0.1, 2.0)] | None = None
    steps: Annotated[int, Range(1, 60)] | None = None  # steps of 1/60 s to take at once; pauses first


@dataclass(frozen=True)
class Reset:
    """Back to the start of the scene."""


@dataclass(frozen=True)
class Overlays:
    """Which extra data to send."""

    capsules: bool = False  # the collision body, in every pose frame
    plan: bool = False  # `plan` messages


@dataclass(frozen=True)
class Ping:
    """Answered by `pong` at once; also keeps held keys alive."""

    t: float


# --- from the server ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class SceneChoice:
    """A scene in the menu."""

    name: str
    title: str


@dataclass(frozen=True)
class AvatarChoice:
    """An avatar in the menu."""

    id: str
    title: str


@dataclass(frozen=True)
class ClipChoice:
    """A motion clip in the menu."""

    id: str
    title: str


@dataclass(frozen=True)
class Uploaded:
    """The answer to a file that was posted to /api/avatars."""

    avatar: AvatarChoice | None  # None for a file of motion alone
    clips: list[ClipChoice]


@dataclass(frozen=True)
class Catalog:
    """What the menus offer; also at GET /api/catalog."""

    scenes: list[SceneChoice]
    avatars: list[AvatarChoice]
    planners: list[str]
    queue_sizes: list[int]
    walk_speed: tuple[float, float]  # slowest and fastest
    clips: list[ClipChoice]


@dataclass(frozen=True)
class Hello:
    """The first message of a connection."""

    version: str  # of the elbowroom package
    protocol: int
    catalog: Catalog


@dataclass(frozen=True)
class Settings:
    """The choices in force; sent after hello and whenever one changes."""

    scene: str
    avatar: str
    planner: str
    queue_size: int
    assist: bool
    walk_speed: float
    paused: bool
    speed: float
    capsules: bool
    plan: bool
    clip: str  # "" while the avatar walks
    clip_as_planned: bool


@dataclass(frozen=True)
class ClipMessage:
    """The clip that is played, and what was recognised in it."""

    id: str
    title: str
    format: str  # "BVH", "glTF 2.0", "VRM animation 1.0"
    up: str  # the file's axis that points up
    unit: str  # "cm", ...; "body": taken from the height of the body
    metres: float  # a unit of the file
    fps: float
    frames: int
    seconds: float
    speed: float  # m/s of the walk in it; 0 where nobody walks
    trunk_degrees: float  # what planning loses of the trunk, on average
    arm_degrees: float  # and of the directions of the arms' bones


@dataclass(frozen=True)
class Ground:
    """The floor, at height 0."""

    center: tuple[float, float]  # x, z
    size: tuple[float, float]  # extents along x and z


@dataclass(frozen=True)
class Box:
    """An obstacle."""

    name: str
    center: Vector
    size: Vector  # whole edge lengths
    rotation: Quaternion


@dataclass(frozen=True)
class Gate:
    """The finish: passed when the avatar crosses its line."""

    x: float
    z: float
    heading: float  # direction in which it is passed
    width: float  # length of the line


@dataclass(frozen=True)
class Place:
    """A standing place on the ground."""

    x: float
    z: float
    heading: float


@dataclass(frozen=True)
class MovingBox:
    """An upright box on a track: its place and its turn about Y change evenly from key pose to key pose."""

    name: str
    size: Vector  # whole edge lengths
    times: list[float]  # of the key poses, in simulated seconds since the last reset
    centers: list[Vector]
    yaws: list[float]  # radians
    repeat: Literal["once", "loop", "pingpong"]  # then: it stays, begins anew, goes back the same way


@dataclass(frozen=True)
class SceneMessage:
    """The world to draw; the following frames happen in it."""

    name: str
    title: str
    description: str
    ground: Ground
    boxes: list[Box]
    moving: list[MovingBox]
    start: Place
    finish: Gate | None


@dataclass(frozen=True)
class Bone:
    """A bone that the pose frames move."""

    name: str  # VRM 1.0 bone name
    node: int  # node index in the avatar's file


@dataclass(frozen=True)
class AvatarCapsule:
    """A capsule of the collision body; its end points come in the pose frames."""

    name: str
    radius: float
    group: GroupName


@dataclass(frozen=True)
class Placement:
    """How the file's scene stands in the root's frame (metres, facing +Z): scale, then turn about +Y, then move."""

    position: Vector
    heading: float
    scale: float


@dataclass(frozen=True)
class AvatarMessage:
    """Whom to draw; the following frames with this revision pose it."""

    id: str
    revision: int  # as in the pose frames that belong to it
    title: str
    authors: list[str]
    licence: str
    format: str
    url: str | None  # of the GLB, relative to the page; None for an avatar without a file: draw the capsules
    bones: list[Bone]  # in the order of the rotations in a pose frame
    placement: Placement
    capsules: list[AvatarCapsule]  # in the order of the capsules in a pose frame
    height: float  # of the head joint above the ground


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
    """The nearest obstacle: which capsule, which box, and the two points."""

    capsule: str
    box: str
    on_body: Vector
    on_box: Vector
    distance: float  # negative: touching


@dataclass(frozen=True)
class Blocked:
    """Why the upper body has no way on, proved by the planner."""

    reason: Reason
    boxes: list[str]  # names of the obstacles that together close it, each of them needed
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
    answer_ms: tuple[float, float] | None  # median and longest wait until the motion is what a new command wants
    late_plans: int  # plans since the last reset that came too late to be shown
    look_ahead: float  # seconds of motion in the last plan
    queue_fill: int
    queue_size: int
    crossed: int  # times that the finish was passed
    stuck_times: int
    clearance: float | None  # None: nothing near
    nearest: Nearest | None
    blocked: Blocked | None  # None: there is a way on


@dataclass(frozen=True)
class Plan:
    """What is planned ahead, ten times a second while the overlay is on. Segments: ax, ay, az, bx, by, bz a capsule."""

    times: list[float]  # sim time of each key frame
    root: list[Vector]  # x, z, heading at each key frame
    ghosts: list[list[float]]  # capsule segments of the body at each key frame
    goal: list[float]  # capsule segments of the posture that the goal functions ask for now
    chosen: list[float]  # capsule segments of the posture shown now


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
class Notice:
    """A sentence for the user."""

    level: Literal["info", "warning", "error"]
    message: str


@dataclass(frozen=True)
class Pong:
    """The answer to a ping."""

    t: float  # as in the ping
    time: float = field(default=0.0)  # session clock


ClientMessage = Input | Configure | ClockMessage | Reset | Overlays | Ping
ServerMessage = (
    Hello | Settings | SceneMessage | AvatarMessage | ClipMessage | Status | Plan | Loading | Crossed | Notice | Pong
)
