"""Root paths among what moves: free ones come first, and what is free in one plan is free in the next."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import body_model, leg_capsules
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

BODY = proportional_humanoid(1.72)
MODEL = body_model(BODY)
FORWARD = Command(forward=1.0)
INTERVAL, HORIZON = 0.15, 16


def crossed(seconds: float = 4.0, walls: bool = False) -> Scene:
    """A barrel rolls to and fro across the way at z 2, 4.4 m in so many seconds; walls leave no way round."""
    ends = [{"center": [x, 0.45, 2.0], "seconds": s} for x, s in ((-2.2, seconds), (2.2, 1.0))]
    barrel = {"type": "cylinder", "radius": 0.28, "height": 0.9, "repeat": "pingpong", "track": ends}
    sides = [{"type": "box", "center": [x, 0.5, 1.2], "size": [0.2, 1.0, 4.0]} for x in (-0.5, 0.5)]
    data = {**Scene.load("empty").to_dict(), "obstacles": sides if walls else [], "moving": [barrel]}
    return Scene.from_dict(data)


def least_clearance(path: RootPath, scene: Scene) -> float:
    """The judge: legs and pelvis at moments of what playback shows, each from where the barrel is just then."""
    times = np.linspace(path.times[0], path.times[-1], 40 * path.horizon)
    gaps = [
        clearance(leg_capsules(MODEL, state[None]), MODEL.roots.radii, scene.obstacles.moving.at(time))[0]
        for time, state in zip(times.tolist(), path.sample(times), strict=True)
    ]
    return float(min(gaps))


@pytest.mark.parametrize("walls", [False, True])
@pytest.mark.parametrize("time", [0.0, 0.7, 1.43, 3.1])
def test_what_something_comes_into_is_offered_last_and_says_so(time: float, walls: bool) -> None:
    scene, start = crossed(walls=walls), RootState(z=1.2, forward=1.0)
    plans = list(RootPlanner(BODY, scene).candidates(Asked(start, FORWARD, HORIZON, INTERVAL, time), (0.6, 0.3)))
    assert plans
    free = [plan.free for plan in plans]
    assert free == sorted(free, reverse=True)
    assert all(least_clearance(plan.path, scene) > 0.0 for plan in plans[:8] if plan.free)


def test_some_paths_are_free_and_some_are_not() -> None:
    scene, kinds = crossed(walls=True), set[bool]()
    for time in np.arange(0.0, 4.0, 0.4).tolist():
        planner, start = RootPlanner(BODY, scene), RootState(z=1.75, forward=0.3)
        kinds |= {plan.free for plan in planner.candidates(Asked(start, FORWARD, HORIZON, INTERVAL, time))}
    assert kinds == {True, False}


def test_who_stands_in_the_way_is_told_when_and_steps_aside_in_time() -> None:
    scene, start = crossed(), RootState(z=2.0)
    planner, time = RootPlanner(BODY, scene), 0.6  # the barrel is 1.5 m off then, and comes at 1.1 m/s
    asked = Asked(start, Command(), HORIZON, INTERVAL, time)
    standing = RootPath(time, INTERVAL, np.repeat(start.as_array()[None], HORIZON + 1, axis=0))
    assert 4 <= planner.kept(standing, asked) <= 8
    steps = list(planner.steps_aside(asked))
    assert steps
    assert all(planner.kept(step.path, asked) == HORIZON for step in steps)
    assert all(least_clearance(step.path, scene) > 0.0 for step in steps)


def test_some_steps_aside_end_where_no_room_is_left() -> None:
    """Between the way of the barrel and a wall behind there is room for a step, and none to go on."""
    back = {"type": "box", "center": [0.0, 0.5, 0.75], "size": [4.0, 1.0, 0.1]}
    scene = Scene.from_dict({**crossed().to_dict(), "obstacles": [back]})
    start = RootState(z=1.72)
    steps = list(RootPlanner(BODY, scene).steps_aside(Asked(start, Command(), HORIZON, INTERVAL, 0.8)))
    back_again = [step.path.states for step in steps if step.path.states[-1, 1] < 1.6]
    assert back_again
    assert all(np.abs(states[-1, 3:5]).max() < 1e-6 for states in back_again)


@pytest.mark.parametrize("later", [0.0, 0.04, 0.1, 0.15, 0.31])
def test_what_is_left_of_a_free_path_is_free_whenever_that_is_asked(later: float) -> None:
    scene, asked_at = crossed(), 0.2
    planner, start = RootPlanner(BODY, scene), RootState(z=0.4, forward=1.1)
    plan = next(iter(planner.candidates(Asked(start, FORWARD, HORIZON, INTERVAL, asked_at))))
    assert plan.free
    time = asked_at + later
    horizon = math.floor((plan.path.times[-1] - time) / INTERVAL + 1e-6)
    left = RootPath(time, INTERVAL, plan.path.sample(time + INTERVAL * np.arange(horizon + 1.0)))
    here = RootState.of(left.states[0])
    assert planner.kept(left, Asked(here, FORWARD, HORIZON, INTERVAL, time)) == horizon
