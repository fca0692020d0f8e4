"""Which courses are walked, and how: those of a level; `place/settings.py` has those of a place."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.recordings.avatar_reference import AvatarReference
from elbowroom.control.settings import ControlSettings
from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.levels import level_of
from elbowroom.experiment.gauntlet.names import LARGEST_SEED
from elbowroom.experiment.gauntlet.trial_settings import TrialSettings
from elbowroom.experiment.parallel import Task
from elbowroom.planning.names import check_planner

if TYPE_CHECKING:
    from elbowroom.experiment.gauntlet.tasks import CourseTask
    from elbowroom.world.scene import Scene

MOST_COURSES = 1_000_000


class SeededTask(Task[dict[str, Any]], Protocol):
    """The task of one course."""

    @property
    def key(self) -> str:
        """What tells it from all others with the same settings."""

    @property
    def seed(self) -> int:
        """The seed of the course."""


class Gauntlet(Protocol):
    """Courses that are walked, of whatever kind. Course k has the seed `seed + k`."""

    @property
    def courses(self) -> int:
        """How many."""

    @property
    def seed(self) -> int:
        """The seed of course 0."""

    @property
    def trial(self) -> TrialSettings:
        """How each is walked."""

    @property
    def judge(self) -> bool:
        """Whether another library judges every walk."""

    @property
    def avatar(self) -> AvatarReference | None:
        """Who walks courses made for its body; None: the stock avatar."""

    @property
    def name(self) -> str:
        """What files of results are called after."""

    @property
    def title(self) -> str:
        """What the courses are of, in a few words."""

    @property
    def no_course(self) -> str:
        """Why a seed may give a body no course; the seeds go into the braces."""

    def tasks(self) -> Sequence[SeededTask]:
        """A task for every course."""

    def scene(self, humanoid: Humanoid, k: int) -> "Scene":
        """Course `k` for this body; raises `InputError` if there is none."""

    def told(self) -> dict[str, Any]:
        """What tells these courses from others, besides level and seed, as JSON has it."""

    def about(self) -> dict[str, Any]:
        """What the courses are of, for readers of results."""


@dataclass(frozen=True)
class GauntletSettings:
    """Which courses of a level are walked, and how. Course k has the seed `seed + k`."""

    level: int
    courses: int = 20
    seed: int = 0
    trial: TrialSettings = field(default_factory=TrialSettings)
    judge: bool = False  # whether another library judges every walk
    avatar: AvatarReference | None = None  # who walks courses made for its body; None: the stock avatar
    shapes: bool = False  # whether boxes are cut down to spheres, capsules, cylinders and hulls

    no_course = "no course for this body from {}: its arms stand out too little beside its trunk and legs"

    def __post_init__(self) -> None:
        level_of(self.level)
        check_walks(self)

    @property
    def name(self) -> str:
        """The level."""
        return str(self.level)

    @property
    def title(self) -> str:
        """The level and its margin."""
        return f"level {self.level} ({100 * level_of(self.level).margin:.0f} cm)"

    def tasks(self) -> "list[CourseTask]":
        """A task for every course."""
        from elbowroom.experiment.gauntlet.tasks import CourseTask

        return [CourseTask(self.level, k, self.trial, self.judge, self.avatar, self.shapes) for k in seeds_of(self)]

    def scene(self, humanoid: Humanoid, k: int) -> "Scene":
        """Course `k` for this body; raises `InputError` if there is none."""
        from elbowroom.experiment.gauntlet.course import CourseMaker
        from elbowroom.experiment.gauntlet.shapes import in_shapes

        course = CourseMaker.of(humanoid).course(self.level, self.seed + k)
        return (in_shapes(course) if self.shapes else course).scene

    def told(self) -> dict[str, Any]:
        """What tells these courses from others, besides level and seed."""
        return {"shapes": self.shapes}

    def about(self) -> dict[str, Any]:
        """The level's figures."""
        return {"level": asdict(level_of(self.level))}


def check_walks(gauntlet: Gauntlet) -> None:
    """Raises `InputError` for numbers of courses and seeds out of range, and for ways to walk that there are not."""
    if not 1 <= gauntlet.courses <= MOST_COURSES:
        raise InputError(f"courses: {gauntlet.courses} is not a whole number from 1 to {MOST_COURSES}")
    most = LARGEST_SEED + 1 - gauntlet.courses
    if not 0 <= gauntlet.seed <= most:
        raise InputError(f"seed: {gauntlet.seed} is not a whole number from 0 to {most}")
    check_planner(gauntlet.trial.planner)
    ControlSettings(queue_size=gauntlet.trial.queue_size)


def seeds_of(gauntlet: Gauntlet) -> range:
    """The seeds of all courses."""
    return range(gauntlet.seed, gauntlet.seed + gauntlet.courses)
