"""The avatars that a server knows: the stock one, one named on the command line, and a few dropped on the page."""

import re
import secrets
import tempfile
import threading
from collections.abc import Hashable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import count
from pathlib import Path

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.settings import LoadSettings
from elbowroom.errors import InputError
from elbowroom.server.entrance.page_key import Sender
from elbowroom.server.schema.menus import AvatarChoice
from elbowroom.server.stores.recent import Capacity, RecentlySent
from elbowroom.server.wire.pose import Poser

STOCK = "stock"
MAX_UPLOADS = 8  # the one that was used least recently goes first; what a session shows stays
MAX_EACH = 4  # of one machine that is not this one
MAX_UPLOADED = 256 * 2**20  # bytes of all of them on disk

_NOBODY = Sender()
_LONGEST_NAME = 60  # characters


@dataclass(frozen=True, eq=False)
class StoredAvatar:
    """An avatar and the GLB that a page shows it with."""

    id: str
    humanoid: Humanoid
    glb: Path | None  # None for a humanoid without a file
    sender: Sender = _NOBODY  # on the machine that it was sent from it is no stranger's; only its page's menu shows it

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
        self._folder = tempfile.TemporaryDirectory(prefix="elbowroom-avatars-", ignore_cleanup_errors=True)
        self._lock = threading.Lock()
        self._kept: dict[str, StoredAvatar] = {}
        self._uploads = RecentlySent[StoredAvatar](lambda: Capacity(MAX_UPLOADS, MAX_EACH, MAX_UPLOADED), _remove)

    @property
    def folder(self) -> Path:
        """Where the files lie."""
        return Path(self._folder.name)

    def close(self) -> None:
        """Remove the private folder."""
        self._folder.cleanup()

    def choices(self, owner: str = "") -> list[AvatarChoice]:
        """What the menu offers to the page with this key: the stock avatar, even before it is read, and its own."""
        own = [upload for upload in self._uploads.items() if owner and upload.sender.key == owner]
        known = [*self.lasting(), *own]
        stock = [] if any(avatar.id == STOCK for avatar in known) else [AvatarChoice(STOCK, "Stock avatar")]
        return stock + [AvatarChoice(avatar.id, avatar.title) for avatar in known]

    def check(self, avatar_id: str) -> None:
        """Raises `InputError` if there is no avatar with this id."""
        if avatar_id != STOCK:
            self.get(avatar_id)

    def get(self, avatar_id: str) -> StoredAvatar:
        """The avatar with this id, read if need be; raises `InputError` if there is none. May take a while."""
        found = self._kept.get(avatar_id) or self._uploads.get(avatar_id)
        if found is None and avatar_id == STOCK:
            found = self._keep(STOCK, Humanoid.default())
        if found is None:
            raise InputError(f"avatar {avatar_id[:40]!r} is not known here (any more); drop its file on the page again")
        return found

    def hold(self, user: Hashable, *avatar_ids: str) -> None:
        """These are the avatars that a session shows from now on: they stay."""
        self._uploads.hold(user, *avatar_ids)

    def files(self) -> set[Path]:
        """The files of what was sent."""
        return {avatar.glb for avatar in self._uploads.items() if avatar.glb is not None}

    def add_file(self, path: Path, read: LoadSettings | None = None) -> StoredAvatar:
        """Keep the avatar of a file for good, by the file's name; raises `InputError` if it holds no humanoid."""
        return self._keep(self._free_name(path.stem), Humanoid.load(path, read))

    def add_upload(
        self, humanoid: Humanoid, file: Path | None, sender: Sender = _NOBODY, avatar_id: str = ""
    ) -> StoredAvatar:
        """Keep an avatar that was sent, its GLB in a file of `folder`, which goes with it.

        Menus offer it to the page that sent it alone; whoever is told its id can use it. Raises `InputError`
        where there is no place for it; the file is gone then. `avatar_id` is what another server has called it.
        """
        avatar = StoredAvatar(avatar_id or secrets.token_hex(8), replace(humanoid, glb=None), file, sender)
        try:
            size = 0 if file is None else file.stat().st_size
            self._uploads.add(avatar.id, avatar, size, sender.shares)
        except InputError:
            _remove(avatar)
            raise
        return avatar

    def _free_name(self, stem: str) -> str:
        """A name for addresses: letters, digits and dashes, no number like those of what was sent."""
        name = re.sub(r"[^a-z0-9]+", "-", stem.lower()).strip("-")[:_LONGEST_NAME] or "avatar"
        if re.fullmatch(r"[0-9a-f]{16}", name):
            name = f"avatar-{name}"
        taken = {STOCK} | {avatar.id for avatar in self.lasting()}
        return next(free for number in count(1) if (free := name if number == 1 else f"{name}-{number}") not in taken)

    def lasting(self) -> list[StoredAvatar]:
        """Those that nobody sent: they stay."""
        with self._lock:
            return list(self._kept.values())

    def _keep(self, avatar_id: str, humanoid: Humanoid) -> StoredAvatar:
        avatar = self._stored(avatar_id, humanoid)
        with self._lock:
            return self._kept.setdefault(avatar_id, avatar)

    def _stored(self, avatar_id: str, humanoid: Humanoid) -> StoredAvatar:
        if humanoid.glb is None:
            return StoredAvatar(avatar_id, humanoid, None)
        path = self.folder / f"{avatar_id}.glb"
        path.write_bytes(humanoid.glb)
        return StoredAvatar(avatar_id, replace(humanoid, glb=None), path)


def _remove(avatar: StoredAvatar) -> None:
    if avatar.glb is not None:
        avatar.glb.unlink(missing_ok=True)
