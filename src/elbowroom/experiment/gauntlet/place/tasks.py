"""Courses in a place as tasks that other processes can do."""

from dataclasses import asdict, dataclass, replace
from typing import Any

from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.control.recordings.avatar_reference import AvatarReference
from elbowroom.experiment.crossing import warm_up
from elbowroom.experiment.gauntlet.course import NoCourseError
from elbowroom.experiment.gauntlet.judged import judged_walk
from elbowroom.experiment.gauntlet.place.course import PlaceCourseMaker
from elbowroom.experiment.gauntlet.place.furnished import FurnishedPlace
from elbowroom.experiment.gauntlet.place.trial import NO_LEVEL, walk_place_course
from elbowroom.experiment.gauntlet.tasks import NO_COURSE, CourseWalker, Record
from elbowroom.experiment.gauntlet.trial_settings import TrialSettings
from elbowroom.experiment.opened import Openable, opened


@dataclass(frozen=True)
class PlaceCourses:
    """The courses of one place for one avatar, as a thing that is opened once in a process."""

    place: FurnishedPlace
    avatar: AvatarReference | None  # None: the stock one

    def open(self) -> PlaceCourseMaker:
        """Read avatar and place."""
        humanoid = opened(CourseWalker(self.avatar))
        return PlaceCourseMaker.open(humanoid, self.place.path, self.place.options, self.place.pieces)


@dataclass(frozen=True)
class PlaceTask:
    """Make a course in a place, walk it, and have the walk judged if asked to."""

    place: FurnishedPlace
    seed: int
    settings: TrialSettings
    judge: bool = False
    avatar: AvatarReference | None = None

    @property
    def key(self) -> str:
        """What tells this task from all others with the same settings."""
        return f"place-{self.seed}"

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """The avatar, and the place."""
        return (CourseWalker(self.avatar), PlaceCourses(self.place, self.avatar))

    def run(self) -> Record:
        """The result as a plain record, see `tasks.result_of`."""
        maker = opened(PlaceCourses(self.place, self.avatar))
        try:
            course = maker.course(self.seed)
        except NoCourseError:
            return {"level": NO_LEVEL, "seed": self.seed, NO_COURSE: True}
        ahead = Lookahead(self.settings.queue_size)
        controller = Controller(
            maker.humanoid, course.scene, planner=self.settings.planner, seed=self.seed, ahead=ahead
        )
        warm_up(controller)
        shown: list[Frame] = []
        result = walk_place_course(controller, course, shown.append if self.judge else None)
        if self.judge and shown:
            result = replace(result, judge=judged_walk(maker.humanoid, course.scene, shown))
        return asdict(result)
