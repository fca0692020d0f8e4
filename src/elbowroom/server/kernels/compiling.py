"""Compiles every kernel that a live session uses, before anybody waits for it: in processes of their own.

`python -m elbowroom.server.kernels.compiling` uses what is named to it, a piece a line, and prints each kernel's name
as its turn comes, and an empty line after each piece. A compiler takes 200 MB that a server should not carry for the
rest of its life, and holds a lock: so there are several, each given another piece as soon as it is done with one. Most
pieces need some of the same kernels: those are compiled by who comes first (`kernel_turns.py`), and read from disk by
the others.
"""

import gc
import os
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress
from dataclasses import replace
from threading import Lock

from elbowroom.experiment.rehearsal import REHEARSALS
from elbowroom.planning.names import EXACT, FIGURE6
from elbowroom.server.kernels.kernel_cache import cache_folders, is_warm, mark_warm
from elbowroom.server.kernels.warmup import Report, listening, walk_and_stand
from elbowroom.server.stores.library import Library

_MOST = 4  # processes: each takes most of a gigabyte, and more would wait for each other
# Walks with a planner, in a scene where they meet what they do not in the open.
_WALKED = [(planner, scene) for scene in ("a", "c", "doorway", "traffic") for planner in (FIGURE6, EXACT)]
PIECES = (*REHEARSALS, *(f"{planner} {scene}" for planner, scene in _WALKED))  # what takes longest comes first


def compile_apart(report: Report) -> None:
    """Compile in processes of their own, unless that was done for the present sources, or cannot be kept.

    Should one of them fail, nothing is lost: what it did not compile is compiled where it is needed.
    """
    if cache_folders() and not is_warm() and compile_all(report, os.environ):
        mark_warm()


def processes() -> int:
    """How many compile at once: as many as there are processors for this program, but for a few at most."""
    there = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(min(there, _MOST), 1)


def compile_all(report: Report, environment: Mapping[str, str]) -> bool:
    """Compile all pieces, as many at once as there are `processes`; whether all went well.

    `report(kernel, number)` hears of each kernel once, when the first process begins with it.
    """
    known: set[str] = set()
    lock, pieces = Lock(), deque(PIECES)

    def hear(kernel: str) -> None:
        with lock:
            if kernel not in known:
                report(kernel, len(known))
                known.add(kernel)

    with ThreadPoolExecutor(processes()) as pool:
        return all(list(pool.map(lambda _: _compile_some(pieces, hear, environment), range(processes()))))


def _compile_some(pieces: deque[str], hear: Callable[[str], None], environment: Mapping[str, str]) -> bool:
    """Have another process compile one piece after the other, as long as any are left, and tell the names it prints."""
    with subprocess.Popen(
        command(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        env=dict(environment),
    ) as compiler:  # fmt: skip
        while pieces and _compile_one(compiler, pieces.popleft(), hear):
            pass
        assert compiler.stdin is not None
        with suppress(BrokenPipeError):
            compiler.stdin.close()
    return compiler.returncode == 0


def _compile_one(compiler: subprocess.Popen[str], piece: str, hear: Callable[[str], None]) -> bool:
    """Have a process compile a piece; whether it did to the end."""
    assert compiler.stdin is not None
    assert compiler.stdout is not None
    try:
        compiler.stdin.write(f"{piece}\n")
        compiler.stdin.flush()
    except BrokenPipeError:
        return False
    for line in compiler.stdout:
        if not line.strip():
            return True
        hear(line.strip())
    return False


def command() -> list[str]:
    """The command line of a process that compiles."""
    return [sys.executable, "-m", "elbowroom.server.kernels.compiling"]


def compile_piece(piece: str, library: Library) -> None:
    """Compile what is needed for a piece, by using it."""
    if piece in REHEARSALS:
        REHEARSALS[piece](library.avatars.get(library.avatar).humanoid)
    else:
        planner, scene = piece.split(" ", 1)
        walk_and_stand(replace(library, scene=scene), planner)


def _collect_seldom() -> None:
    """Look for garbage seldom: a compiler keeps most of what it makes, and looking takes a tenth of its time."""
    gc.freeze()
    gc.set_threshold(100_000, 50, 100)


if __name__ == "__main__":
    _collect_seldom()
    with listening(lambda kernel, number: print(kernel, flush=True)), closing(Library.open()) as every:  # noqa: ARG005
        for line in sys.stdin:
            compile_piece(line.strip(), every)
            print(flush=True)
