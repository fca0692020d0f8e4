"""What is to be drawn: the scene, the avatar, the clip that it plays."""

from dataclasses import dataclass
from typing import Literal

from elbowroom.server.schema.bounds import GroupName, Quaternion, Vector


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
class Form:
    """The shape of an obstacle, about its own origin and along its own axes; capsules and cylinders are about Y."""

    shape: Literal["box", "sphere", "capsule", "cylinder", "hull", "mesh"]
    size: Vector  # whole edge lengths of the box about the origin that holds it
    corners: list[Vector]  # of a hull or a mesh; else none
    triangles: list[tuple[int, int, int]]  # of a hull or a mesh, counter-clockwise seen from outside; else none


@dataclass(frozen=True)
class Obstacle:
    """What stands in the way."""

    name: str
    form: Form
    center: Vector  # of its origin
    rotation: Quaternion
    color: str  # "#rrggbb"; "" where the client chooses


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
class Stop:
    """A place of a guided tour."""

    position: tuple[float, float]  # x, z
    height: float | None  # of the floor there; None: the one that a way leads to
    view: str  # the camera that shows it; "": as it is
    say: str  # for people to read
    seconds: float  # how long one stays


@dataclass(frozen=True)
class MovingObstacle:
    """A shape on a track, its Y upright: its place and its turn about Y change evenly from key pose to key pose."""

    name: str
    form: Form
    times: list[float]  # of the key poses, in simulated seconds since the last reset
    centers: list[Vector]
    yaws: list[float]  # radians
    repeat: Literal["once", "loop", "pingpong"]  # then: it stays, begins anew, goes back the same way
    color: str  # as of an obstacle that stands


@dataclass(frozen=True)
class Model:
    """The model of a place, to be shown as it is: in the scene's metres and axes."""

    url: str  # of a GLB, relative to the page
    title: str


@dataclass(frozen=True)
class SceneMessage:
    """The world to draw; the following frames happen in it."""

    name: str
    title: str
    description: str
    ground: Ground
    model: Model | None  # shows what stands in it, which is not among the obstacles
    obstacles: list[Obstacle]
    pushable: list[int]  # the numbers of those of them that can be pushed
    moving: list[MovingObstacle]
    start: Place
    finish: Gate | None
    tour: list[Stop]


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
    facts: list[str]  # what the file permits, and what was guessed or left out in reading it
    format: str
    url: str | None  # of the GLB, relative to the page; None for an avatar without a file
    draw_capsules: bool  # there is no mesh of a body: the capsules are what is to be seen
    bones: list[Bone]  # in the order of the rotations in a pose frame
    placement: Placement
    capsules: list[AvatarCapsule]  # in the order of the capsules in a pose frame
    height: float  # of the head joint above the ground
