"""A run in a notebook: plays where it stands, without a server."""

import html
from pathlib import Path

from elbowroom.control.recordings.recording import Recording
from elbowroom.errors import InputError
from elbowroom.formats.file_bytes import check_ending
from elbowroom.server.standalone.page import page_of_recording

_SMALLEST, _LARGEST = 120, 4000  # pixels


class NotebookRun:
    """What `show` gives: a notebook draws it; elsewhere it can be saved."""

    def __init__(self, page: str, height: int, notes: tuple[str, ...]) -> None:
        self.html = page  # the whole page
        self.height = height  # pixels
        self.notes = notes  # what there is to say about it

    def _repr_html_(self) -> str:
        """The page in a frame of its own, with nothing to fetch."""
        style = f"width:100%;height:{self.height}px;border:0;border-radius:8px"
        return f'<iframe title="Elbowroom" style="{style}" srcdoc="{html.escape(self.html, quote=True)}"></iframe>'

    def save(self, path: str | Path) -> Path:
        """Write the page as a file (`.html`); raises `InputError` where it cannot be written."""
        check_ending(path, "a page", ".html", ".htm")
        try:
            Path(path).write_text(self.html, "utf-8")
        except OSError as error:
            raise InputError(f"{path}: cannot be written ({error.strerror})") from None
        return Path(path)


def show(run: str | Path | Recording, avatar: str | Path | None = None, height: int = 480) -> NotebookRun:
    """A recording (`.elbow`), to be shown at the end of a notebook's cell, offline.

    `avatar` is the file of the avatar, where it is not the stock one; `height` is in pixels. Raises `InputError`.
    """
    if not _SMALLEST <= height <= _LARGEST:
        raise InputError(f"height: {height} pixels, allowed are {_SMALLEST} to {_LARGEST}")
    recording = run if isinstance(run, Recording) else Recording(run)
    humanoid = recording.header.avatar.load(None if avatar is None else Path(avatar))
    page, notes = page_of_recording(recording, humanoid, recording.path.name)
    return NotebookRun(page, height, notes)
