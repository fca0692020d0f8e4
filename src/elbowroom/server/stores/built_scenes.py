"""Scenes that pages have built and sent; each is known by a name that only who has it can tell."""

import hashlib
import json
from dataclasses import replace

from elbowroom.errors import InputError
from elbowroom.world.scene import Scene

PREFIX = "built:"
MOST = 32  # the one that was sent longest ago goes first; who walks there goes on


class BuiltScenes:
    """Scenes by name; the same scene has the same name, so that a page that sends it again finds it again."""

    def __init__(self) -> None:
        self._kept: dict[str, Scene] = {}

    def add(self, scene: Scene) -> Scene:
        """The scene under its name here."""
        digest = hashlib.sha256(json.dumps(scene.to_dict()).encode()).hexdigest()
        return self.keep(replace(scene, name=f"{PREFIX}{digest[:32]}"))

    def keep(self, named: Scene) -> Scene:
        """The same under the name that it has."""
        self._kept.pop(named.name, None)
        self._kept[named.name] = named
        while len(self._kept) > MOST:
            del self._kept[next(iter(self._kept))]
        return named

    def get(self, name: str) -> Scene | None:
        """The scene of this name, if it was built on a page; raises `InputError` if it is not here any more."""
        if not name.startswith(PREFIX):
            return None
        if name not in self._kept:
            raise InputError("that scene is not here any more; open it in build mode and walk it again")
        return self._kept[name]
