"""Many courses walked, in parallel and resumable."""

from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import asdict, replace
from importlib.resources import files
from pathlib import Path
from typing import Any, NamedTuple

from elbowroom import __version__
from elbowroom.control.recordings.recording import this_machine
from elbowroom.control.settings import ControlSettings
from elbowroom.experiment.gauntlet.settings import Gauntlet
from elbowroom.experiment.gauntlet.tasks import result_of
from elbowroom.experiment.gauntlet.trial import TrialResult
from elbowroom.experiment.machine import machine_kind, program_digest
from elbowroom.experiment.parallel import Processes, Workers
from elbowroom.experiment.trial_log import TrialLog, digest

Progress = Callable[[int, int], None]  # courses done, courses in all


class GauntletRun(NamedTuple):
    """What came of the courses that were asked for."""

    results: list[TrialResult]  # of those that could be made, in order
    without_course: tuple[int, ...]  # seeds that give this body no course


def identity(settings: Gauntlet) -> dict[str, Any]:
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
    settings: Gauntlet,
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
