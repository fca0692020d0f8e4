"""Scenes that pages have sent: models of places, and what was built there. Only who has its name can find one."""

import hashlib
import json
import secrets
from collections.abc import Hashable
from dataclasses import replace
from pathlib import Path

from elbowroom.errors import InputError
from elbowroom.server.entrance.page_key import Sender
from elbowroom.server.stores.place_files import PlaceFiles
from elbowroom.server.stores.recent import Capacity, RecentlySent
from elbowroom.server.stores.scene_weight import weight_of
from elbowroom.world.scene import Scene

PLACE, BUILT = "place:", "built:"  # begin their names
MOST, MOST_EACH = 16, 6  # in all, and of one machine that is not this one
MOST_BYTES = 2**30  # of memory and on disk, of all of them
_NOBODY = Sender()
_GONE = {
    PLACE: "that place is not here any more; drop its file on the page again",
    BUILT: "that scene is not here any more; open it in build mode and walk it again",
}


class SentScenes:
    """Scenes by name: the one that was used least recently goes first, what a session shows stays."""

    def __init__(self, places: PlaceFiles) -> None:
        """`places` keeps the files that models of places are shown with."""
        self._places = places
        self._kept = RecentlySent[Scene](lambda: Capacity(MOST, MOST_EACH, MOST_BYTES), places.forget)

    def add_place(self, scene: Scene, glb: Path, sender: Sender = _NOBODY) -> Scene:
        """The scene of a place, under its name here; `glb` is what it is shown with, and goes with it.

        This and the next ones take a while, and raise `InputError` where there is no place for it.
        """
        place = None if scene.place is None else replace(scene.place, glb=glb)
        return self.keep(replace(scene, name=f"{PLACE}{secrets.token_hex(8)}", place=place), sender)

    def add_built(self, scene: Scene, sender: Sender = _NOBODY) -> Scene:
        """A scene that was built on a page; the same one has the same name: a page that sends it again finds it."""
        digest = hashlib.sha256(json.dumps(scene.to_dict()).encode()).hexdigest()
        name = f"{BUILT}{digest[:32]}"
        return self._kept.get(name) or self.keep(replace(scene, name=name), sender)

    def keep(self, named: Scene, sender: Sender = _NOBODY) -> Scene:
        """Keep a scene under the name that it has, with its file in the private folder, if it has one."""
        glb = None if named.place is None else named.place.glb
        own = named if glb is None else self._places.adopt(named, glb)
        try:
            self._kept.add(own.name, own, weight_of(own), sender.shares)
        except InputError:
            self._places.forget(own)
            raise
        return own

    def get(self, name: str) -> Scene | None:
        """The scene of this name, which counts as use; None for a name of another kind.

        Raises `InputError` if it is not here any more.
        """
        kind = next((prefix for prefix in _GONE if name.startswith(prefix)), None)
        if kind is None:
            return None
        found = self._kept.get(name)
        if found is None:
            raise InputError(_GONE[kind])
        return found

    def hold(self, user: Hashable, *names: str) -> None:
        """These are the scenes that a session shows from now on: they stay."""
        self._kept.hold(user, *names)
