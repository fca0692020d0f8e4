"""How much a process for work on something from outside may take, and how it keeps itself to that."""

import contextlib
import json
import os
import sys
import threading
from dataclasses import asdict, dataclass

_MIB = 2**20
_LIBRARIES = 1024 * _MIB  # bytes of address space that their files may fill


@dataclass(frozen=True)
class Bounds:
    """Limits of one piece of work. A system without such limits for a process keeps to the time and the answer only."""

    memory: int = 1024 * _MIB  # bytes of its own, besides the libraries' files
    processor: int = 60  # seconds of processor time
    wall: float = 120.0  # seconds by the clock
    answer: int = 48 * _MIB  # bytes
    written: int = 160 * _MIB  # bytes in a file

    def to_text(self) -> str:
        """For a command line."""
        return json.dumps(asdict(self))

    @classmethod
    def from_text(cls, text: str) -> "Bounds":
        """What `to_text` wrote."""
        return cls(**json.loads(text))


def keep_to(bounds: Bounds) -> None:
    """Bind this process for the rest of its life; behind all others, where processor time is short."""
    with contextlib.suppress(OSError, AttributeError):
        os.nice(5)  # a third of a share: with 10 nothing would be read while all processors are busy
    if sys.platform == "win32":
        return
    import resource

    limits = {
        "RLIMIT_DATA": (bounds.memory, bounds.memory),
        "RLIMIT_AS": (bounds.memory + _LIBRARIES, bounds.memory + _LIBRARIES),
        "RLIMIT_CPU": (bounds.processor, bounds.processor + 2),
        "RLIMIT_FSIZE": (bounds.written, bounds.written),
        "RLIMIT_CORE": (0, 0),
    }
    for name, (soft, hard) in limits.items():
        with contextlib.suppress(OSError, ValueError, AttributeError):
            resource.setrlimit(getattr(resource, name), (soft, hard))


def end_with_parent() -> None:
    """End this process as soon as nobody holds the other end of its standard input."""

    def wait() -> None:
        with contextlib.suppress(OSError):
            while os.read(0, 1024):
                pass
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()
