"""The whole experiment: its trials run or taken from the log, its table folded from them."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from elbowroom import __version__
from elbowroom.control.recordings.avatar_reference import AvatarReference
from elbowroom.control.recordings.recording import this_machine
from elbowroom.control.settings import ControlSettings
from elbowroom.experiment.crossing import controller_for, warm_up
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.machine import machine_kind, program_digest
from elbowroom.experiment.paper_table import PaperCell, paper_table
from elbowroom.experiment.parallel import Workers
from elbowroom.experiment.table1.cells import CannedCell, Cell, fold_canned, fold_cell
from elbowroom.experiment.table1.settings import Table1Settings
from elbowroom.experiment.table1.tasks import (
    CannedTask,
    CrossingTask,
    canned_tasks,
    crossing_tasks,
    open_avatar,
    open_scene,
    scene_key,
)
from elbowroom.experiment.trial_log import TrialLog
from elbowroom.planning.planner import make_planner

Record = dict[str, Any]
Progress = Callable[[int, int], None]  # tasks done, tasks in all


@dataclass(frozen=True)
class Table1:
    """What the experiment measured. A trial is a plain record: the fields of `CrossingResult` and its times."""

    settings: Table1Settings
    cells: tuple[Cell, ...]  # by planner, scene, queue size
    canned: tuple[CannedCell, ...]  # by scene
    trials: tuple[Record, ...]  # in the order of the cells, then by seed
    canned_trials: tuple[Record, ...]

    def paper(self, cell: Cell) -> PaperCell | None:
        """The paper's cell beside this one, if it has one."""
        return paper_table().get((cell.scene, cell.queue_size))

    def records(self, cell: Cell) -> tuple[Record, ...]:
        """The trials of a cell."""
        key = (cell.planner, cell.scene, cell.queue_size)
        return tuple(trial for trial in self.trials if _cell_key(trial) == key)


def check(settings: Table1Settings) -> None:
    """Open what the experiment needs. Raises `InputError` where a scene, a planner, a queue or the avatar is wrong."""
    humanoid = open_avatar(settings.avatar)
    for scene in settings.scenes:
        open_scene(scene)
    for planner in settings.planners:
        make_planner(planner, humanoid, open_scene(settings.scenes[0]))
    for queue in settings.queues:
        ControlSettings(queue_size=queue)
    next(crossing_tasks(settings))


def warm_kernels(settings: Table1Settings) -> None:
    """Have all kernels compiled and kept on disk, so that the trials' processes only load them."""
    humanoid, scene = open_avatar(settings.avatar), open_scene(settings.scenes[0])
    for planner in settings.planners:
        warm_up(controller_for(humanoid, scene, CrossingSettings(planner, settings.queues[0], seed=1)))


def identity(settings: Table1Settings) -> Record:
    """All on which the outcome of a trial depends, besides its scene, planner, queue size and seed."""
    avatar = asdict(AvatarReference.of(open_avatar(settings.avatar)))
    return {
        "version": __version__,
        "program": program_digest(),
        "avatar": {name: avatar[name] for name in ("name", "stock", "sha256")},
        "limit": settings.limit,
        "interval": ControlSettings.interval,
        "machine": this_machine() | {"kind": machine_kind()},
    }


def planner_settings(settings: Table1Settings) -> Record:
    """The settings of every planner of the experiment, as far as it has any."""
    humanoid, scene = open_avatar(settings.avatar), open_scene(settings.scenes[0])
    planners = {name: make_planner(name, humanoid, scene) for name in settings.planners}
    return {name: asdict(planner.settings) for name, planner in planners.items() if hasattr(planner, "settings")}


def run_table1(settings: Table1Settings, folder: Path, workers: Workers, progress: Progress | None = None) -> Table1:
    """Run all trials that the folder's log does not hold yet, and fold the table from all of them."""
    check(settings)
    tasks: list[CrossingTask | CannedTask] = [*crossing_tasks(settings), *canned_tasks(settings)]
    with TrialLog(folder, identity(settings)) as log:
        missing = [task for task in tasks if task.key not in log.done]
        done = len(tasks) - len(missing)
        if progress is not None:
            progress(done, len(tasks))
        for place, record in workers.run(missing):
            log.append(missing[place].key, record)
            done += 1
            if progress is not None:
                progress(done, len(tasks))
        return _fold(settings, log.done)


def _fold(settings: Table1Settings, done: dict[str, Record]) -> Table1:
    trials = [done[task.key] for task in crossing_tasks(settings)]
    order = {key: place for place, key in enumerate(dict.fromkeys(_cell_key(trial) for trial in trials))}
    trials.sort(key=lambda trial: (order[_cell_key(trial)], trial["seed"]))
    walks = [done[task.key] for task in canned_tasks(settings)]
    scenes = [scene_key(scene).partition("@")[0] for scene in settings.scenes]
    return Table1(
        settings,
        cells=tuple(fold_cell(_where(trials, key), settings.limit) for key in order),
        canned=tuple(fold_canned([walk for walk in walks if walk["scene"] == scene]) for scene in scenes),
        trials=tuple(trials),
        canned_trials=tuple(walks),
    )


def _where(trials: Sequence[Record], key: tuple[str, str, int]) -> list[Record]:
    return [trial for trial in trials if _cell_key(trial) == key]


def _cell_key(trial: Record) -> tuple[str, str, int]:
    return trial["planner"], trial["scene"], trial["queue_size"]
