"""Compiled kernels kept on disk, each with a checksum that whoever writes it writes beside it.

Numba reads what it has kept as machine code, without a question: a flipped byte ends the process. So beside a kernel's
files lies `NAME.sum`, with their checksums. Who writes a kernel takes the old one away first and writes the new one
last; who reads a kernel compares it first. What has no checksum yet was written by somebody who was ended meanwhile: it
is new, and not damaged. What is damaged is removed, and compiled anew by whoever needs it.

A disk that is full costs time and nothing else: what cannot be kept is compiled again the next time.
"""

import contextlib
import itertools
import json
import os
import sys
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from elbowroom.kernel_bitcode import Bitcode
from elbowroom.kernel_turns import Turn

_UNREADABLE = (OSError, ValueError, TypeError)
_NO_CODE = "no compiled object"  # in Numba's words


class KeptKernel:
    """The cache of one kernel, as Numba's dispatcher asks it: all that it does not know here is Numba's own answer."""

    def __init__(self, cache: Any, folder: Path, name: str) -> None:
        """`cache` is Numba's own, which keeps files in `folder` whose names begin with `name`."""
        self._cache, self._folder, self._name = cache, folder, name
        self._turn = Turn(folder / f"{name}.lock")

    def __getattr__(self, name: str) -> Any:
        return getattr(self._cache, name)

    def load_overload(self, signature: Any, context: Any) -> Any:
        """The machine code for a signature; None if there is none, or none that is whole: then it is compiled here.

        Where another process is compiling it, that is waited for.
        """
        found = self._load(signature, context)
        if found is None:
            self._turn.take()
            found = self._load(signature, context)
            if found is not None:
                self._turn.give_up()
        return found

    def _load(self, signature: Any, context: Any) -> Any:
        """The machine code for a signature; None if there is none, or none that is whole."""
        known = _sum_file(self._folder, self._name).exists()
        if is_whole(self._folder, self._name):
            with contextlib.suppress(Exception):  # damaged where nothing is known of it: unpickling may raise anything
                found = self._cache.load_overload(signature, context)
                if found is None:
                    return None
                if Bitcode(self._folder, self._name, signature).leave_unread(found):
                    if not known:
                        note(self._folder, self._name)
                    return found
        forget(self._folder, self._name)
        return None

    def save_overload(self, signature: Any, code: Any) -> None:
        """Keep machine code, if there is room for it.

        Who is told to end while LLVM makes machine code hears of it in a callback, which lets no exception through: the
        code is missing then. What Numba says to that is raised as the `KeyboardInterrupt` that it is.
        """
        try:
            with contextlib.suppress(OSError):
                _sum_file(self._folder, self._name).unlink(missing_ok=True)
                with Bitcode(self._folder, self._name, signature).written_apart(code):
                    self._cache.save_overload(signature, code)
                note(self._folder, self._name)
        except RuntimeError as error:
            if _NO_CODE not in str(error):
                raise
            raise KeyboardInterrupt from error
        finally:
            self._turn.give_up()


def name_of(file: Path, qualified_name: str, line: int) -> str:
    """How Numba begins the names of a kernel's files: FILE.FUNCTION-LINE.pyVERSION."""
    plain = qualified_name.replace("<", "").replace(">", "")
    return f"{file.stem}.{plain}-{line}.py{sys.version_info[0]}{sys.version_info[1]}{sys.abiflags}"


def is_whole(folder: Path, name: str) -> bool:
    """Whether a kernel's files are as they were written, as far as that is known."""
    try:
        told = json.loads(_sum_file(folder, name).read_text("ascii"))
    except FileNotFoundError:
        return True
    except _UNREADABLE:
        return False
    return bool(told == _sums(folder, name))


def note(folder: Path, name: str) -> None:
    """Write down the checksums of a kernel's files."""
    file = _sum_file(folder, name)
    new = file.with_suffix(f".{os.getpid()}")
    try:
        new.write_text(json.dumps(_sums(folder, name)), "ascii")
        new.replace(file)
    except OSError:
        with contextlib.suppress(OSError):
            new.unlink(missing_ok=True)


def forget(folder: Path, name: str) -> None:
    """Remove a kernel's files, the index first and what is known of them last."""
    with contextlib.suppress(OSError):
        for file in (*_files(folder, name), _sum_file(folder, name)):
            file.unlink(missing_ok=True)


def _files(folder: Path, name: str) -> Iterator[Path]:
    """The index, and the bitcode and the machine code of each signature."""
    yield folder / f"{name}.nbi"
    yield from sorted(folder.glob(f"{name}.*.bc"))
    for number in itertools.count(1):
        file = folder / f"{name}.{number}.nbc"
        if not file.exists():
            return
        yield file


def _sums(folder: Path, name: str) -> dict[str, int]:
    sums = {}
    for file in _files(folder, name):
        with contextlib.suppress(OSError):
            sums[file.name] = zlib.crc32(file.read_bytes())
    return sums


def _sum_file(folder: Path, name: str) -> Path:
    return folder / f"{name}.sum"
