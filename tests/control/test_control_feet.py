"""Feet under the controller: who stands does not slide, whatever is asked for and however late plans come."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.gait.foot_state import standing
from elbowroom.body.gait.footholds import settled
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import FOOT, ROOT_STATE, SHOWN, WITH_FEET
from elbowroom.control.controller import Controller
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from feet_walks import in_world
from late_desk import LateDesk

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

HUMANOID = proportional_humanoid()
FRAME = 1 / 60
ROOM = 0.2  # metres about the legs: plenty
HELD = 30  # frames that a command is held
ASKED = (
    Command(forward=1.0), Command(), Command(forward=1.0, run=True), Command(strafe=1.0), Command(turn=1.0),
    Command(forward=-1.0), Command(forward=1.0, direction=2.0), Command(forward=1.0, turn=-0.5), Command(),
)  # fmt: skip


def slides(rows: Floats, roomy: Bools | None = None) -> float:
    """The farthest that a standing foot moves over the ground from one frame to the next, metres and radians.

    `roomy` (N,) says in which frames that counts.
    """
    stands, farthest = standing(rows), 0.0
    if roomy is not None:
        stands = stands & roomy[:, None]
    for side in range(2):
        stays = stands[1:, side] & stands[:-1, side]
        farthest = max(farthest, float(np.abs(np.diff(in_world(rows, side), axis=0))[stays].max()))
    return farthest


def shown(scene: str, desk: LateDesk | None = None) -> Floats:
    """What is shown while commands follow on one another, in frames of uneven length."""
    controller = Controller(HUMANOID, Scene.load(scene), ahead=Lookahead(desk=desk))
    rng, rows = np.random.default_rng(0), []
    for k in range(12 * HELD):
        if desk is not None:
            desk.next_turn()
        rows.append(controller.step(ASKED[k // HELD % len(ASKED)], FRAME * rng.uniform(0.3, 1.4)).root)
    return np.array(rows)


def test_a_standing_foot_does_not_move_whatever_is_asked_for() -> None:
    rows = shown("empty")
    assert rows.shape[1] == SHOWN
    assert slides(rows) < 1e-9
    assert standing(rows).any(axis=1).all()
    assert (~standing(rows)).any(axis=0).all()  # both have stepped


def test_a_standing_foot_does_not_move_where_plans_come_late() -> None:
    assert slides(shown("empty", LateDesk(9))) < 1e-9


def test_among_obstacles_too_it_does_not_move_where_there_is_room() -> None:
    rows, check = shown("a"), BodyCheck(HUMANOID, Scene.load("a"))
    room = np.array([check.room_of_legs(row, np.zeros(LOCAL), 0.0) for row in rows])
    assert slides(rows, room > ROOM) < 1e-9
    assert (room > ROOM).sum() > 100
    assert (room < 0.2).sum() > 10


def test_who_has_stopped_stands_with_the_feet_beside_each_other_and_rests() -> None:
    controller = Controller(HUMANOID, Scene.load("a"))
    for k in range(220):
        frame = controller.step(Command(forward=float(k < 100)), FRAME)
    assert frame.contacts.all()
    assert settled(body_model(HUMANOID).gait, frame.root)
    again = controller.step(Command(), FRAME)
    assert again.root[:WITH_FEET].tobytes() == frame.root[:WITH_FEET].tobytes()


def test_others_are_told_of_the_feet_that_will_be_shown() -> None:
    controller = Controller(HUMANOID, Scene.load("empty"))
    for _ in range(25):
        controller.step(Command(forward=1.0), FRAME)
    told = controller.prediction()
    frames = [controller.step(Command(forward=1.0), FRAME) for _ in range(3)]
    for k, frame in enumerate(frames, 1):
        body = posture_capsules(body_model(HUMANOID), frame.q[None], frame.root[None])[:, :, 0]
        np.testing.assert_allclose(told.at(told.times[k]), body, atol=1e-5)


def test_a_step_round_a_corner_turns_the_feet() -> None:
    controller = Controller(HUMANOID, Scene.load("empty"))
    for _ in range(240):
        frame = controller.step(Command(turn=1.0), FRAME)
    yaws = frame.root[[ROOT_STATE + 2, ROOT_STATE + FOOT + 2]]
    assert np.abs(yaws).max() < 1.0
    assert abs(frame.root[2]) > math.pi


@pytest.mark.parametrize("width", [0.42, 0.45, 0.48])
def test_between_two_walls_it_does_not_move_where_legs_stay_clear(width: float) -> None:
    """Legs are so near the walls that they used to glide where the planner has them."""
    walls = [
        {"type": "box", "center": [side * (0.5 * width + 0.5), 1.0, 2.0], "size": [1.0, 2.0, 0.8]} for side in (-1, 1)
    ]
    scene = Scene.of("between walls", walls, finish=(0.0, 5.0))
    controller, check = Controller(HUMANOID, scene), BodyCheck(HUMANOID, scene)
    rows = np.array([controller.step(Command(forward=float(k < 200)), FRAME).root for k in range(300)])
    room = np.array([check.room_of_legs(row, np.zeros(LOCAL), 0.0) for row in rows])
    assert slides(rows) < 1e-9
    assert rows[-1, 1] > 2.6
    assert 0.0 < room.min() < 0.1


def test_in_a_doorway_that_is_passed_sideways_it_does_not_move() -> None:
    """Where legs that step would come too near it is the swinging foot that makes way."""
    controller = Controller(Humanoid.default(), Scene.load("doorway"))
    rows = np.array([controller.step(Command(forward=1.0), FRAME).root for _ in range(330)])
    assert slides(rows) < 1e-3
    assert np.abs(rows[:, 2]).max() > 1.2
