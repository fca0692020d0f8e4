"""The gap ahead: where it is, how it lies, and that who comes at a slant goes through."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.planning.narrow.build import build_of
from elbowroom.planning.narrow.gap import Gap, gap_ahead
from elbowroom.planning.narrow.places import NarrowPlaces
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.world.scene import Scene
from sampled import sampled

AVATAR = Humanoid.default()
BUILD = build_of(AVATAR, body_model(AVATAR))
DT = 1 / 60
angles = st.floats(-math.pi, math.pi)


def door(width: float, thick: float, yaw: float, x: float, z: float) -> Scene:
    """Two walls of 2 m that leave a gap about a place; its axis points where `yaw` does."""
    away = 0.5 * width + 1.0
    walls = [
        {
            "type": "box",
            "center": [x + side * away * math.cos(yaw), 1.1, z - side * away * math.sin(yaw)],
            "size": [2.0, 2.2, thick],
            "yaw": yaw,
        }
        for side in (-1.0, 1.0)
    ]
    return Scene.of("door", walls, start=(60.0, 60.0), finish=(0.0, 50.0))


def line_to(x: float, z: float, heading: float, away: float, aside: float) -> TravelLine:
    """A line of travel that begins so far before a place and passes so far beside it."""
    first_x = x - away * math.sin(heading) + aside * math.cos(heading)
    first_z = z - away * math.cos(heading) - aside * math.sin(heading)
    return TravelLine((heading, 1.0), first_x, first_z, heading, heading, True)


def found(scene: Scene, line: TravelLine) -> Gap | None:
    return gap_ahead(NarrowPlaces(BUILD, scene.free_map), line, line.x, line.z, 0.0)


@settings(deadline=None, max_examples=60)
@example(yaw=0.0, place=(0.0, 0.0), width=0.5, thick=0.0625, slant=0.6875, aside=0.25)
@given(
    yaw=angles,
    place=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)),
    width=st.floats(0.35, 0.5),
    thick=st.floats(0.05, 0.3),
    slant=st.floats(-0.7, 0.7),
    aside=st.floats(-0.25, 0.25),
)
def test_a_gap_is_where_it_is_however_one_comes(
    yaw: float, place: tuple[float, float], width: float, thick: float, slant: float, aside: float
) -> None:
    gap = found(door(width, thick, yaw, *place), line_to(*place, yaw + slant, 0.9, aside))
    assert gap is not None
    across = (gap.x - place[0]) * math.cos(yaw) - (gap.z - place[1]) * math.sin(yaw)
    assert abs(across) < 0.02
    assert abs(math.remainder(gap.heading - yaw, math.tau)) < math.radians(5.0)


def test_what_is_no_gap_is_none() -> None:
    line = line_to(0.0, 0.0, 0.0, 0.9, 0.0)
    assert found(door(1.2, 0.1, 0.0, 0.0, 0.0), line) is None  # nobody minds
    assert found(door(0.4, 0.1, 0.5 * math.pi, 0.0, 0.0), line) is None  # one comes along the wall
    assert found(door(0.4, 0.1, 0.0, 0.0, -1.5), line) is None  # behind
    wall = [{"type": "box", "center": [0.0, 1.1, 0.0], "size": [8.0, 2.2, 0.2]}]
    assert found(Scene.of("wall", wall, start=(60.0, 60.0), finish=(0.0, 50.0)), line) is None


@pytest.mark.parametrize(("slant", "aside"), sampled([(16.0, -0.1), (40.0, 0.0), (8.0, 0.0), (25.0, 0.1)], 2))
def test_a_door_is_passed_at_a_slant(slant: float, aside: float) -> None:
    heading = math.radians(slant)
    line = line_to(0.0, 2.2, heading, 2.2, aside)
    controller = Controller(AVATAR, Scene.load("doorway"), start=RootState(line.x, line.z, heading))
    for _ in range(600):
        frame = controller.step(Command(forward=1.0, direction=heading), DT)
        assert not frame.touching
        if controller.root.z > 2.8:
            return
    pytest.fail(f"stands at {np.round(controller.root[:2], 2)}")


@pytest.mark.parametrize("aside", [-0.1, 0.0])
def test_a_door_that_leaves_no_room_for_long_steps_is_passed_with_short_ones(aside: float) -> None:
    scene = door(0.35, 0.1, 0.0, 0.0, 2.2)
    controller = Controller(AVATAR, scene, start=RootState(aside, 0.0))
    for _ in range(600):
        assert not controller.step(Command(forward=1.0), DT).touching
        if controller.root.z > 2.8:
            return
    pytest.fail(f"stands at {np.round(controller.root[:2], 2)}")
