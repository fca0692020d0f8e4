"""What the benchmarks measure, and how much of it. Each raises `InputError` for what is out of range or unknown."""

from collections.abc import Sequence
from dataclasses import dataclass

from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.levels import level_of

# What may be steered through; `steer_scenes` makes them.
STEERED = (
    *("bends", "narrow bends", "slalom", "pillars", "c", "d", "d, keys", "c, strafing", "doorway"),
    *("course 3", "course 5", "traffic", "stair"),
)
_MOST_POSTURES, _MOST_AT_MESHES = 1_000_000, 4_000_000
_MOST_AVATARS = 1000


@dataclass(frozen=True)
class CollisionSettings:
    """The size of the benchmark of collision checks."""

    postures: int = 10_000
    boxes: int = 6
    rival_postures: int = 1_000  # the slower libraries see the first of them
    rounds: int = 7  # each library in turn; the median counts
    seed: int = 7

    def __post_init__(self) -> None:
        _check("postures", self.postures, 1, _MOST_POSTURES)
        _check("boxes", self.boxes, 1, 1000)
        _check("rounds", self.rounds, 1, 1000)
        _check_seed(self.seed)


@dataclass(frozen=True)
class MeshSettings:
    """The size of the benchmark of checks against a mesh."""

    postures: int = 10_000
    triangles: int = 100_000
    rival_postures: int = 500  # the slower libraries see the first of them
    rounds: int = 5
    seed: int = 7

    def __post_init__(self) -> None:
        _check("postures", self.postures, 1, _MOST_AT_MESHES)
        _check("triangles", self.triangles, 1_000, 1_000_000)
        _check("rounds", self.rounds, 1, 1000)
        _check_seed(self.seed)


@dataclass(frozen=True)
class PlanSettings:
    """Which planning calls are timed."""

    scene: str = "d"
    key_frames: int = 12
    rounds: int = 20  # crossings
    starts: int = 20  # further crossings, each from another start, as the trials of Table 1 have them
    horizons: tuple[int, ...] = (4, 8, 12, 16, 20, 24)
    obstacles: tuple[int, ...] = (0, 8, 16, 24, 32, 40)

    def __post_init__(self) -> None:
        _check("key frames", self.key_frames, 2, 100)
        _check("rounds", self.rounds, 1, 1000)
        _check("starts", self.starts, 1, 1000)


@dataclass(frozen=True)
class PlannersSettings:
    """Which crossings planners are compared on."""

    scenes: tuple[str, ...] = ("a", "b", "c", "d")
    levels: tuple[int, ...] = (1, 2, 3)  # of gauntlets; courses that wind are left out: the general planner goes ahead
    trials: int = 3  # seeds in a scene, courses of a level
    limit: float = 30.0  # seconds that a user has to cross, and the general planner to plan

    def __post_init__(self) -> None:
        for level in self.levels:
            level_of(level)
        _check("trials", self.trials, 1, 1000)
        if not 0.0 < self.limit <= 3600.0:
            raise InputError(f"limit {self.limit:g}: allowed is more than 0, up to 3600 seconds")


@dataclass(frozen=True)
class SteerSettings:
    """What is steered through."""

    scenes: tuple[str, ...] = ()  # of `STEERED`; none: all
    seconds: float = 15.0  # of steering in each, unless the finish is reached before
    rounds: int = 3  # walks through each, every one from another start

    def __post_init__(self) -> None:
        check_steered(self.scenes)
        _check("seconds", self.seconds, 1, 600)
        _check("rounds", self.rounds, 1, 1000)


@dataclass(frozen=True)
class CrowdSettings:
    """Which crowds are measured."""

    avatars: tuple[int, ...] = (1, 10, 100)
    seconds: float = 2.4  # that are measured, of each crowd
    settle: float = 1.2  # seconds before them

    def __post_init__(self) -> None:
        for count in self.avatars:
            _check("avatars", count, 1, _MOST_AVATARS)
        if not self.avatars or not 0.5 <= self.seconds <= 60.0:
            raise InputError("a crowd needs avatars, and 0.5 to 60 seconds")


def check_steered(names: Sequence[str]) -> None:
    """Raises `InputError` if nothing of such a name can be steered through."""
    for name in names:
        if name not in STEERED:
            raise InputError(f"steered scene {name!r} is unknown; there are {', '.join(map(repr, STEERED))}")


def _check(name: str, value: float, least: int, most: int) -> None:
    if not least <= value <= most:
        raise InputError(f"{name} {value:g}: allowed are {least} to {most}")


def _check_seed(seed: int) -> None:
    if seed < 0:
        raise InputError(f"seed {seed}: is negative")
