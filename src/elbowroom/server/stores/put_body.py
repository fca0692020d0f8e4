"""An avatar of this server for processes that work apart."""

from dataclasses import replace
from pathlib import Path

from elbowroom.server.apart.answers import packed
from elbowroom.server.stores.avatar_store import StoredAvatar


def put_body(avatar: StoredAvatar, file: Path) -> None:
    """Write the humanoid without its avatar's file, as `answers.unpacked` reads it; raises OSError."""
    file.write_bytes(packed(replace(avatar.humanoid, glb=None, source=None)))
