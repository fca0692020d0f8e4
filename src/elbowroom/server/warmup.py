"""Compiles every kernel that a live session uses, by walking for real before anybody waits for it."""

from collections.abc import Callable
from contextlib import nullcontext
from typing import Any

from numba.core import event

from elbowroom.server.library import Library
from elbowroom.server.messages import Input, Overlays
from elbowroom.server.stage import STEP, Stage
from elbowroom.server.walk import Walk

Report = Callable[[str, int], None]

_STEPS = 45  # frames of the walk: past the first key frames, so that plans follow on plans


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
    """Walk a moment in the library's first scene with its first avatar, then the canned walk.

    `report(kernel, number)` hears of each kernel that must be compiled; with all of them cached it hears nothing.
    Raises `InputError` if the avatar cannot stand in that scene: better now than when a page is open.
    """
    with event.install_listener("numba:compile", _Listener(report)) if report else nullcontext():
        stage = Stage(Walk(library.avatars.get(library.avatar), library.find_scene(library.scene), library.walk), 0.0)
        stage.overlays = Overlays(capsules=True, plan=True)
        stage.obey(Input(seq=1, forward=1.0))
        for i in range(_STEPS):
            stage.advance(STEP * (i + 1))
            stage.frame(STEP * (i + 1))
        stage.obey(Input(seq=2, forward=1.0, direction=1.0))
        stage.advance(STEP * (_STEPS + 1))
        stage.status(0.0)
        stage.plan()
