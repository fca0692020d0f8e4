"""Kernels that a frame enters keep the interpreter: who lets go of it waits for it while others plan.

And those that keep it are given little by who plans: frames wait for them.
"""

from contextlib import closing
from typing import Any

import numpy as np
import pytest

from elbowroom.control.plans.desk import Job
from elbowroom.server.schema.commands import Input
from elbowroom.server.sessions.stage import STEP, Stage
from elbowroom.server.sessions.walk import Walk, WalkSettings
from elbowroom.server.stores.avatar_store import AvatarStore
from elbowroom.world.scene import Scene
from late_desk import LateDesk
from noted_kernels import note_kernels

_WALK = [*[Input(1, forward=1.0)] * 90, *[Input(2, forward=1.0, strafe=1.0)] * 40, *[Input(3)] * 30]


_LITTLE = 2000  # numbers in an array


class _Entered:
    """The names of kernels that were called from Python."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.released: set[str] = set()  # by frames: what lets go of the interpreter,
        self.kept: set[str] = set()  # and what keeps it
        self.large: set[str] = set()  # by plans: what keeps it, and is given much
        self.planning = False
        note_kernels(monkeypatch, self._note)

    def _note(self, kernel: Any, arguments: tuple[Any, ...]) -> None:
        name, keeps = f"{kernel.__module__}.{kernel.__name__}", not kernel.targetoptions["nogil"]
        if not self.planning:
            (self.kept if keeps else self.released).add(name)
        elif keeps and any(isinstance(one, np.ndarray) and one.size > _LITTLE for one in arguments):
            self.large.add(name)


class _Apart(LateDesk):
    """A desk whose plans are made elsewhere, as in a thread."""

    def __init__(self, turns: int, entered: _Entered) -> None:
        super().__init__(turns)
        self._entered = entered

    def submit(self, job: Job) -> None:
        self._entered.planning = True
        super().submit(job)
        self._entered.planning = False


@pytest.mark.parametrize("scene", ["d", "traffic"])
def test_kernels_of_frames_keep_the_interpreter_and_plans_give_them_little(
    scene: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    entered = _Entered(monkeypatch)
    entered.planning = True
    with closing(AvatarStore()) as avatars:
        desk = _Apart(3, entered)
        stage = Stage(Walk(avatars.get("stock"), Scene.load(scene), WalkSettings(), desk=desk), 0.0)
        entered.planning = False
        for number, held in enumerate(_WALK):
            desk.next_turn()
            stage.obey(held, number * STEP)
            stage.advance(number * STEP)
            stage.frame(number * STEP)
    assert len(entered.kept) > 10
    assert not entered.released, sorted(entered.released)
    assert not entered.large, sorted(entered.large)
