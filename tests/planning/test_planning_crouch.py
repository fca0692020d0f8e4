"""Under a beam among low boxes: what the exact planner finds leaves room for the bent knees too."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOWERING, DofGroup
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import body_model, leg_capsules, posture_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.key_frame_queue import KeyFrameQueue
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.sweep.crouch import ROUNDS, Crouch, node_waists
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.lowered_legs import LoweredLegs
from elbowroom.planning.result import PlanStatus
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

HUMANOID = proportional_humanoid(1.72)
MODEL = body_model(HUMANOID)
COLUMN = LOWERING - DofGroup.WAIST.at.start


def walk(horizon: int = 16, speed: float = 0.9) -> RootPath:
    states = np.zeros((horizon + 1, ROOT_STATE))
    time = 0.15 * np.arange(horizon + 1)
    states[:, 1], states[:, 3], states[:, 6] = speed * time, speed, 0.8 * time
    return RootPath(0.0, 0.15, states)


def scene(seed: int) -> Scene:
    """A low beam across the way, and boxes beside and before the knees that leave upright legs alone."""
    rng = np.random.default_rng(seed)
    count = 2
    side = rng.choice([-1.0, 1.0], count)
    halves = rng.uniform([0.02, 0.03, 0.05], [0.06, 0.1, 0.2], (count, 3))
    aside, up, ahead = rng.uniform([0.18, 0.4, 0.9], [0.27, 0.6, 1.7], (count, 3)).T
    centers = np.stack([side * (aside + halves[:, 0]), up, ahead], axis=1)
    boxes = Obstacles.boxes(
        np.concatenate([[[0.0, 1.4, 1.35]], centers]),
        np.tile([0.0, 0.0, 0.0, 1.0], (count + 1, 1)),
        np.concatenate([[[1.5, 0.1, 0.06]], halves]),
    )
    names = tuple(f"box {i}" for i in range(count + 1))
    return replace(Scene.load("empty"), obstacles=replace(boxes, standing_names=names))


def leaves_upright_legs_alone(made: Scene) -> bool:
    fine = np.linspace(0.0, 16.0, 200)
    states = np.stack([np.interp(fine, np.arange(17.0), column) for column in walk().states.T], axis=1)
    gaps = clearance(leg_capsules(MODEL, states), MODEL.roots.radii, made.obstacles.standing)
    return bool(gaps.min() > 0.005)


def shown_legs(made: Scene, path: RootPath, uppers: Floats) -> tuple[float, float]:
    """The least clearance of legs and pelvis as the queue plays it at 240 poses a second, and the deepest lowering."""
    queue = KeyFrameQueue(path.horizon, path.interval)
    queue.splice(path, uppers, np.zeros(LOCAL))
    roots, postures = [], []
    while not queue.empty:
        playback = queue.sample()
        roots.append(playback.root)
        postures.append(np.concatenate([playback.root[:3], playback.upper]))
        queue.advance(1 / 240)
    q = np.array(postures)
    capsules = posture_capsules(MODEL, q, np.array(roots))[MODEL.roots.indices]
    return float(clearance(capsules, MODEL.roots.radii, made.obstacles.standing).min()), float(q[:, LOWERING].max())


def planned(made: Scene, body: UpperBodyPlanner) -> tuple[float, float] | None:
    start = natural_walk()(walk(speed=0.0))[0]
    plan = body.plan(walk(), StartState(start, np.zeros(LOCAL))).plan
    return shown_legs(made, walk(), plan.configurations) if plan.status is PlanStatus.FOUND else None


def test_bent_knees_touch_nothing_and_would_if_nobody_looked() -> None:
    crouched = touching = 0
    for seed in range(16):
        made = scene(seed)
        if not leaves_upright_legs_alone(made):
            continue
        body = UpperBodyPlanner(HUMANOID, made, ExactSettings())
        found = planned(made, body)
        if found is not None:
            assert found[0] > 0.0, seed
            crouched += found[1] > 0.15
        body._legs = LoweredLegs(MODEL, Obstacles())
        blind = planned(made, body)
        touching += blind is not None and blind[0] < 0.0
    assert crouched >= 3
    assert touching >= 2


def test_what_feet_stand_on_is_looked_up_once_for_all_ways_of_the_waist(monkeypatch: pytest.MonkeyPatch) -> None:
    shown, blocked = LoweredLegs.shown, LoweredLegs.blocked_intervals
    looked, ways = list[RootPath](), list[RootPath]()

    def seen(legs: LoweredLegs, path: RootPath) -> Floats:
        looked.append(path)
        return shown(legs, path)

    def held(legs: LoweredLegs, path: RootPath, *told: Any) -> NDArray[np.bool_]:
        ways.append(path)
        return blocked(legs, path, *told)

    monkeypatch.setattr(LoweredLegs, "shown", seen)
    monkeypatch.setattr(LoweredLegs, "blocked_intervals", held)
    for seed in range(6):
        start = natural_walk()(walk(speed=0.0))[0]
        UpperBodyPlanner(HUMANOID, scene(seed), ExactSettings()).plan(
            walk(), StartState(start, np.zeros(LOCAL)), effort=Effort.QUICK
        )
    assert len(ways) > 2 * len(looked) > 0


def wall_before_the_knees() -> LoweredLegs:
    """A step before the feet that upright legs do not reach, and bent knees do."""
    boxes = Obstacles.boxes(
        np.array([[0.0, 0.45, 0.31]]), np.array([[0.0, 0.0, 0.0, 1.0]]), np.array([[0.5, 0.06, 0.05]])
    )
    return LoweredLegs(MODEL, boxes)


def standing(horizon: int = 6) -> RootPath:
    return RootPath(0.0, 0.15, np.zeros((horizon + 1, ROOT_STATE)))


def way(depth: float) -> tuple[Floats, Floats]:
    keys = np.zeros((7, DofGroup.WAIST.size))
    keys[3:5, COLUMN] = depth
    return keys, np.zeros_like(keys)


def nowhere(keys: Floats, velocities: Floats) -> NDArray[np.bool_]:
    """The trunk keeps off the thighs."""
    return np.zeros(len(keys) - 1, np.bool_)


def crouched(
    legs: LoweredLegs,
    lowerings: Floats,
    folds: Callable[[Floats, Floats], NDArray[np.bool_]] = nowhere,
) -> Crouch:
    """Standing on `legs` in postures of these `lowerings` (7, V), not bent."""
    nodes = np.zeros((*lowerings.shape, DofGroup.WAIST.size))
    nodes[..., COLUMN] = lowerings
    return Crouch(legs, standing(), lambda: nodes, folds, lambda: legs.shown(standing()))


def test_who_stays_upright_is_not_looked_at() -> None:
    extra = np.zeros((7, 9), np.float32)
    crouch = crouched(wall_before_the_knees(), np.tile(np.linspace(0.0, 0.7, 9), (7, 1)))
    assert not crouch.rules_out(*way(0.0), extra)
    assert not extra.any()


def test_nodes_whose_legs_touch_are_ruled_out_and_no_others() -> None:
    legs, lowerings = wall_before_the_knees(), np.linspace(0.0, 0.7, 9)
    extra = np.zeros((7, 9), np.float32)
    crouch = crouched(legs, np.tile(lowerings, (7, 1)))
    assert crouch.rules_out(*way(0.7), extra)
    touching = legs.clearances(np.zeros((9, 7)), lowerings) < 0.01
    assert 0 < touching.sum() < 8
    np.testing.assert_array_equal(np.isinf(extra), np.tile(touching, (7, 1)))
    assert not crouch.rules_out(*way(float(lowerings[~touching].max())), extra)


def test_in_the_end_nobody_crouches() -> None:
    lowerings = np.tile(np.linspace(0.0, 0.7, 9), (7, 1))
    extra = np.zeros((7, 9), np.float32)
    crouch = crouched(wall_before_the_knees(), lowerings)
    closed = []
    for _ in range(ROUNDS - 1):
        assert crouch.rules_out(*way(0.7), extra)
        closed.append(int(np.isinf(extra).sum()))
    assert closed == sorted(closed)
    np.testing.assert_array_equal(np.isinf(extra[1:]), lowerings[1:] > 0.0)


def test_every_node_has_its_waist() -> None:
    rng = np.random.default_rng(0)
    postures, goals, previous, start = (rng.uniform(size=shape) for shape in ((5, 3), (4, 3), (4, 3), (3,)))
    found = node_waists(postures, goals, previous, start)
    assert found.shape == (4, 9, 3)
    for t in range(4):
        np.testing.assert_array_equal(found[t, :5], postures)
        np.testing.assert_array_equal(found[t, 5:], [goals[t], previous[t], start, np.maximum(start, goals[t])])


def test_who_would_lay_the_trunk_on_the_thighs_comes_up() -> None:
    lowerings = np.tile(np.linspace(0.0, 0.7, 9), (7, 1))
    extra = np.zeros((7, 9), np.float32)
    crouch = crouched(LoweredLegs(MODEL, Obstacles()), lowerings, lambda keys, _: keys[1:, COLUMN] > 0.55)
    assert crouch.rules_out(*way(0.7), extra)
    assert np.isinf(extra[3, -1])
    assert not np.isinf(extra[0]).any()
    assert not crouch.rules_out(*way(0.5), extra)


def test_who_bends_less_may_crouch_and_who_crouches_less_may_bend() -> None:
    bends, lowerings = (grid.ravel() for grid in np.meshgrid([0.0, 0.4, 0.8, 1.2], [0.0, 0.3, 0.6]))
    nodes = np.zeros((7, len(bends), DofGroup.WAIST.size))
    nodes[..., 0], nodes[..., COLUMN] = bends, lowerings
    legs, extra = LoweredLegs(MODEL, Obstacles()), np.zeros((7, len(bends)), np.float32)

    def folds(keys: Floats, _: Floats) -> NDArray[np.bool_]:
        return (keys[1:, 0] > 0.7) & (keys[1:, COLUMN] > 0.2)

    crouch = Crouch(legs, standing(), lambda: nodes, folds, lambda: legs.shown(standing()))
    keys, velocities = way(0.3)
    keys[3:5, 0] = 0.8
    assert crouch.rules_out(keys, velocities, extra)
    as_deep = (bends > 0.7) & (lowerings > 0.2)
    np.testing.assert_array_equal(np.isinf(extra[3]), as_deep)
    assert not np.isinf(extra[[0, 1, 6]]).any()  # it stands upright there
    for bend, lowering in ((0.4, 0.6), (1.2, 0.0)):
        keys, velocities = way(lowering)
        keys[3:5, 0] = bend
        assert not crouch.rules_out(keys, velocities, extra)
