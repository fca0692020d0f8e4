"""How the process keeps memory: with one heap for all its threads.

glibc gives every thread a heap of its own and keeps what is freed there for that thread. Sessions are made and plan in
changing threads, so each would hold what a session needs at most. Python's threads hardly ever ask for memory at once.

What is freed in it lies between what is still in use, and stays with the process until it is handed back: so a server
would be as large for ever as its sessions were at most. Handing it back takes 5 to 10 ms, in which threads that ask for
memory wait: less than a frame, so it is done while sessions go on, seldom.

Kernels and libraries are some 150,000 objects that stay. Whenever Python looked for garbage among them all, every
thread would wait for 40 to 70 ms.
"""

import ctypes
import gc
import time
from collections.abc import Callable

_M_ARENA_MAX = -8  # as in malloc.h
_SELDOM = 20.0  # seconds


def share_one_heap() -> bool:
    """Ask the C library for it, before there are other threads; false where it has nothing of the kind."""
    try:
        return bool(ctypes.CDLL(None).mallopt(_M_ARENA_MAX, 1))
    except (OSError, AttributeError, TypeError):  # no library to look in, or none of glibc's
        return False


def settle() -> bool:
    """Take all that is loaded for lasting, and hand what was freed back to the system.

    False where the C library cannot hand it back, or had nothing.
    """
    gc.freeze()
    return hand_back()


def hand_back() -> bool:
    """Hand what was freed back to the system; false as for `settle`."""
    try:
        return bool(ctypes.CDLL(None).malloc_trim(0))
    except (OSError, AttributeError, TypeError):
        return False


class HandingBack:
    """Hands back what ended sessions have freed, not more often than every 20 seconds while others go on."""

    def __init__(self, clock: Callable[[], float] = time.monotonic, hand: Callable[[], object] = hand_back) -> None:
        self._clock, self._hand = clock, hand
        self._last = -_SELDOM

    def ended(self, left: int) -> None:
        """A session has ended, and so many are left; may take some milliseconds."""
        now = self._clock()
        if left == 0 or now - self._last >= _SELDOM:
            self._last = now
            self._hand()
