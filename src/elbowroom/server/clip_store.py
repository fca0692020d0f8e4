"""The motion clips that a server knows: those named on the command line, and a few files dropped on the page."""

import secrets
import threading
from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property

from elbowroom.clips.clip import Clip
from elbowroom.clips.files import MotionFile, parse_motion
from elbowroom.errors import InputError
from elbowroom.server.schema.menus import ClipChoice

MAX_FILES = 8  # dropped on the page; the one that was used least recently goes first
MAX_OFFERED = 200  # clips of one file


@dataclass(frozen=True, eq=False)
class StoredClip:
    """A clip in the menu; it is read when it is first shown."""

    id: str
    title: str
    file: MotionFile
    name: str
    owner: str = ""  # key of the page that sent it: only there the menu shows it

    @cached_property
    def clip(self) -> Clip:
        """The motion; raises `InputError`."""
        return self.file.clip(self.name)


class ClipStore:
    """Clips by id; may be used from several threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._kept: dict[str, StoredClip] = {}
        self._uploads: OrderedDict[str, list[StoredClip]] = OrderedDict()

    def choices(self, owner: str = "") -> list[ClipChoice]:
        """What the menu offers to the page with this key."""
        with self._lock:
            sent = [clip for clips in self._uploads.values() for clip in clips]
            known = [*self._kept.values(), *(clip for clip in sent if owner and clip.owner == owner)]
        return [ClipChoice(clip.id, clip.title) for clip in known]

    def check(self, clip_id: str) -> None:
        """Raises `InputError` if there is no clip with this id."""
        self.get(clip_id)

    def get(self, clip_id: str) -> StoredClip:
        """The clip with this id; raises `InputError` if there is none."""
        with self._lock:
            for file, clips in self._uploads.items():
                found = next((clip for clip in clips if clip.id == clip_id), None)
                if found is not None:
                    self._uploads.move_to_end(file)
                    return found
            if clip_id in self._kept:
                return self._kept[clip_id]
        raise InputError(f"clip {clip_id[:40]!r} is not known here (any more); drop its file on the page again")

    def add_file(self, file: MotionFile, only: str | None = None) -> list[StoredClip]:
        """Keep the clips of a file for good, or one of them; raises `InputError` if the first cannot be shown."""
        clips = _stored(file, only)
        with self._lock:
            self._kept |= {clip.id: clip for clip in clips}
        return clips

    def add_upload(self, data: bytes, name: str, owner: str = "") -> list[StoredClip]:
        """Keep the clips of a file that a page has sent as bytes; raises `InputError` if it holds no humanoid's motion.

        Menus offer them to that page alone; whoever is told an id can use it.
        """
        clips = _stored(parse_motion(data, name), None, owner)
        with self._lock:
            self._uploads[clips[0].id] = clips
            while len(self._uploads) > MAX_FILES:
                self._uploads.popitem(last=False)
        return clips


def _stored(file: MotionFile, only: str | None, owner: str = "") -> list[StoredClip]:
    names = [name for name in file.clips if only in (None, name)][:MAX_OFFERED]
    if not names:
        file.clip(only)
    short = file.format == "BVH" or len(file.clips) == 1
    clips = [StoredClip(secrets.token_hex(8), file.name if short else name, file, name, owner) for name in names]
    _ = clips[0].clip
    return clips
