"""Walking to a place: there, round things, given up with a reason, and taken over by the next key."""

import math
from pathlib import Path

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import FORWARD, Controller
from elbowroom.control.journey import Journey, JourneyState
from elbowroom.control.recording import Recorder, Recording
from elbowroom.control.replay import replay
from elbowroom.errors import InputError
from elbowroom.planning.command import Command
from elbowroom.planning.navigation.way import NoWayError
from elbowroom.world.scene import Scene

DT = 1 / 60
LONG = 60.0  # seconds


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return Humanoid.default()


def walk(controller: Controller, seconds: float = LONG) -> float:
    """Let it walk; the least clearance on the way."""
    journey, clearance = controller.journey, math.inf
    assert journey is not None
    for _ in range(round(seconds / DT)):
        frame = controller.step(Command(), DT)
        clearance = min(clearance, frame.clearance)
        if not journey.walking and controller.stands:
            break
    return clearance


def away(controller: Controller, place: tuple[float, float]) -> float:
    return math.dist((controller.root.x, controller.root.z), place)


@pytest.mark.parametrize(("scene", "place"), [("a", (0.5, 6.0)), ("d", (0.0, 4.0)), ("empty", (-2.0, -3.0))])
def test_it_gets_there_and_stands(humanoid: Humanoid, scene: str, place: tuple[float, float]) -> None:
    controller = Controller(humanoid, Scene.load(scene))
    journey = controller.goto(place)
    assert walk(controller) >= 0.0
    assert journey.state is JourneyState.ARRIVED
    assert away(controller, place) < 0.2
    assert controller.stands


def test_a_key_takes_over_at_once_and_for_good(humanoid: Humanoid) -> None:
    controller = Controller(humanoid, Scene.load("empty"))
    journey = controller.goto((0.0, 5.0))
    walk(controller, 1.0)
    back = Command(forward=-1.0)
    assert controller.step(back, DT).command == back
    assert journey.state is JourneyState.TAKEN_OVER
    assert controller.step(Command(), DT).command.idle


def test_a_reset_ends_it(humanoid: Humanoid) -> None:
    controller = Controller(humanoid, Scene.load("empty"))
    controller.goto((0.0, 5.0))
    walk(controller, 1.0)
    controller.reset()
    assert controller.journey is None
    assert controller.step(Command(), DT).command.idle


def test_what_is_recorded_of_it_replays(humanoid: Humanoid, tmp_path: Path) -> None:
    path = tmp_path / "run.elbow"
    controller = Controller(humanoid, Scene.load("a"))
    with Recorder(path, controller) as recorder:
        controller.goto((0.5, 4.0))
        for _ in range(300):
            frame = controller.step(Command(), DT)
            recorder.append(frame.command, DT, frame)
    assert replay(Recording(path), humanoid).identical


def test_a_walled_in_place_is_refused_and_nothing_changes(humanoid: Humanoid) -> None:
    across = [{"type": "box", "center": [0.0, 1.0, z], "size": [2.2, 2.0, 0.2]} for z in (2.0, 4.0)]
    along = [{"type": "box", "center": [x, 1.0, 3.0], "size": [0.2, 2.0, 2.2]} for x in (-1.0, 1.0)]
    controller = Controller(humanoid, Scene.of("pen", [*across, *along], finish=(0.0, 6.0)))
    with pytest.raises(NoWayError, match="no way leads"):
        controller.goto((0.0, 3.0))
    assert controller.journey is None
    with pytest.raises(InputError):
        controller.goto((math.inf, 3.0))


def test_what_is_blocked_for_long_is_given_up_with_the_place(humanoid: Humanoid) -> None:
    """The avatar never moves, whatever it is told."""
    controller = Controller(humanoid, Scene.load("empty"))
    journey = Journey(controller.navigator, controller.navigator.find((0.0, 0.0), (0.0, 5.0)), FORWARD)
    told = []
    for _ in range(round(120.0 / DT)):
        told.append(journey.command(RootState(), DT, stuck=True))
        if not journey.walking:
            break
    assert journey.state is JourneyState.GIVEN_UP
    assert "blocked at 0.00, 0.00" in journey.reason
    assert any(command.forward < 0.0 for command in told), "it never stepped back"
    directions = {round(command.direction, 2) for command in told if command.direction is not None}
    assert len(directions) > 1, "it never tried another way"
    assert told[-1].idle


def test_directions_are_held_until_the_aim_has_moved_aside(humanoid: Humanoid) -> None:
    controller = Controller(humanoid, Scene.load("d"))
    controller.goto((0.0, 8.0))
    directions = [controller.step(Command(), DT).command.direction for _ in range(600)]
    changes = np.count_nonzero(np.diff([d for d in directions if d is not None]))
    assert 1 <= changes < 60
