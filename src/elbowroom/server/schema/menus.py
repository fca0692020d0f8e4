"""What there is to choose from, and what is chosen."""

from dataclasses import dataclass


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
class StyleChoice:
    """A style of walking in the menu."""

    name: str
    speed: float  # m/s that it likes to walk


@dataclass(frozen=True)
class Uploaded:
    """The answer to a file that was posted to /api/avatars."""

    avatar: AvatarChoice | None  # None for a file without one
    clips: list[ClipChoice]
    scene: SceneChoice | None = None  # of the model of a place


@dataclass(frozen=True)
class Catalog:
    """What the menus offer; also at GET /api/catalog."""

    scenes: list[SceneChoice]
    avatars: list[AvatarChoice]
    planners: list[str]
    queue_sizes: list[int]
    walk_speed: tuple[float, float]  # slowest and fastest
    styles: list[StyleChoice]
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
    style: str
    paused: bool
    speed: float
    capsules: bool
    plan: bool
    clip: str  # "" while the avatar walks
    clip_as_planned: bool
