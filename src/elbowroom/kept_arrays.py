"""Arrays kept on disk by what they were made of: so a place that was opened before opens at once.

What is kept carries a digest of its content and of the sources that make it, so it is never out of date; who opens
another place, or has another version, finds nothing. The folder holds so much at most: what was not used for longest
goes. Files are written whole and put in place at once; what cannot be read is made anew, as if it had not been kept.
"""

import hashlib
import os
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.kernel_cache import digest_of

Array = NDArray[Any]
Arrays = Mapping[str, Array]

MOST_BYTES = 512 * 2**20
_NAME = "*.npz"
_UNREADABLE = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile)


def kept(source: str, made_of: Iterable[bytes | Array], make: Callable[[], Arrays]) -> Arrays:
    """What `make` returns, from disk if it was made of the same before; `source` is the file of who makes it."""
    path = _path(source, made_of)
    if path is None:
        return make()
    with suppress(*_UNREADABLE):
        found = _read(path)
        os.utime(path)
        return found
    made = make()
    if sum(array.nbytes for array in made.values()) <= MOST_BYTES // 4:
        with suppress(OSError):
            _write(path, made)
            bound(path.parent, MOST_BYTES)
    return made


def folder() -> Path | None:
    """Where they are kept; None where there is no home."""
    try:
        own = Path(os.environ.get("XDG_CACHE_HOME") or Path("~/.cache").expanduser())
    except RuntimeError:
        return None
    return own / "elbowroom" / "places"


def _path(source: str, made_of: Iterable[bytes | Array]) -> Path | None:
    where = folder()
    if where is None:
        return None
    name = hashlib.blake2b(digest_of(Path(source)).encode(), digest_size=20)
    for part in made_of:
        head = f"{part.dtype.str}{part.shape}" if isinstance(part, np.ndarray) else f"{len(part)}"
        name.update(head.encode())
        name.update(part.tobytes() if isinstance(part, np.ndarray) else part)
    return where / f"{Path(source).stem}_{name.hexdigest()}.npz"


def _read(path: Path) -> Arrays:
    with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
        return {name: file[name] for name in file.files}


def _write(path: Path, arrays: Arrays) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    number, name = tempfile.mkstemp(dir=path.parent, suffix=".part")
    try:
        with os.fdopen(number, "wb") as file:
            np.savez(file, **arrays)  # type: ignore[arg-type]  # NumPy's stub takes any name for one of its options
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def bound(where: Path, most: int) -> None:
    """Remove what was not used for longest, until the rest is not too much."""
    files = sorted(((file.stat().st_mtime, file.stat().st_size, file) for file in where.glob(_NAME)), reverse=True)
    total = 0
    for _, size, file in files:
        total += size
        if total > most:
            file.unlink(missing_ok=True)
