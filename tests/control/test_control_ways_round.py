"""Ways round what only the upper body would touch."""

from dataclasses import replace

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from stiff import forbid_crouching

DT = 1 / 60


def with_panel(width: float) -> Scene:
    """A panel across the way, above the hips: legs pass below it, trunk and arms do not unless one folds up deep."""
    panel = {"type": "box", "center": [0.0, 1.775, 3.0], "size": [width, 1.25, 0.3]}
    return Scene.from_dict({**Scene.load("empty").to_dict(), "obstacles": [panel]})


@pytest.mark.parametrize("width", [0.8, 1.2])
def test_a_panel_that_is_wide_is_walked_round_without_a_halt(width: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """By who cannot go down on bent knees and hips: all others pass below it."""
    forbid_crouching(monkeypatch)
    controller = Controller(replace(Humanoid.default()), with_panel(width))
    frames = []
    for _ in range(round(6.0 / DT)):
        frames.append(controller.step(Command(forward=1.0), DT))
        if controller.root.z > 4.2:
            break
    assert controller.root.z > 4.2
    assert min(frame.clearance for frame in frames) >= 0.0
    places = np.array([frame.root[:2] for frame in frames])
    aside = np.abs(places[np.abs(places[:, 1] - 3.0) < 0.1, 0]).min()
    assert aside > 0.5 * width
    assert min(frame.root[3] for frame in frames[60:]) > 0.8
