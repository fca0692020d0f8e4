"""One course walked as a task that another process can do."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.frame import Frame
from elbowroom.control.recordings.avatar_reference import AvatarReference
from elbowroom.experiment.crossing import warm_up
from elbowroom.experiment.gauntlet.course import CourseMaker, NoCourseError
from elbowroom.experiment.gauntlet.judged import judged_walk
from elbowroom.experiment.gauntlet.shapes import in_shapes
from elbowroom.experiment.gauntlet.trial import JudgeFigures, TrialResult, controller_on, walk_course
from elbowroom.experiment.gauntlet.trial_settings import TrialSettings
from elbowroom.experiment.opened import Openable, opened

Record = dict[str, Any]

NO_COURSE = "no_course"


@dataclass(frozen=True)
class CourseWalker:
    """Who walks the courses: an avatar that is known by its content, or the stock one."""

    avatar: AvatarReference | None

    def open(self) -> Humanoid:
        """Read the avatar."""
        if self.avatar is None:
            return Humanoid.default()
        return self.avatar.load(Path(self.avatar.path) if self.avatar.path else None)


@dataclass(frozen=True)
class CourseTask:
    """Make a course, walk it, and have the walk judged if asked to."""

    level: int
    seed: int
    settings: TrialSettings
    judge: bool = False
    avatar: AvatarReference | None = None  # None: the stock one
    shapes: bool = False  # whether boxes are cut down to other shapes

    @property
    def key(self) -> str:
        """What tells this task from all others with the same settings."""
        return f"{self.level}-{self.seed}"

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """The avatar."""
        return (CourseWalker(self.avatar),)

    def run(self) -> Record:
        """The result as a plain record, see `result_of`."""
        humanoid, maker = opened(CourseWalker(self.avatar)), _maker(self.avatar)
        try:
            course = maker.course(self.level, self.seed)
        except NoCourseError:
            return {"level": self.level, "seed": self.seed, NO_COURSE: True}
        course = in_shapes(course) if self.shapes else course
        controller = controller_on(humanoid, course, self.settings)
        warm_up(controller)
        shown: list[Frame] = []

        def listen(frame: Frame, dt: float) -> None:
            del dt
            shown.append(frame)

        result = walk_course(controller, course, listen if self.judge else None)
        if self.judge and shown:
            result = replace(result, judge=judged_walk(humanoid, course.scene, shown))
        return asdict(result)


def result_of(record: Mapping[str, Any]) -> TrialResult | None:
    """The result that a record holds, None where the seed gave no course; raises TypeError or KeyError otherwise."""
    if record.get(NO_COURSE):
        return None
    judge = record["judge"]
    figures = None if judge is None else JudgeFigures(**judge)
    return TrialResult(**{**record, "plan_ms": tuple(record["plan_ms"]), "judge": figures})


@lru_cache(maxsize=1)
def _maker(avatar: AvatarReference | None) -> CourseMaker:
    """The maker of an avatar's courses, once in a process."""
    return CourseMaker.of(opened(CourseWalker(avatar)))
