"""What clients send, put on the shelf of servers that are one to their users, and found there by those that lack it."""

import pickle
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

from elbowroom.errors import InputError
from elbowroom.server.stores.avatar_store import STOCK, StoredAvatar
from elbowroom.server.stores.clip_store import SentMotions, StoredClip
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.sent_scenes import BUILT, PLACE
from elbowroom.world.scene import Scene

# Names on the shelf are what pages know things by: nobody guesses them, and only servers ask. What lies there, servers
# have written: it was read from the client's file in a process of its own.


def share_avatar(library: Library, avatar: StoredAvatar) -> None:
    """Let the other servers have an avatar that was sent."""
    glb = avatar.glb.read_bytes() if avatar.glb is not None else None
    _put(library, f"avatar:{avatar.id}", lambda: (avatar.humanoid, glb, avatar.sender))


def share_clips(library: Library, sent: SentMotions, clips: list[StoredClip]) -> None:
    """Let them have motions that were sent."""
    name, ids = f"motions:{clips[0].id}", [clip.id for clip in clips]
    _put(library, name, lambda: (replace(sent, path=Path()), ids, sent.path.read_bytes()))
    for clip in clips:
        _put(library, f"clip:{clip.id}", lambda: name)


def share_scene(library: Library, scene: Scene) -> None:
    """Let them have a scene that was built on a page, or a place that was sent."""
    path = scene.place.glb if scene.place is not None else None
    glb = path.read_bytes() if path is not None else None
    _put(library, f"scene:{scene.name}", lambda: (scene, glb))
    if path is not None:
        _put(library, f"file:{path.stem}", lambda: scene.name)


def bring_avatar(library: Library, avatar_id: str) -> None:
    """Take an avatar from the shelf, if it is not here and lies there. This and the next ones may take a while."""
    with suppress(InputError):
        library.avatars.check(avatar_id)
        return
    found = _get(library, f"avatar:{avatar_id}")
    if found is not None:
        humanoid, glb, sender = found
        with suppress(InputError):
            library.avatars.add_upload(humanoid, _written(library, avatar_id, glb), sender, avatar_id)


def shared_avatar(library: Library, avatar_id: str) -> StoredAvatar:
    """The avatar with this id, from here or from the shelf; raises `InputError` if there is none."""
    bring_avatar(library, avatar_id)
    return library.avatars.get(avatar_id)


def bring_clip(library: Library, clip_id: str) -> None:
    """The same for a motion."""
    with suppress(InputError):
        library.clips.check(clip_id)
        return
    name = _get(library, f"clip:{clip_id}")
    found = None if name is None else _get(library, name)
    if found is not None:
        sent, ids, data = found
        path = _written(library, f"clip-{clip_id}", data)
        with suppress(InputError):
            library.clips.add_upload(replace(sent, path=path), ids)


def bring_scene(library: Library, name: str) -> None:
    """The same for a scene that was built on a page, or a place that was sent."""
    if not name.startswith((BUILT, PLACE)):
        return
    with suppress(InputError):
        library.check_scene(name)
        return
    found = _get(library, f"scene:{name}")
    if found is not None:
        scene, glb = found
        if glb is not None:
            path = _written(library, scene.place.glb.stem, glb)
            scene = replace(scene, place=replace(scene.place, glb=path))
        with suppress(InputError):
            library.sent.keep(scene)


def bring_file(library: Library, stem: str) -> None:
    """The same for the file that a place is shown with."""
    if library.places.get(stem) is None:
        name = _get(library, f"file:{stem}")
        if name is not None:
            bring_scene(library, name)


def bring(library: Library, scene: str | None, avatar: str | None, clip: str | None) -> None:
    """All that a session asks for."""
    if scene:
        bring_scene(library, scene)
    if avatar and avatar != STOCK:
        bring_avatar(library, avatar)
    if clip:
        bring_clip(library, clip)


def _put(library: Library, name: str, thing: Callable[[], object]) -> None:
    if library.shared:
        library.shelf.put(name, pickle.dumps(thing()))


def _get(library: Library, name: str) -> Any:
    data = library.shelf.get(name) if library.shared else None
    return None if data is None else pickle.loads(data)


def _written(library: Library, stem: str, data: bytes | None) -> Any:
    """A file in the private folder."""
    if data is None:
        return None
    path = library.avatars.folder / f"{stem}.glb"
    path.write_bytes(data)
    return path
