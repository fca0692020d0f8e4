"""What can be said of a call's arguments before anything heavy is imported."""

import os
from collections.abc import Collection, Iterable
from importlib.util import find_spec
from pathlib import Path

from elbowroom.errors import InputError


def check_arguments(
    *,
    scenes: Collection[str] = (),
    planners: Iterable[str] = (),
    queues: Iterable[int] = (),
    level: int | None = None,
    files: Iterable[Path | None] = (),
    clips: Iterable[str] = (),
    written: Iterable[Path | None] = (),
    port: int = 0,
) -> None:
    """Raises `InputError` for names that nothing has, sizes out of range and files that are not there.

    `clips` are references, FILE or FILE#CLIP; `written` are files to come, whose folders must be there, each another
    file than those that are read or written beside it.
    """
    from elbowroom.clips.reference import split_reference
    from elbowroom.control.settings import check_queue_size
    from elbowroom.experiment.gauntlet.levels import level_of
    from elbowroom.experiment.gauntlet.names import check_name, is_course
    from elbowroom.planning.names import check_planner
    from elbowroom.server.ports import check_port
    from elbowroom.world.stock_scenes import stock_names

    check_port(port)
    for planner in planners:
        check_planner(planner)
    for size in queues:
        check_queue_size(size)
    if level is not None:
        level_of(level)
    for scene in scenes:
        check_name(scene)
    named = [Path(scene) for scene in scenes if scene.lower() not in stock_names() and not is_course(scene)]
    read = [file for file in (*named, *files, *(split_reference(clip)[0] for clip in clips)) if file is not None]
    for file in read:
        check_file(file)
    _check_written([file for file in written if file is not None], read)


def _check_written(written: list[Path], read: list[Path]) -> None:
    taken = {os.path.realpath(file) for file in read}
    for file in written:
        if not file.parent.is_dir():
            raise InputError(f"{file}: cannot be written (there is no folder {file.parent})")
        if os.path.realpath(file) in taken:
            raise InputError(f"{file}: is named twice in this call; choose another name for what is written")
        taken.add(os.path.realpath(file))


def check_file(file: Path) -> None:
    """Raises `InputError` for a file that cannot be read."""
    try:
        with file.open("rb"):
            pass
    except OSError as error:
        raise InputError(f"{file}: cannot be read: {error.strerror}") from None


def check_judge(without: str = "") -> None:
    """Raises `InputError` where the library that judges is not installed, before anything is walked to be judged.

    `without` is the option, if there is one, with which nothing is judged.
    """
    if find_spec("coal") is None:
        mend = "pip install 'elbowroom[judge]'" + (f", or {without}" if without else "")
        raise InputError(f"the judge needs the collision library coal: {mend}")


def check_folder(folder: Path | None) -> None:
    """Raises `InputError` for a folder to come that a file is in the way of, or where nothing may be written."""
    for there in () if folder is None else (folder, *folder.parents):
        if there.exists():
            if not there.is_dir():
                raise InputError(f"{folder}: cannot be written in ({there} is no folder)")
            if not os.access(there, os.W_OK):
                raise InputError(f"{folder}: cannot be written in ({there} is not yours to write in)")
            return
