"""Finds the model again that a scene was made of, where the scene came without it: as a recording's does."""

import hashlib
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from elbowroom.errors import InputError
from elbowroom.world.places.reading import read_place
from elbowroom.world.scene import Scene


def shown_as_known(scene: Scene, known: Iterable[Scene]) -> Scene:
    """The scene with the viewers' file of one that is made of the same model in the same way, if there is one."""
    own = scene.place
    if own is None or not own.sha256:
        return scene
    for other in (one.place for one in known):
        if other and other.glb and (other.sha256, other.options) == (own.sha256, own.options):
            return replace(scene, place=replace(own, glb=other.glb))
    return scene


def with_model_beside(scene: Scene, folder: Path) -> Scene:
    """The scene with its model, where that lies unchanged in a folder and can be read; else it does without."""
    own = scene.place
    if own is None or not own.sha256:
        return scene
    file = folder / Path(own.file).name
    try:
        if not file.is_file() or _sha256(file) != own.sha256:
            return scene
        return replace(scene, place=replace(own, place=read_place(file, own.options)))
    except (OSError, InputError):
        return scene


def _sha256(file: Path) -> str:
    with file.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
