"""Styles of walking: what they change, how they blend, and that a recording holds them."""

import json
from pathlib import Path

import numpy as np
import pytest

from elbowroom.body.dof import LOCAL_GROUPS, DofGroup
from elbowroom.body.gait.carriage import ASIDE, CHEST_BEND, LIST
from elbowroom.body.gait.manner import PLAIN, Manner
from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.clip import motions_of
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.clips.style import PLAIN_STYLE, STYLES, WALK_SPEED, Style, style_named
from elbowroom.clips.style_names import STYLE_NAMES
from elbowroom.control.controller import Controller
from elbowroom.control.recordings.recording import Recorder, Recording
from elbowroom.control.recordings.replay import replay
from elbowroom.errors import InputError
from elbowroom.planning.command import Command
from elbowroom.planning.root.pace import at_speed
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.world.scene import Scene

DT = 1 / 60
PHASES = np.linspace(0.0, 1.0, 17)


def _goals(motions: MotionSet, group: DofGroup) -> np.ndarray:
    return motions.goal(group, PHASES, np.full(len(PHASES), 1.1))


def _shown(controller: Controller, seconds: float) -> np.ndarray:
    command = at_speed(Command(forward=1.0), controller.motions.style.speed)
    return np.array([controller.step(command, DT).root for _ in range(round(seconds / DT))])


def test_the_plain_style_is_the_stock_walk() -> None:
    assert motions_of(style=style_named("plain")) is STOCK
    assert STYLES["plain"] is PLAIN_STYLE
    assert tuple(STYLES) == STYLE_NAMES
    assert RootMotionSettings().walk_speed == WALK_SPEED


@pytest.mark.parametrize("name", STYLES)
def test_a_style_lies_between_the_plain_walk_and_itself(name: str) -> None:
    full, half = (motions_of(style=style_named(text)) for text in (f"{name}:1", f"{name}:0.5"))
    none = motions_of(style=style_named(f"{name}:0"))
    for group in LOCAL_GROUPS:
        np.testing.assert_allclose(_goals(none, group), _goals(STOCK, group), atol=1e-12)
        np.testing.assert_allclose(_goals(half, group), 0.5 * (_goals(STOCK, group) + _goals(full, group)), atol=1e-12)
    own = STYLES[name]
    assert half.style.speed == pytest.approx(0.5 * (WALK_SPEED + own.speed))
    np.testing.assert_allclose(half.style.manner.amounts(), 0.5 * (PLAIN.amounts() + own.manner.amounts()))


def test_a_style_is_shown() -> None:
    humanoid, scene = Humanoid.default(), Scene.load("empty")
    plain, old = (
        _shown(Controller(humanoid, scene, seed=1, motions=motions_of(style=STYLES[name])), 3.0)
        for name in ("plain", "old")
    )
    lean = old[-60:, CHEST_BEND].mean() - plain[-60:, CHEST_BEND].mean()
    assert lean == pytest.approx(STYLES["old"].manner.lean, abs=0.02)
    assert old[-1, 3] == pytest.approx(STYLES["old"].speed, abs=0.02)
    assert np.ptp(old[-60:, LIST]) < 0.8 * np.ptp(plain[-60:, LIST])
    assert np.ptp(old[-60:, ASIDE]) > np.ptp(plain[-60:, ASIDE])


def test_a_recording_of_a_style_is_replayed_to_the_bit(tmp_path: Path) -> None:
    humanoid = Humanoid.default()
    controller = Controller(humanoid, Scene.load("c"), seed=2, motions=motions_of(style=style_named("child:0.7")))
    with Recorder(tmp_path / "run.elbow", controller) as recorder:
        for _ in range(90):
            frame = controller.step(Command(forward=1.0), DT)
            assert frame.clearance >= 0.0
            recorder.append(frame, DT)
    recording = Recording(tmp_path / "run.elbow")
    assert recording.header.motions.style == controller.motions.style
    assert replay(recording, humanoid).identical


def test_recordings_without_a_style_are_plain() -> None:
    told = json.loads(json.dumps(STOCK.to_dict()))
    del told["style"]
    assert MotionSet.from_dict(told, "run").style == PLAIN_STYLE


@pytest.mark.parametrize("text", ["", "olde", "old:", "old:x", "old:1.5", "old:-1", "old:nan"])
def test_what_is_no_style_is_told(text: str) -> None:
    with pytest.raises(InputError, match="style"):
        style_named(text)


def test_what_no_body_could_show_is_told() -> None:
    for make in (lambda: Manner(sway=9.0), lambda: Manner(lean=np.nan), lambda: Style(speed=0.0)):
        with pytest.raises(InputError):
            make()
