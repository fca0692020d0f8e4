"""Nobody is trapped: from wherever steering has led, a command towards free space moves the avatar."""

import math

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from gauntlet_courses import course

AVATAR = Humanoid.default()
DT = 1 / 60
# Before the sideboard of scene C, knees 1.5 cm from it: a stride in any direction brings one into it.
HARD_BY = RootState(-0.6107459119754125, 1.2700209971435816, 6.71346379465214, 0.0, 0.0, 0.0, 0.0)
AWAY = [Command(forward=-1.0), Command(strafe=1.0), Command(strafe=-1.0), Command(forward=-0.7, strafe=0.7)]
DIRECTIONS = [Command(forward=1.0, direction=k * math.pi / 4) for k in range(8)]


def moved(controller: Controller, command: Command, seconds: float) -> float:
    """How far it gets in so many seconds, metres; nothing is touched."""
    start = controller.root
    for _ in range(round(seconds / DT)):
        assert not controller.step(command, DT).touching
    return math.dist(start[:2], controller.root[:2])


@pytest.mark.parametrize("command", AWAY + DIRECTIONS[2:7])
def test_who_stands_hard_by_an_obstacle_walks_away_from_it(command: Command) -> None:
    controller = Controller(AVATAR, Scene.load("c"), seed=2, start=HARD_BY)
    assert moved(controller, command, 4.0) > 0.5


@pytest.mark.long
@pytest.mark.parametrize("scene", ["c", "d", "level 4", "level 5"])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_wherever_steering_leads_there_is_a_way_on(scene: str, seed: int) -> None:
    """Steered at random for a while, then in eight directions: one of them at least leads on by more than a step."""
    rng = np.random.default_rng(seed)
    place = course(int(scene[-1]), seed).scene if scene.startswith("level") else Scene.load(scene)
    controller = Controller(AVATAR, place, seed=seed)
    for _ in range(8):
        strafe, forward = rng.choice([-1.0, 0.0, 1.0]), rng.choice([0.5, 1.0, 1.0, -1.0])
        turn = float(rng.choice([-0.6, 0.0, 0.0, 0.6]))
        moved(controller, Command(forward=float(forward), strafe=float(strafe), turn=turn), 1.5)
    here = controller.root
    farthest = 0.0
    for command in DIRECTIONS:
        again = Controller(AVATAR, place, seed=seed, start=here._replace(forward=0.0, lateral=0.0, turn=0.0))
        farthest = max(farthest, moved(again, command, 4.0))
        if farthest > 0.5:
            break
    assert farthest > 0.5
