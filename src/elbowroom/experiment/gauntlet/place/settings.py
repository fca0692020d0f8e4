"""Which courses of a place are walked, and how."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.recordings.avatar_reference import AvatarReference
from elbowroom.experiment.gauntlet.place.furnished import MARGIN, FurnishedPlace
from elbowroom.experiment.gauntlet.settings import check_walks, seeds_of
from elbowroom.experiment.gauntlet.trial_settings import TrialSettings

if TYPE_CHECKING:
    from elbowroom.experiment.gauntlet.place.tasks import PlaceTask
    from elbowroom.world.scene import Scene


@dataclass(frozen=True)
class PlaceGauntletSettings:
    """Which courses of a place are walked, and how. Course k has the seed `seed + k`."""

    place: FurnishedPlace
    courses: int = 20
    seed: int = 0
    trial: TrialSettings = field(default_factory=TrialSettings)
    judge: bool = False  # whether another library judges every walk
    avatar: AvatarReference | None = None  # None: the stock one

    name = "place"
    no_course = "no course for this body from {}: no way of 3 m and more was found that furniture leaves free"

    def __post_init__(self) -> None:
        check_walks(self)

    @property
    def title(self) -> str:
        """The place, its pieces of furniture and the margin."""
        return f"{self.place.path.name} with {self.place.pieces} pieces of furniture ({100 * MARGIN:.0f} cm)"

    def tasks(self) -> "list[PlaceTask]":
        """A task for every course."""
        from elbowroom.experiment.gauntlet.place.tasks import PlaceTask

        return [PlaceTask(self.place, seed, self.trial, self.judge, self.avatar) for seed in seeds_of(self)]

    def scene(self, humanoid: Humanoid, k: int) -> "Scene":
        """Course `k` for this body; raises `InputError` if there is none."""
        from elbowroom.experiment.gauntlet.place.course import PlaceCourseMaker

        place = self.place
        return PlaceCourseMaker.open(humanoid, place.path, place.options, place.pieces).course(self.seed + k).scene

    def told(self) -> dict[str, Any]:
        """What tells these courses from others, as JSON has it."""
        return {"place": {"sha256": self.place.sha256, **self.place.options.to_dict(), "pieces": self.place.pieces}}

    def about(self) -> dict[str, Any]:
        """The file, its furniture and the margin."""
        return {"place": {"file": self.place.path.name, "pieces": self.place.pieces, "margin": MARGIN}}
