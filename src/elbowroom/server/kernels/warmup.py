"""Uses every kernel that a live session uses, by walking for real before anybody waits for it.

What is on disk is loaded by that, what is not is compiled.
"""

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from typing import Any

from numba.core import event

from elbowroom.experiment.rehearsal import rehearse
from elbowroom.planning.names import planner_names
from elbowroom.server.schema.commands import Input, Overlays
from elbowroom.server.sessions.stage import STEP, Stage
from elbowroom.server.sessions.walk import Walk
from elbowroom.server.stores.library import Library

Report = Callable[[str, int], None]

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


def listening(report: Report | None) -> AbstractContextManager[Any]:
    """While this lasts, `report(kernel, number)` hears of each kernel that is compiled."""
    if report is None:
        return nullcontext()
    listener: AbstractContextManager[Any] = event.install_listener("numba:compile", _Listener(report))
    return listener


def warm_up(library: Library, report: Report | None = None) -> None:
    """Walk, turn and stand a moment in the library's first scene with its first avatar: every planner, the canned walk.

    `report(kernel, number)` hears of each kernel that must be compiled; with all of them cached it hears nothing.
    Sets `library.warm`. Raises `InputError` if the avatar cannot stand in that scene.
    """
    with listening(report):
        for planner in planner_names():
            walk_and_stand(library, planner)
        rehearse(library.avatars.get(library.avatar).humanoid)
    library.warm.set()


def first_steps(library: Library, report: Report | None = None) -> None:
    """The beginning of that walk with the planner that sessions begin with: what a page needs at once."""
    with listening(report):
        _walk_a_moment(library, library.walk.planner, _FIRST_STEPS)


def walk_and_stand(library: Library, planner: str) -> None:
    """That walk with one planner."""
    _walk_a_moment(library, planner, _WALK)


def _walk_a_moment(library: Library, planner: str, held_inputs: list[tuple[int, Input]]) -> None:
    settings = replace(library.walk, planner=planner)
    walk = Walk(library.avatars.get(library.avatar), library.scenes[library.scene], settings)
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
