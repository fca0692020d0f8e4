"""The motion clips that a server knows: those named on the command line, and a few files dropped on the page."""

import secrets
import threading
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from pathlib import Path

from elbowroom.clips.clip import Clip
from elbowroom.clips.files import MotionFile
from elbowroom.errors import InputError
from elbowroom.server.apart.jobs import MAX_CLIPS
from elbowroom.server.apart.process import run_apart
from elbowroom.server.entrance.page_key import Sender
from elbowroom.server.schema.menus import ClipChoice
from elbowroom.server.stores.recent import Capacity, RecentlySent

MAX_FILES = 8  # dropped on the page; the one that was used least recently goes first, what a session shows stays
MAX_EACH = 4  # of one machine that is not this one
MAX_UPLOADED = 256 * 2**20  # bytes of all of them on disk


@dataclass(frozen=True)
class SentMotions:
    """A motion file that a client sent."""

    path: Path
    name: str  # that the client gave it
    format: str  # "BVH", "glTF 2.0", ...
    clips: tuple[str, ...]
    sender: Sender  # only its page's menu shows them


class StoredClip:
    """A clip in the menu; it is read when it is first shown."""

    def __init__(self, title: str, file: MotionFile | SentMotions, name: str, clip_id: str = "") -> None:
        self.id = clip_id or secrets.token_hex(8)
        self.title, self.name = title, name
        self._file = file
        self._clip: Clip | None = None

    @property
    def clip(self) -> Clip:
        """The motion; raises `InputError`. What a client sent has to be read first: `read`."""
        if self._clip is None:
            if isinstance(self._file, SentMotions):
                raise InputError(f"{self.title} is not read yet")
            self._clip = self._file.clip(self.name)
        return self._clip

    async def read(self) -> None:
        """Read what a client sent, in a process of its own; raises as `run_apart`."""
        if self._clip is None and isinstance(self._file, SentMotions):
            file = self._file
            clip: Clip = await run_apart("read_clip", file.name, str(file.path), file.name, self.name)
            self._clip = clip


class ClipStore:
    """Clips by id; may be used from several threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._kept: dict[str, StoredClip] = {}
        capacity = Capacity(MAX_FILES, MAX_EACH, MAX_UPLOADED)
        self._uploads = RecentlySent[tuple[SentMotions, list[StoredClip]]](lambda: capacity, _remove)

    def choices(self, owner: str = "") -> list[ClipChoice]:
        """What the menu offers to the page with this key."""
        with self._lock:
            known = list(self._kept.values())
        known += [clip for sent, clips in self._uploads.items() if owner and sent.sender.key == owner for clip in clips]
        return [ClipChoice(clip.id, clip.title) for clip in known]

    def check(self, clip_id: str) -> None:
        """Raises `InputError` if there is no clip with this id."""
        self.get(clip_id)

    def get(self, clip_id: str) -> StoredClip:
        """The clip with this id; raises `InputError` if there is none."""
        if clip_id in self._kept:
            return self._kept[clip_id]
        for sent, clips in self._uploads.items():
            found = next((clip for clip in clips if clip.id == clip_id), None)
            if found is not None:
                self._uploads.get(sent.path.name)
                return found
        raise InputError(f"clip {clip_id[:40]!r} is not known here (any more); drop its file on the page again")

    def hold(self, user: Hashable, *clip_ids: str) -> None:
        """These are the clips that a session shows from now on."""
        files = [sent.path.name for sent, clips in self._uploads.items() if any(c.id in clip_ids for c in clips)]
        self._uploads.hold(user, *files)

    def files(self) -> set[Path]:
        """The files of what was sent."""
        return {sent.path for sent, _ in self._uploads.items()}

    def add_file(self, file: MotionFile, only: str | None = None) -> list[StoredClip]:
        """Keep the clips of a file for good, or one of them; raises `InputError` if the first cannot be shown."""
        names = [name for name in file.clips if only in (None, name)][:MAX_CLIPS]
        if not names:
            file.clip(only)
        short = file.format == "BVH" or len(file.clips) == 1
        clips = [StoredClip(file.name if short else name, file, name) for name in names]
        _ = clips[0].clip
        with self._lock:
            self._kept |= {clip.id: clip for clip in clips}
        return clips

    def add_upload(self, sent: SentMotions, ids: Sequence[str] = ()) -> list[StoredClip]:
        """Keep the clips of a file that was sent, and the file with them.

        Menus offer them to the page that sent it alone; whoever is told an id can use it. Raises `InputError`
        where there is no place for it; the file is gone then. `ids` are what another server has called them.
        """
        short = sent.format == "BVH" or len(sent.clips) == 1
        known = ids or [""] * len(sent.clips)
        clips = [
            StoredClip(sent.name if short else name, sent, name, clip_id)
            for name, clip_id in zip(sent.clips, known, strict=True)
        ]
        try:
            self._uploads.add(sent.path.name, (sent, clips), sent.path.stat().st_size, sent.sender.shares)
        except InputError:
            sent.path.unlink(missing_ok=True)
            raise
        return clips


def _remove(upload: tuple[SentMotions, list[StoredClip]]) -> None:
    upload[0].path.unlink(missing_ok=True)
