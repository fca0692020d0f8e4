"""A place under eaves: one goes in backwards, with the head where there is room, and out forwards; judged by coal."""

import math

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.journey import JourneyState
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.planning.command import Command
from elbowroom.planning.navigation.backwards import stretch_from
from elbowroom.planning.navigation.girth import girth_of
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.world.scene import Scene

AVATAR = Humanoid.default()
TALL, STOOPED = girth_of(AVATAR).tall, girth_of(AVATAR).stooped
STEEP = math.radians(30.0)
LOW = 3.0  # metres along z: there the roof is as high as the avatar, and falls from there on
LONGEST = 12.0  # seconds
HERE = (0.0, 0.0, 0.4)


def under_eaves() -> Scene:
    """A room whose roof comes down to the floor ahead."""
    middle = TALL + 0.1 / math.cos(STEEP)
    roof = {"type": "box", "center": [0.0, middle, LOW], "size": [8.0, 0.2, 6.0], "euler": [STEEP, 0.0, 0.0]}
    return Scene.of("eaves", [roof], start=(0.0, 0.4), finish=(0.0, 1.0))


def below(headroom: float) -> tuple[float, float, float]:
    """A place where the roof is so high."""
    return 0.0, 0.0, LOW + (TALL - headroom) / math.tan(STEEP)


def beam_before(far: float) -> Scene:
    """A low beam, and a wall so far behind it."""
    over = STOOPED + 0.1
    beam = {"type": "box", "center": [0.0, over + 0.2, LOW], "size": [8.0, 0.4, 0.4]}
    wall = {"type": "box", "center": [0.0, 1.0, LOW + 0.2 + far + 0.1], "size": [8.0, 2.0, 0.2]}
    return Scene.of("beam and wall", [beam, wall], start=(0.0, 0.4), finish=(0.0, 1.0))


def is_entered_backwards(scene: Scene, place: tuple[float, float, float]) -> bool:
    """Whether one turns on the way to a place and is there with the back ahead."""
    way = Navigator(AVATAR, scene).find(HERE, place)
    first = stretch_from(way, HERE, backwards=False)
    assert not first.backwards, "one walks through the room as ever"
    if first.way is way:
        return False
    assert LOW - 0.8 < first.way.goal[2] < LOW, "one turns before the head has to go down"
    return stretch_from(way, first.way.goal, backwards=False).backwards


def test_where_a_bent_head_has_no_room_ahead_one_goes_in_backwards() -> None:
    assert is_entered_backwards(under_eaves(), below(STOOPED + 0.15))
    assert is_entered_backwards(under_eaves(), below(STOOPED + 0.3))
    assert not is_entered_backwards(under_eaves(), below(TALL - 0.05)), "it is high enough ahead"
    assert not is_entered_backwards(under_eaves(), below(TALL + 0.2)), "nobody ducks there"


@pytest.mark.parametrize(("far", "backwards"), [(0.3, True), (2.0, False)])
def test_below_a_beam_one_faces_what_is_behind_it_if_there_is_room(far: float, backwards: bool) -> None:
    assert is_entered_backwards(beam_before(far), (0.0, 0.0, LOW)) is backwards


def test_nobody_turns_round_under_eaves() -> None:
    goal = below(STOOPED + 0.15)
    way = Navigator(AVATAR, under_eaves()).find(HERE, goal)
    for less in (0.1, 0.3, 0.5):
        place = (goal[0], goal[1], goal[2] - less)
        assert stretch_from(way, place, backwards=True).backwards


@pytest.mark.parametrize("headroom", [0.15, 0.3])
def test_a_place_under_eaves_is_reached_and_left_without_a_halt(headroom: float) -> None:
    controller, frames = Controller(AVATAR, under_eaves(), start=RootState(0.0, 0.4)), list[Frame]()
    for place in (below(STOOPED + headroom), HERE):
        journey = controller.goto(place)
        began = controller.step(Command(), 0.0).time
        while journey.walking:
            frame = controller.step(Command(), 1 / 60)
            frames.append(frame)
            assert frame.time - began < LONGEST
        assert journey.state is JourneyState.ARRIVED
    assert not any(frame.stuck or frame.touching for frame in frames)
    motion = ShownMotion.at_rate(np.stack([frame.q for frame in frames]), np.stack([frame.root for frame in frames]))
    assert judge(motion, AVATAR, under_eaves(), JudgeSettings(mesh=False)).clean
