"""Whose turn it is to compile a kernel: of several processes that need it one does, and the others wait for what it
keeps.

A lock belongs to whoever holds it open, and ends with it. Nobody waits for ever: a kernel is compiled while those that
it calls are, and never the other way round, so who waits and who is waited for make no circle; and who has waited long
compiles it too, which costs time and nothing else. Where files cannot be locked everybody compiles what it needs.
"""

import contextlib
import os
import time
from pathlib import Path

_LONG = 300.0  # seconds, some times as long as the largest kernel takes
_OFTEN = 0.02  # seconds between two looks


class Turn:
    """The turn to compile one kernel, taken by a file of its own."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._held: int | None = None  # the open file
        self._times = 0  # that it was taken, and not given up yet: a kernel may call itself for other types

    def take(self) -> None:
        """Wait until no other process compiles the kernel."""
        self._times += 1
        if self._held is None:
            with contextlib.suppress(OSError, ImportError):
                self._held = _locked(self._file)

    def give_up(self) -> None:
        """Let others have it."""
        self._times = max(self._times - 1, 0)
        if self._held is None or self._times:
            return
        with contextlib.suppress(OSError):
            self._file.unlink(missing_ok=True)
        os.close(self._held)
        self._held = None


def _locked(path: Path) -> int | None:
    """An open file at a path, locked as soon as nobody else has it locked; None after a long time."""
    import fcntl  # there is none on Windows

    until = time.monotonic() + _LONG
    while time.monotonic() < until:
        file = os.open(path, os.O_CREAT | os.O_RDWR | os.O_CLOEXEC)
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.fstat(file).st_ino == path.stat().st_ino:
                return file  # and not one that who had it locked has taken away since
        except (BlockingIOError, FileNotFoundError):
            pass  # somebody has it, or has just taken it away
        except OSError:
            os.close(file)
            raise  # files cannot be locked here
        os.close(file)
        time.sleep(_OFTEN)
    return None
