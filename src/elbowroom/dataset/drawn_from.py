"""Whether all that a dataset draws from can be opened, asked before anything is walked."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from elbowroom.dataset.spec import STOCK, DatasetSpec, level
from elbowroom.dataset.walk import SwingFile
from elbowroom.errors import InputError
from elbowroom.experiment.opened import Openable, opened
from elbowroom.experiment.table1.tasks import AvatarFile, NamedScene


def check_drawn_from(spec: DatasetSpec, file: Path) -> None:
    """Open every place, avatar and swing once; raises `InputError` that names `file`, the list and the mend."""
    for listed, thing in _things(spec):
        try:
            opened(thing)
        except InputError as error:
            mend = f"mend it in {listed!r}, or take it out; files are looked for beside {file.name}"
            raise InputError(f"{file}: {error}: {mend}") from None


def _things(spec: DatasetSpec) -> Iterator[tuple[str, Openable[Any]]]:
    """The name of the list, and what an entry of it stands for."""
    for name in dict.fromkeys(spec.swings):
        yield "swings", SwingFile(name)
    for name in dict.fromkeys(spec.avatars):
        yield "avatars", AvatarFile(None if name == STOCK else Path(name))
    for name in dict.fromkeys(spec.places):
        if level(name) is None:
            yield "places", NamedScene(name)
