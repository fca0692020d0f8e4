"""What can be said of a call's arguments before anything heavy is imported."""

from collections.abc import Iterable
from pathlib import Path

from elbowroom.errors import InputError


def check_arguments(
    *,
    scenes: Iterable[str] = (),
    planners: Iterable[str] = (),
    queues: Iterable[int] = (),
    level: int | None = None,
    files: Iterable[Path | None] = (),
) -> None:
    """Raises `InputError` for names that nothing has, sizes out of range and files that are not there."""
    from elbowroom.control.settings import check_queue_size
    from elbowroom.experiment.gauntlet.levels import level_of
    from elbowroom.experiment.gauntlet.names import check_name
    from elbowroom.planning.names import check_planner

    for planner in planners:
        check_planner(planner)
    for size in queues:
        check_queue_size(size)
    if level is not None:
        level_of(level)
    for scene in scenes:
        check_name(scene)
    for file in files:
        if file is not None:
            _check_file(file)


def _check_file(file: Path) -> None:
    try:
        with file.open("rb"):
            pass
    except OSError as error:
        raise InputError(f"{file} cannot be read: {error.strerror}") from None
