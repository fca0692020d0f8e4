"""Compiled kernels on disk, looked over before a command reads them: where they can lie, and whether they are whole.

Numba reads what it has kept as machine code, without a question: a flipped byte ends the process. So a list of their
checksums lies beside them. What differs from the list is removed and compiled anew; what is not on it yet is added. A
file of the same size and times as on the list is taken for the same.
"""

import contextlib
import json
import os
import shutil
import tempfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

PACKAGE = Path(__file__).parents[1]
NEEDED = 100 * 2**20  # bytes of free space: all kernels take a third of that
_LIST = "elbowroom-kernels.sums"
_VARIABLE = "NUMBA_CACHE_DIR"


@dataclass(frozen=True)
class Place:
    """A folder, with all that lies below it, where kernels are kept."""

    root: Path

    def files(self) -> Iterator[Path]:
        """What Numba keeps: indices and machine code."""
        for folder, _, names in os.walk(self.root):
            yield from (Path(folder, name) for name in names if name.endswith((".nbi", ".nbc")))

    def check(self) -> list[Path]:
        """Remove what is not as it was when it was noted down, and note down what is new; what was removed."""
        told, now = self._read(), {}
        removed: list[Path] = []
        for file in self.files():
            name = file.relative_to(self.root).as_posix()
            before, seen = told.get(name), _seen(file)
            if seen is None:
                continue
            if before is not None and before[:3] != seen and before[3] != _sum(file):
                removed.append(file)
                file.unlink(missing_ok=True)
            else:
                now[name] = before if before is not None and before[:3] == seen else [*seen, _sum(file)]
        if now != told:
            self._write(now)
        return removed

    def note(self) -> None:
        """Note down what is there now: what this process, or another one meanwhile, has compiled."""
        told, now = self._read(), {}
        for file in self.files():
            name, seen = file.relative_to(self.root).as_posix(), _seen(file)
            if seen is not None:
                before = told.get(name)
                now[name] = before if before is not None and before[:3] == seen else [*seen, _sum(file)]
        if now != told:
            self._write(now)

    def _read(self) -> dict[str, list[int]]:
        try:
            told = json.loads((self._folder() / _LIST).read_text("ascii"))
            return {str(name): [int(number) for number in numbers] for name, numbers in told.items()}
        except (OSError, ValueError, TypeError, AttributeError):
            return {}

    def _write(self, told: dict[str, list[int]]) -> None:
        file = self._folder() / _LIST
        new = file.with_suffix(f".{os.getpid()}")
        try:
            new.write_text(json.dumps(told), "ascii")
            new.replace(file)
        except OSError:
            with contextlib.suppress(OSError):
                new.unlink(missing_ok=True)

    def _folder(self) -> Path:
        """Where the list lies; in the package among its other compiled files."""
        return self.root / "__pycache__" if self.root == PACKAGE else self.root


def _seen(file: Path) -> list[int] | None:
    """Size and times; None if it is gone."""
    try:
        found = file.stat()
    except OSError:
        return None
    return [found.st_size, found.st_mtime_ns, found.st_ctime_ns]


def _sum(file: Path) -> int:
    try:
        return zlib.crc32(file.read_bytes())
    except OSError:
        return -1


def places() -> list[Place]:
    """Where kernels may lie: in `NUMBA_CACHE_DIR` alone if that is set."""
    chosen = os.environ.get(_VARIABLE)
    if chosen:
        return [Place(Path(chosen))]
    user = _users_own()
    return [Place(PACKAGE), *([Place(user)] if user is not None else [])]


def find_place() -> str | None:
    """See to it that kernels can be kept, elsewhere if need be: before Numba is imported. What to tell the user, if so.

    Children of this process keep theirs in the same place.
    """
    wanted = places()
    if any(_has_room(place.root) for place in wanted):
        if len(wanted) > 1 and not _has_room(wanted[0].root / "__pycache__"):
            os.environ[_VARIABLE] = str(wanted[1].root)  # the package's own folder is full, if not read-only
        return None
    said = " nor ".join(str(place.root) for place in wanted)
    private = _private_folder()
    if private is None or not _has_room(private):
        os.environ[_VARIABLE] = os.devnull
        return f"compiled kernels can be kept neither in {said}: every start compiles them anew; set {_VARIABLE}"
    os.environ[_VARIABLE] = str(private)
    return f"compiled kernels can be kept neither in {said}: they go to {private}; set {_VARIABLE} for another place"


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
