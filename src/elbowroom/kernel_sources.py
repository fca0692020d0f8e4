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
    for source in sorted(sources_of(file, package)):
        place = source.relative_to(package) if source.is_relative_to(package) else source.name
        told.update(f"{place} {_text_digest(source)}\n".encode())
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
    found: set[Path] = set()
    for module, names, plain in _IMPORT.findall(file.read_text("utf-8")):
        parts = (module or plain).split(".")
        if parts[0] != package.name:
            continue
        place = package.joinpath(*parts[1:])
        found.add(place.with_suffix(".py") if len(parts) > 1 else package / "__init__.py")
        found |= {place / f"{name}.py" for name in re.findall(r"\w+", names)}
        found.add(place / "__init__.py")
    return frozenset(path for path in found if path.is_file())


@lru_cache(maxsize=1024)
def _text_digest(file: Path) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()
