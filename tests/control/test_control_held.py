"""Who is held in mid-stride by a stop that came late gets away again: lower, or with arms beside the legs."""

import random

import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.experiment.gauntlet.scenes import course_scene
from elbowroom.planning.command import Command
from elbowroom.planning.root.pace import at_speed
from elbowroom.world.scene import Scene

ONE_TURN = 1 / 60  # seconds
IMPATIENT, PATIENCE = 1.0, 10.0  # seconds


def longest_wait(scene: Scene, seed: int, seconds: float) -> float:
    """Seconds that a walker was stuck on end whose user holds the key, lets go and holds it again, at random."""
    chance = random.Random(seed)
    controller = Controller(Humanoid.default(), scene, seed=0)
    speed, until, command, time, waited, longest = chance.uniform(0.8, 1.7), 0.0, Command(), 0.0, 0.0, 0.0
    while time < seconds and not scene.finished(controller.root):
        if time >= until:
            stop = chance.random() < 0.35
            until = time + (chance.uniform(0.1, 0.8) if stop else chance.uniform(0.3, 2.0))
            share = 0.0 if stop else chance.choice([1.0, 1.0, chance.uniform(0.3, 1.0)])
            if waited > IMPATIENT:
                share, until = 1.0, time + PATIENCE
            command = Command(forward=share, direction=0.0 if share else None)
        frame = controller.step(at_speed(command, speed), ONE_TURN)
        assert frame.clearance >= 0.0
        time += ONE_TURN
        waited = waited + ONE_TURN if frame.stuck else 0.0
        longest = max(longest, waited)
        if longest >= PATIENCE:
            break
    return longest


@pytest.mark.long
@pytest.mark.parametrize(("course", "seed", "seconds"), [(10, 3, 6.0), (7, 0, 9.0), (8, 0, 9.0)])
def test_who_is_held_in_a_stride_gets_away(course: int, seed: int, seconds: float) -> None:
    assert longest_wait(course_scene(f"gauntlet:5:{course}"), seed, seconds) < 2.0


@pytest.mark.long
@pytest.mark.parametrize("course", range(100, 110))
@pytest.mark.parametrize("seed", range(3))
def test_nobody_who_stops_and_goes_is_stuck_for_good(course: int, seed: int) -> None:
    assert longest_wait(course_scene(f"gauntlet:5:{course}"), seed, 40.0) < PATIENCE
