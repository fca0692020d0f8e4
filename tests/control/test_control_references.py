"""Of a usual tuple that holds one by reference Numba asks in Python what it is, at each call, for a tenth of a
millisecond: frames and plans hand over what is by reference by itself, or within its like.
"""

import math
from typing import Any

import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.by_reference import Reference
from elbowroom.control.controller import Controller
from elbowroom.experiment.bench.steer_scenes import stair
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from noted_kernels import note_kernels


def is_reference(value: object) -> bool:
    return isinstance(getattr(value, "_numba_type_", None), Reference)


def holds_one(value: object) -> bool:
    if not isinstance(value, tuple) or is_reference(value):
        return False
    return any(is_reference(field) or holds_one(field) for field in value)


@pytest.mark.parametrize("scene", [Scene.load("d"), stair().scene], ids=["d", "stair"])
def test_kernels_are_handed_references_by_themselves(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    controller = Controller(Humanoid.default(), scene, seed=0)
    asked: set[str] = set()

    def note(kernel: Any, arguments: tuple[Any, ...]) -> None:
        if any(map(holds_one, arguments)):
            asked.add(kernel.__name__)

    note_kernels(monkeypatch, note)
    for number in range(80):
        controller.step(Command(forward=1.0, turn=0.8 * math.sin(number / 12.0)), 1.0 / 60.0)
    assert asked == set()
