"""A folder that one call writes to is written to by no other meanwhile."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from elbowroom.errors import InputError


@contextmanager
def in_use(folder: Path) -> Iterator[None]:
    """Have a folder for oneself, until one ends; raises `InputError` where another call has it. On Windows nothing."""
    try:
        import fcntl  # there is none on Windows
    except ImportError:
        yield
        return
    place = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(place, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            told = f"{folder}: another call is writing to it; wait for that or choose another folder"
            raise InputError(told) from None
        yield
    finally:
        os.close(place)
