"""What a compiled kernel was made of: its own file, and all files of the package that this one imports, and so on.

Numba keeps compiled kernels on disk and compiles them anew when their own file has changed. But the kernels and the
constants that they take from other files are compiled into them, and those it does not look at.
"""

import hashlib
import re
from functools import lru_cache
from pathlib import Path

PACKAGE = Path(__file__).parent
_IMPORT = re.compile(r"^from (\w+(?:\.\w+)*) import (\(.*?\)|[^\n]*)|^import (\w+(?:\.\w+)*)", re.MULTILINE | re.DOTALL)


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
