"""How the process keeps memory: with one heap for all its threads.

glibc gives every thread a heap of its own and keeps what is freed there for that thread. Sessions are made and plan in
changing threads, so each would hold what a session needs at most. Python's threads hardly ever ask for memory at once.

Kernels and libraries are some 150,000 objects that stay. Whenever Python looked for garbage among them all, every
thread would wait for 40 to 70 ms.
"""

import ctypes
import gc

_M_ARENA_MAX = -8  # as in malloc.h


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
