"""Where compiled kernels can be kept on disk: found out before Numba is imported, for a command and its children."""

import os
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path

PACKAGE = Path(__file__).parents[2]
NEEDED = 100 * 2**20  # bytes of free space: all kernels take a third of that
_VARIABLE = "NUMBA_CACHE_DIR"


def places() -> list[Path]:
    """Where kernels may lie: in `NUMBA_CACHE_DIR` alone if that is set."""
    chosen = os.environ.get(_VARIABLE)
    if chosen:
        return [Path(chosen)]
    user = _users_own()
    return [PACKAGE, *([user] if user is not None else [])]


def find_place() -> str | None:
    """See to it that kernels can be kept, elsewhere if need be: before Numba is imported. What to tell the user, if so.

    Children of this process keep theirs in the same place.
    """
    wanted = places()
    if any(_has_room(place) for place in wanted):
        if len(wanted) > 1 and not _has_room(wanted[0] / "__pycache__"):
            os.environ[_VARIABLE] = str(wanted[1])  # the package's own folder is full, if not read-only
        return None
    said = f"compiled kernels {_cannot_lie_in(wanted)}"
    private = _private_folder()
    if private is None or not _has_room(private):
        os.environ[_VARIABLE] = os.devnull
        return f"{said}: every start compiles them anew; set {_VARIABLE}"
    os.environ[_VARIABLE] = str(private)
    return f"{said}: they go to {private}; set {_VARIABLE} for another place"


def _cannot_lie_in(places: Sequence[Path]) -> str:
    if len(places) == 1:
        return f"cannot be kept in {places[0]}"
    return "can be kept neither " + " nor ".join(f"in {place}" for place in places)


def _has_room(folder: Path) -> bool:
    """Whether files can be made in a folder, which is made if need be, and there is space for all kernels."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return shutil.disk_usage(folder).free >= NEEDED
    except OSError:
        return False


def _users_own() -> Path | None:
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser()) / "elbowroom" / "kernels"
    except RuntimeError:  # there is no home
        return None


def _private_folder() -> Path | None:
    """A folder for temporary files that is this user's alone: kernels of others would be run as they are."""
    user = os.getuid() if hasattr(os, "getuid") else 0
    folder = Path(tempfile.gettempdir()) / f"elbowroom-kernels-{user}"
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        found = folder.lstat()
    except OSError:
        return None
    own = not folder.is_symlink() and getattr(found, "st_uid", user) == user and found.st_mode & 0o077 == 0
    return folder if own or os.name == "nt" else None
