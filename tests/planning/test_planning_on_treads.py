"""Legs on stairs: the walking cycle goes up and down them in whatever phase one comes, and touches nothing."""

import math
from itertools import product
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.gait.stride import phase_rate, quickness
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import HEIGHT, RISES, RootState
from elbowroom.clips.motion_set import STOCK
from elbowroom.control.feet.arms_beside_legs import arms_beside_legs
from elbowroom.planning.command import Command
from elbowroom.planning.exact.sweep.own_motion import OwnMotion, own_parts
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.levers import body_levers
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.root.legs.lower_body import LowerBody
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlanKind
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.world.ground.ground import eased_height, heights_along
from elbowroom.world.scene import Scene
from stairs import RISE, TURN, spiral_stair, tread_top

AVATAR = Humanoid.default()
STAIR = spiral_stair()
FIRST, STEP = math.radians(290.0), 0.03  # where a walk on the treads begins; seconds between states


def around(radius: float, speed: float, phase: float, *, up: bool) -> NDArray[np.float64]:
    """Root states of an even walk on a circle, up or down the stair."""
    body = LowerBody(AVATAR, STAIR.obstacles, STAIR.ground)
    along = 1.0 if up else -1.0
    rate = quickness(body.model.gait.scale) * phase_rate(speed, 0.0, -along * speed / radius)
    times = np.arange(0.0, 2.8 * radius / speed, STEP)
    angles = (FIRST if up else FIRST + 2.8) + along * speed / radius * times
    rows = np.zeros((len(times), len(RootState._fields)))
    rows[:, 0], rows[:, 1] = radius * np.cos(angles), radius * np.sin(angles)
    rows[:, 2] = np.arctan2(-along * np.sin(angles), along * np.cos(angles))
    rows[:, 3], rows[:, 5], rows[:, 6] = speed, -along * speed / radius, phase + rate * times
    near = (rows[0, 0], tread_top(0) + RISE * (angles[0] - FIRST + 2.0 * TURN) / TURN, rows[0, 1])
    for row in rows:
        row[HEIGHT] = eased_height(STAIR.ground, near, row[0], row[1])
        near = row[0], row[HEIGHT], row[1]
    return rows


@pytest.mark.parametrize("up", [True, False], ids=["up", "down"])
@pytest.mark.parametrize("radius", [0.55, 0.65])
def test_a_walk_on_the_treads_of_a_spiral_touches_none(radius: float, up: bool) -> None:
    body, worst = LowerBody(AVATAR, STAIR.obstacles, STAIR.ground), math.inf
    for speed, phase in ((0.2, 0.0), (0.3, 0.5)):
        rows = around(radius, speed, phase, up=up)
        stood, found = body.footing.stood(rows)
        assert found.all(), "a foot has nothing to stand on"
        assert np.abs(stood[:, [RISES, RISES + 2]]).max() < 0.9
        worst = min(worst, float(body.clearance(body.near(0.0, 0.0, 4.0, 1.0), rows).min()))
    assert worst >= 0.0


def test_who_walks_naturally_runs_into_no_part_of_the_own_body_on_treads() -> None:
    """Head and trunk keep clear of knees that are raised, and so do arms that make way: no plan looks at these."""
    model, arms, gave_way = body_model(AVATAR), arms_beside_legs(AVATAR, STOCK), 0.0
    pairs, body = self_pairs(model), LowerBody(AVATAR, STAIR.obstacles, STAIR.ground)
    own = OwnMotion(own_parts(model, pairs, body_levers(AVATAR)), body.footing.underfoot)
    for up, phase in product((True, False), (0.0, 0.5)):
        path = RootPath(0.0, STEP, body.footing.stood(around(0.5, 0.3, phase, up=up))[0])
        keys = natural_walk()(path)
        gaps, groups = own.proven(path, keys, np.zeros_like(keys), keys)
        assert np.isinf(gaps).all()
        assert (groups == -1).all()
        shown = np.array([arms.apart(state, upper) for state, upper in zip(path.states, keys, strict=True)])
        assert self_clearances(model, pairs, path.states, shown).min() >= 0.0
        gave_way = max(gave_way, float(np.abs(shown - keys).max()))
    assert gave_way > 0.01, "no knee came to a hand"


def test_what_feet_stand_on_is_the_same_when_it_is_known_again() -> None:
    """Motions that differ along one path, in the order in which a plan comes to them, against each by itself."""
    model, body = body_model(AVATAR), LowerBody(AVATAR, STAIR.obstacles, STAIR.ground)
    parts = own_parts(model, self_pairs(model), body_levers(AVATAR))
    path = RootPath(0.0, STEP, body.footing.stood(around(0.5, 0.3, 0.0, up=True))[0][:20])
    walk, together = natural_walk()(path), OwnMotion(parts, body.footing.underfoot)
    for lifted in (0.3, 0.6, 0.3):
        keys = walk + lifted
        asked = path, keys, np.zeros_like(keys), walk
        for one, other in zip(
            together.proven(*asked), OwnMotion(parts, body.footing.underfoot).proven(*asked), strict=True
        ):
            np.testing.assert_array_equal(one, other)


def even_stair(rise: float, deep: float, count: int) -> Scene:
    """A stair that begins 2 m ahead, and what it leads to."""
    boxes: list[dict[str, Any]] = []
    for begin, top in ((2.0 + deep * i, rise * (i + 1)) for i in range(count)):
        middle = 0.5 * (begin + 8.0)
        boxes.append({"type": "box", "center": [0.0, 0.5 * top, middle], "size": [1.8, top, 8.0 - begin]})
    return Scene.of("stair", boxes, finish=(0.0, 6.0))


@pytest.mark.parametrize("heading", [0.0, math.pi], ids=["up", "down"])
@pytest.mark.parametrize("rise", [0.05, 0.17])
def test_wherever_and_in_whatever_phase_one_comes_to_an_even_stair_one_walks_on(rise: float, heading: float) -> None:
    scene = even_stair(rise, 0.28, 4)
    planner, rng = RootPlanner(AVATAR, scene), np.random.default_rng(4)
    walk = np.stack([np.zeros(81), np.linspace(0.0, 4.0, 81)], axis=1)
    heights = heights_along(scene.ground, 0.0, walk)
    for _ in range(12):
        place, phase, speed = rng.uniform((0.5, 0.0, 0.0), (3.9, 1.0, 1.1)).tolist()
        near = float(heights[round(20.0 * place)])
        height = eased_height(scene.ground, (0.0, near, place), 0.0, place)
        start = RootState(0.0, place, heading, speed, phase=phase, height=height)
        planner.reset()
        plan = planner.plan(Asked(start, Command(forward=1.0), 16, 0.15))
        assert plan.kind is RootPlanKind.STRAIGHT, start
