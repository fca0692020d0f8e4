"""The avatars that a server knows: the stock one, one named on the command line, and a few dropped on the page."""

import secrets
import tempfile
import threading
from collections import OrderedDict
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.load_settings import LoadSettings
from elbowroom.errors import InputError
from elbowroom.server.pose import Poser
from elbowroom.server.schema.menus import AvatarChoice

STOCK = "stock"
MAX_UPLOADS = 8  # the one that was used least recently goes first
MAX_UPLOADED = 256 * 2**20  # bytes of all of them on disk


@dataclass(frozen=True, eq=False)
class StoredAvatar:
    """An avatar and the GLB that a page shows it with."""

    id: str
    humanoid: Humanoid
    glb: Path | None  # None for a humanoid without a file
    sender: str = ""  # address of the machine that it was sent from: there it is no stranger's
    owner: str = ""  # key of the page that sent it: only there the menu shows it

    @property
    def title(self) -> str:
        """What the menu shows."""
        return self.humanoid.meta.title or self.humanoid.name

    @cached_property
    def poser(self) -> Poser:
        """The tables that pose it."""
        return Poser(self.humanoid)


class AvatarStore:
    """Avatars by id; may be used from several threads. The files lie in a private folder that goes with `close`."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="elbowroom-avatars-")
        self._lock = threading.Lock()
        self._kept: dict[str, StoredAvatar] = {}
        self._uploads: OrderedDict[str, StoredAvatar] = OrderedDict()

    def close(self) -> None:
        """Remove the private folder."""
        self._folder.cleanup()

    def choices(self, owner: str = "") -> list[AvatarChoice]:
        """What the menu offers to the page with this key: the stock avatar, even before it is read, and its own."""
        with self._lock:
            own = [upload for upload in self._uploads.values() if owner and upload.owner == owner]
            known = [*self._kept.values(), *own]
        stock = [] if any(avatar.id == STOCK for avatar in known) else [AvatarChoice(STOCK, "Stock avatar")]
        return stock + [AvatarChoice(avatar.id, avatar.title) for avatar in known]

    def check(self, avatar_id: str) -> None:
        """Raises `InputError` if there is no avatar with this id."""
        with self._lock:
            known = avatar_id == STOCK or avatar_id in self._kept or avatar_id in self._uploads
        if not known:
            raise InputError(f"avatar {avatar_id[:40]!r} is not known here (any more); drop its file on the page again")

    def get(self, avatar_id: str) -> StoredAvatar:
        """The avatar with this id, read if need be; raises `InputError` if there is none. May take a while."""
        self.check(avatar_id)
        with self._lock:
            found = self._kept.get(avatar_id) or self._uploads.get(avatar_id)
            if avatar_id in self._uploads:
                self._uploads.move_to_end(avatar_id)
        return found or self._keep(STOCK, Humanoid.default())

    def add_file(self, path: Path, read: LoadSettings | None = None) -> StoredAvatar:
        """Keep the avatar of a file for good; raises `InputError` if it holds no humanoid."""
        return self._keep(secrets.token_hex(8), Humanoid.load(path, read))

    def add_upload(self, data: bytes, name: str, sender: str = "", owner: str = "") -> StoredAvatar:
        """Keep an avatar that a page has sent as bytes from an address; raises `InputError` if they hold no humanoid.

        Menus offer it to that page alone; whoever is told its id can use it.
        """
        from elbowroom.body.loading import load_humanoid_bytes

        humanoid = load_humanoid_bytes(data, name)
        avatar = replace(self._stored(secrets.token_hex(8), humanoid), sender=sender, owner=owner)
        with self._lock:
            self._uploads[avatar.id] = avatar
            while len(self._uploads) > 1 and self._too_many():
                _, old = self._uploads.popitem(last=False)
                _remove(old)
        return avatar

    def _too_many(self) -> bool:
        sizes = [upload.glb.stat().st_size for upload in self._uploads.values() if upload.glb is not None]
        return len(self._uploads) > MAX_UPLOADS or sum(sizes) > MAX_UPLOADED

    def _keep(self, avatar_id: str, humanoid: Humanoid) -> StoredAvatar:
        avatar = self._stored(avatar_id, humanoid)
        with self._lock:
            return self._kept.setdefault(avatar_id, avatar)

    def _stored(self, avatar_id: str, humanoid: Humanoid) -> StoredAvatar:
        if humanoid.glb is None:
            return StoredAvatar(avatar_id, humanoid, None)
        path = Path(self._folder.name) / f"{avatar_id}.glb"
        path.write_bytes(humanoid.glb)
        return StoredAvatar(avatar_id, humanoid, path)


def _remove(avatar: StoredAvatar) -> None:
    if avatar.glb is not None:
        avatar.glb.unlink(missing_ok=True)
