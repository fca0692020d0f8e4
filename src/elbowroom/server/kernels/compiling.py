"""Compiles every kernel that a live session uses, before anybody waits for it: in processes of their own.

`python -m elbowroom.server.kernels.compiling PART` compiles one part by using it and prints each kernel's name as its
turn comes. A compiler takes 200 MB that a server should not carry for the rest of its life, and holds a lock: so two
parts that need few of the same kernels are compiled side by side, and meet in the cache on disk.
"""

import gc
import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from dataclasses import replace
from threading import Lock

from elbowroom.experiment.rehearsal import (
    rehearse,
    rehearse_detour,
    rehearse_own_body,
    rehearse_product,
    rehearse_proof,
)
from elbowroom.planning.names import EXACT, FIGURE6
from elbowroom.server.kernels.kernel_cache import cache_folders, is_warm, mark_warm
from elbowroom.server.kernels.warmup import Report, listening, walk_and_stand
from elbowroom.server.stores.library import Library

PARTS = ("steps", "limbs")  # in this order where there is only one processor
_TELLING = ("a", "c", "doorway", "traffic")  # where the walk meets what it does not in the open: ways round, evasions


def compile_apart(report: Report) -> None:
    """Compile in processes of their own, unless that was done for the present sources, or cannot be kept.

    Should one of them fail, nothing is lost: what it did not compile is compiled where it is needed.
    """
    if cache_folders() and not is_warm() and compile_parts(report, os.environ):
        mark_warm()


def compile_parts(report: Report, environment: Mapping[str, str]) -> bool:
    """Compile all parts, as many at once as there are processors; whether all went well.

    `report(kernel, number)` hears of each kernel once, when the first process begins with it.
    """
    known: set[str] = set()
    lock = Lock()

    def hear(kernel: str) -> None:
        with lock:
            if kernel not in known:
                report(kernel, len(known))
                known.add(kernel)

    with ThreadPoolExecutor(min(len(PARTS), os.cpu_count() or 1)) as pool:
        return all(list(pool.map(lambda part: _follow(part, hear, environment), PARTS)))


def _follow(part: str, hear: Callable[[str], None], environment: Mapping[str, str]) -> bool:
    """Compile a part in another process, and tell the names that it prints."""
    with subprocess.Popen(
        command_for(part), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=dict(environment)
    ) as compiler:
        assert compiler.stdout is not None
        for line in compiler.stdout:
            hear(line.strip())
    return compiler.returncode == 0


def command_for(part: str) -> list[str]:
    """The command line of the process that compiles a part."""
    return [sys.executable, "-m", "elbowroom.server.kernels.compiling", part]


def compile_part(part: str, report: Report) -> None:
    """Compile a part by using it: `limbs` plans first and walks then, `steps` walks with the planner that needs least.

    They take about as long, and seldom need the same at once: `steps` begins with what `limbs` will need later, and
    `limbs` ends with what `steps` has compiled.
    """
    with listening(report), closing(Library.open()) as library:
        humanoid = library.avatars.get(library.avatar).humanoid
        if part == "limbs":
            rehearse(humanoid)
        else:
            rehearse_product()
            rehearse_proof(humanoid)
            rehearse_own_body(humanoid)
            rehearse_detour(humanoid)
        for scene in _TELLING:
            walk_and_stand(replace(library, scene=scene), EXACT if part == "limbs" else FIGURE6)


def _collect_seldom() -> None:
    """Look for garbage seldom: a compiler keeps most of what it makes, and looking takes a tenth of its time."""
    gc.freeze()
    gc.set_threshold(100_000, 50, 100)


if __name__ == "__main__":
    _collect_seldom()
    compile_part(sys.argv[1], lambda kernel, number: print(kernel, flush=True))  # noqa: ARG005
