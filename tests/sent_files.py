"""Files as clients send them, taken in by the stores of a server without a network or a process between."""

import secrets
from pathlib import Path

from elbowroom.server.apart.jobs import read_upload
from elbowroom.server.entrance.page_key import Sender
from elbowroom.server.stores.avatar_store import AvatarStore, StoredAvatar
from elbowroom.server.stores.clip_store import ClipStore, SentMotions, StoredClip

NOBODY = Sender()


def add_avatar(store: AvatarStore, data: bytes, name: str, sender: Sender = NOBODY) -> StoredAvatar:
    """As if the avatar had been sent from an address."""
    stem = store.folder / secrets.token_hex(8)
    file, glb = stem.with_suffix(".sent"), stem.with_suffix(".glb")
    file.write_bytes(data)
    humanoid, _, _ = read_upload(str(file), name, str(glb))
    file.unlink()
    assert humanoid is not None
    return store.add_upload(humanoid, glb, sender)


def add_clips(store: ClipStore, data: bytes, name: str, folder: Path, sender: Sender = NOBODY) -> list[StoredClip]:
    """As if the motions had been sent from an address."""
    file = folder / f"{secrets.token_hex(8)}.sent"
    file.write_bytes(data)
    _, names, kind = read_upload(str(file), name, str(folder / "none.glb"))
    return store.add_upload(SentMotions(file, name, kind, tuple(names), sender))
