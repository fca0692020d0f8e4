"""The files that pages show places with: GLBs in a private folder, known by names that nobody guesses."""

import secrets
from dataclasses import replace
from pathlib import Path

from elbowroom.world.places.shown import shown_glb
from elbowroom.world.scene import Scene


class PlaceFiles:
    """GLBs of places by name; the folder is somebody else's, and goes with its owner."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files: dict[str, Path] = {}

    def get(self, name: str) -> Path | None:
        """The file of this name."""
        return self._files.get(name)

    def files(self) -> set[Path]:
        """All of them."""
        return set(self._files.values())

    def shown(self, scene: Scene) -> Scene:
        """The scene with a file for viewers, where it was made of a model; raises `InputError`, OSError."""
        placed = scene.place
        if placed is None or placed.place is None:
            return scene
        path = self._folder / f"{secrets.token_hex(16)}.glb"
        path.write_bytes(shown_glb(placed.place, placed.options.ground or 0.0))
        return self.adopt(scene, path)

    def adopt(self, scene: Scene, path: Path) -> Scene:
        """The scene with a file in the folder that was made for viewers of it."""
        if scene.place is None:
            return scene
        self._files[path.stem] = path
        return replace(scene, place=replace(scene.place, place=None, glb=path))

    def forget(self, scene: Scene) -> None:
        """Remove the file of a scene that is shown no more."""
        if scene.place is not None and scene.place.glb is not None:
            self._files.pop(scene.place.glb.stem, None)
            scene.place.glb.unlink(missing_ok=True)
