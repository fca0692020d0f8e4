"""Where compiled kernels are kept on disk, and when what lies there is void.

Numba keeps a compiled kernel until the kernel's own file changes. But the kernels and the constants that it takes from
other files are compiled into it, and those Numba does not look at. So what is kept is stamped with a digest of the
kernel's file and of all files of the package that this one imports, directly or not. The place and the stamp are
handed to Numba by a *cache locator*, as its documentation of `NUMBA_CACHE_LOCATOR_CLASSES` describes one.
"""

import hashlib
import os
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

import numba

PACKAGE = Path(__file__).parent
_IMPORT = re.compile(r"^from (\w+(?:\.\w+)*) import (\(.*?\)|[^\n]*)|^import (\w+(?:\.\w+)*)", re.MULTILINE | re.DOTALL)


class SourcesLocator:
    """Numba's cache locator for one kernel: a folder, and a stamp of all sources that are compiled into it."""

    def __init__(self, kernel: Any, file: str, folder: Path) -> None:
        self._line, self._file, self._folder = kernel.__code__.co_firstlineno, Path(file), folder

    @classmethod
    def from_function(cls, kernel: Any, file: str) -> "SourcesLocator | None":
        """The locator of a function that is defined in `file`; None where nothing can be kept."""
        folder = cache_folder(Path(file))
        return None if folder is None else cls(kernel, file, folder)

    def ensure_cache_path(self) -> None:
        """Make the folder."""
        self._folder.mkdir(parents=True, exist_ok=True)

    def get_cache_path(self) -> str:
        """The folder that the kernel is kept in."""
        return str(self._folder)

    def get_source_stamp(self) -> str:
        """What is kept under another stamp is void."""
        return digest_of(self._file)

    def get_disambiguator(self) -> str:
        """Tells functions of one name in one file apart."""
        return str(self._line)


@contextmanager
def cached_by_sources() -> Iterator[bool]:
    """Functions that are decorated meanwhile are kept by a `SourcesLocator`."""
    config: Any = numba.config
    before = config.CACHE_LOCATOR_CLASSES
    config.CACHE_LOCATOR_CLASSES = f"{__name__}.{SourcesLocator.__name__}"
    try:
        yield True
    finally:
        config.CACHE_LOCATOR_CLASSES = before


def cache_folder(file: Path) -> Path | None:
    """Where the kernels of a source file are kept; None if no place can be written to.

    In `NUMBA_CACHE_DIR`, if that is set, by the digest of the sources: whoever has the same ones finds them there. Else
    in `__pycache__` beside the file, else in the user's own cache.
    """
    config: Any = numba.config
    if config.CACHE_DIR:
        return _first_writable((Path(config.CACHE_DIR) / f"{file.stem}_{digest_of(file)[:32]}",))
    folders = [file.parent / "__pycache__"]
    beside = f"{file.parent.name}_{hashlib.sha256(str(file.parent.resolve()).encode()).hexdigest()[:32]}"
    with suppress(RuntimeError):  # there is no home
        user = Path(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser())
        folders.append(user / "elbowroom" / "kernels" / beside)
    return _first_writable(tuple(folders))


@lru_cache(maxsize=1024)
def _first_writable(folders: tuple[Path, ...]) -> Path | None:
    return next((folder for folder in folders if _is_writable(folder)), None)


def _is_writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


@lru_cache(maxsize=1024)
def digest_of(file: Path, package: Path = PACKAGE) -> str:
    """A digest of all sources that a file of `package` depends on."""
    told = hashlib.sha256()
    for line in sorted(_line(source, package) for source in sources_of(file, package)):
        told.update(line)
    return told.hexdigest()


def sources_of(file: Path, package: Path = PACKAGE) -> set[Path]:
    """The file itself and those of `package` that it imports, directly or not."""
    found, waiting = {file}, [file]
    while waiting:
        fresh = _imported(waiting.pop(), package) - found
        found |= fresh
        waiting.extend(fresh)
    return found


@lru_cache(maxsize=1024)
def _imported(file: Path, package: Path) -> frozenset[Path]:
    found: set[str] = set()
    for module, names, plain in _IMPORT.findall(file.read_text("utf-8")):
        parts = (module or plain).split(".")
        if parts[0] != package.name:
            continue
        place = "/".join(parts[1:])
        found |= {f"{place}.py", f"{place}/__init__.py"}
        found |= {f"{place}/{name}.py" for name in re.findall(r"\w+", names)}
    return frozenset(path for path in (_file(place, package) for place in found) if path is not None)


@lru_cache(maxsize=4096)
def _file(place: str, package: Path) -> Path | None:
    """The file at a place in the package, if there is one."""
    path = package / place.removeprefix("/")
    return path if path.is_file() else None


@lru_cache(maxsize=1024)
def _line(file: Path, package: Path) -> bytes:
    """What a digest is told of one file."""
    place = file.relative_to(package) if file.is_relative_to(package) else file.name
    return f"{place} {hashlib.sha256(file.read_bytes()).hexdigest()}\n".encode()
