"""Compiles every kernel that a live session uses, by walking for real before anybody waits for it.

`python -m elbowroom.server.warmup` does it in a process of its own and prints the kernels' names: a compiler takes
200 MB that a server should not carry for the rest of its life.
"""

import subprocess
import sys
from collections.abc import Callable
from contextlib import closing, nullcontext
from dataclasses import replace
from typing import Any

from numba.core import event

from elbowroom.planning.exact.rehearsal import rehearse
from elbowroom.planning.planner import PLANNERS
from elbowroom.server.kernel_cache import is_warm, mark_warm
from elbowroom.server.library import Library
from elbowroom.server.schema.commands import Input, Overlays
from elbowroom.server.stage import STEP, Stage
from elbowroom.server.walk import Walk

Report = Callable[[str, int], None]

_TELLING = ("a", "c", "doorway", "traffic")  # where the walk meets what it does not in the open: ways round, evasions
_WALK = [
    (45, Input(seq=1, forward=1.0)),  # past the first key frames, so that plans follow on plans
    (10, Input(seq=2, forward=1.0, direction=1.0, run=True)),
    (10, Input(seq=3, turn=1.0, strafe=0.5)),
    (30, Input(seq=4)),
]
_FIRST_STEPS = [(1, Input(seq=1)), (12, Input(seq=2, forward=1.0))]


class _Listener(event.Listener):
    """Tells about every kernel whose compilation begins."""

    def __init__(self, report: Report) -> None:
        self._report = report
        self._done = 0

    def on_start(self, event: Any) -> None:
        dispatcher = event.data.get("dispatcher")
        module = getattr(dispatcher, "__module__", "") or ""
        if module.startswith("elbowroom"):
            self._report(f"{module.removeprefix('elbowroom.')}.{dispatcher.__name__}", self._done)
            self._done += 1

    def on_end(self, event: Any) -> None:
        del event


def warm_up(library: Library, report: Report | None = None) -> None:
    """Walk, turn and stand a moment in the library's first scene with its first avatar: every planner, the canned walk.

    `report(kernel, number)` hears of each kernel that must be compiled; with all of them cached it hears nothing.
    Raises `InputError` if the avatar cannot stand in that scene.
    """
    with event.install_listener("numba:compile", _Listener(report)) if report else nullcontext():
        for planner in PLANNERS:
            _walk_a_moment(library, planner, _WALK)
        rehearse(library.avatars.get(library.avatar).humanoid)


def first_steps(library: Library, report: Report | None = None) -> None:
    """The beginning of that walk with the planner that sessions begin with: what a page needs at once."""
    with event.install_listener("numba:compile", _Listener(report)) if report else nullcontext():
        _walk_a_moment(library, library.walk.planner, _FIRST_STEPS)


def _walk_a_moment(library: Library, planner: str, held_inputs: list[tuple[int, Input]]) -> None:
    settings = replace(library.walk, planner=planner)
    walk = Walk(library.avatars.get(library.avatar), library.find_scene(library.scene), settings)
    stage, now = Stage(walk, 0.0), 0.0
    stage.overlays = Overlays(capsules=True, plan=True)
    for frames, held in held_inputs:
        stage.obey(held, now)
        for _ in range(frames):
            now += STEP
            stage.advance(now)
            stage.frame(now)
        stage.status(now)
        stage.plan()
    walk.adjust(replace(walk.settings, assist=not walk.settings.assist))
    stage.advance(now + STEP)


def compile_apart(report: Report) -> None:
    """Compile in a process of its own, unless that was done for the present sources.

    Should that process fail, nothing is lost: what it did not compile is compiled where it is needed.
    """
    if is_warm():
        return
    command = [sys.executable, "-m", "elbowroom.server.warmup"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as compiler:
        assert compiler.stdout is not None
        for number, line in enumerate(compiler.stdout):
            report(line.strip(), number)


def main() -> None:
    """Compile, and print each kernel's name as its turn comes."""
    for scene in _TELLING:
        with closing(Library.open(scene)) as library:
            warm_up(library, lambda kernel, number: print(kernel, flush=True))  # noqa: ARG005
    mark_warm()


if __name__ == "__main__":
    main()
