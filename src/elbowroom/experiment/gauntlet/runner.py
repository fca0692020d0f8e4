"""Many courses walked, in parallel and resumable."""

from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import asdict, dataclass, field, replace
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

from elbowroom import __version__
from elbowroom.control.recordings.avatar_reference import AvatarReference
from elbowroom.control.recordings.recording import this_machine
from elbowroom.control.settings import ControlSettings
from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.levels import level_of
from elbowroom.experiment.gauntlet.names import LARGEST_SEED
from elbowroom.experiment.gauntlet.place.tasks import PlaceGauntletSettings
from elbowroom.experiment.gauntlet.tasks import CourseTask, result_of
from elbowroom.experiment.gauntlet.trial import TrialResult, TrialSettings
from elbowroom.experiment.machine import machine_kind, program_digest
from elbowroom.experiment.parallel import Processes, Workers
from elbowroom.experiment.trial_log import TrialLog, digest
from elbowroom.planning.names import check_planner

MOST_COURSES = 1_000_000

Progress = Callable[[int, int], None]  # courses done, courses in all


@dataclass(frozen=True)
class GauntletSettings:
    """Which courses are walked, and how. Course k has the seed `seed + k`."""

    level: int
    courses: int = 20
    seed: int = 0
    trial: TrialSettings = field(default_factory=TrialSettings)
    judge: bool = False  # whether another library judges every walk
    avatar: AvatarReference | None = None  # who walks courses made for its body; None: the stock avatar
    shapes: bool = False  # whether boxes are cut down to spheres, capsules, cylinders and hulls

    def __post_init__(self) -> None:
        level_of(self.level)
        if not 1 <= self.courses <= MOST_COURSES:
            raise InputError(f"courses: {self.courses} is not a whole number from 1 to {MOST_COURSES}")
        if not 0 <= self.seed <= LARGEST_SEED + 1 - self.courses:
            raise InputError(f"seed: {self.seed} is not a whole number from 0 to {LARGEST_SEED + 1 - self.courses}")
        check_planner(self.trial.planner)
        ControlSettings(queue_size=self.trial.queue_size)

    def tasks(self) -> list[CourseTask]:
        """A task for every course."""
        seeds = range(self.seed, self.seed + self.courses)
        return [CourseTask(self.level, seed, self.trial, self.judge, self.avatar, self.shapes) for seed in seeds]

    def told(self) -> dict[str, Any]:
        """What tells these courses from others, besides level and seed."""
        return {"shapes": self.shapes}


class GauntletRun(NamedTuple):
    """What came of the courses that were asked for."""

    results: list[TrialResult]  # of those that could be made, in order
    without_course: tuple[int, ...]  # seeds that give this body no course


def identity(settings: GauntletSettings | PlaceGauntletSettings) -> dict[str, Any]:
    """All on which the outcome of a walk depends, besides the course's level and seed."""
    return {
        "experiment": "gauntlet",
        **settings.told(),
        "version": __version__,
        "program": program_digest(),
        "generator": _generator_digest(),
        **asdict(settings.trial),
        "interval": ControlSettings.interval,
        "judge": settings.judge,
        "avatar": "stock" if settings.avatar is None else asdict(replace(settings.avatar, path="")),
        "machine": this_machine() | {"kind": machine_kind()},
    }


def run_gauntlet(
    settings: GauntletSettings | PlaceGauntletSettings,
    workers: Workers = Processes(),  # noqa: B008  frozen
    folder: Path | None = None,
    progress: Progress | None = None,
) -> GauntletRun:
    """Walk all courses and give the results in their order; seeds that give this body no course are passed over.

    With a `folder`, every result is kept there at once, and what it holds of an earlier run with the same settings is
    not walked again. Raises `InputError` for settings out of range and where the folder cannot be used.
    """
    tasks = settings.tasks()
    with nullcontext() if folder is None else TrialLog(folder, identity(settings)) as log:
        done = {} if log is None else {task.key: log.done[task.key] for task in tasks if task.key in log.done}
        missing = [task for task in tasks if task.key not in done]
        if progress is not None:
            progress(len(done), len(tasks))
        for place, record in workers.run(missing):
            done[missing[place].key] = record
            if log is not None:
                log.append(missing[place].key, record)
            if progress is not None:
                progress(len(done), len(tasks))
    found = [(task.seed, result_of(done[task.key])) for task in tasks]
    return GauntletRun(
        [result for _, result in found if result is not None],
        tuple(seed for seed, result in found if result is None),
    )


def _generator_digest() -> str:
    """A hash of the code that makes and walks courses."""
    folders = files("elbowroom.experiment.gauntlet"), files("elbowroom.experiment.gauntlet.place")
    entries = [entry for folder in folders for entry in folder.iterdir() if entry.name.endswith(".py")]
    return digest({str(number): entry.read_text("utf-8") for number, entry in enumerate(entries)})
