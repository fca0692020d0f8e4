import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOWERING, DofGroup, limits
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.planning.interpolation import hermite, monotone_tangents
from elbowroom.planning.model.footing import Footing
from elbowroom.planning.model.lowered_legs import LoweredLegs
from elbowroom.planning.root.path import RootPath, sample_states
from elbowroom.world.ground.ground import PLAIN
from elbowroom.world.obstacles.clearance import clearance_of
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import about
from elbowroom.world.obstacles.shapes import Box
from elbowroom.world.obstacles.tracks.moving import Moving, Repeat, Track

Floats = NDArray[np.float64]

HUMANOID = proportional_humanoid(1.72)
MODEL = body_model(HUMANOID)
FEET = Footing(MODEL, PLAIN).feet
LEGS = np.delete(HUMANOID.capsules.of(DofGroup.ROOT), FEET)
DEEPEST = float(limits(DofGroup.WAIST)[2, 1])


def random_boxes(rng: np.random.Generator, count: int) -> Obstacles:
    turns = rng.normal(size=(count, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    centers = rng.uniform([-2.0, 0.0, -2.0], [2.0, 2.2, 2.0], (count, 3))
    return Obstacles.boxes(centers + np.array([300.0, 0.0, -200.0]), turns, rng.uniform(0.02, 0.2, (count, 3)))


def random_states(rng: np.random.Generator, count: int) -> tuple[Floats, Floats]:
    roots = rng.uniform([-1.5, -1.5, -4, -0.6, -0.5, -1, -3], [1.5, 1.5, 4, 2.0, 0.5, 1, 3], (count, 7))
    roots[:, :2] += [300.0, -200.0]
    return roots, rng.choice([0.0, 1.0], count) * rng.uniform(0.0, DEEPEST, count)


def walk(horizon: int) -> RootPath:
    states = np.zeros((horizon + 1, 7))
    t = 0.15 * np.arange(horizon + 1)
    states[:, 0], states[:, 1], states[:, 3], states[:, 6] = 300.0, -200.5 + 1.1 * t, 1.1, 0.9 * t
    return RootPath(0.0, 0.15, states)


def naive(near: Nearby, root: Floats, lowering: float) -> float:
    q = np.zeros(DOF)
    q[LOWERING] = lowering
    here = root.copy()
    here[:2] = 0.0
    segments = posture_capsules(MODEL, q, here)[LEGS][:, :, 0]
    return float(clearance_of(segments, HUMANOID.capsules.radii[LEGS], about(near, root[0], root[1])))


def test_clearances_are_those_of_the_whole_body_posed() -> None:
    rng = np.random.default_rng(1)
    boxes = random_boxes(rng, 25)
    roots, lowerings = random_states(rng, 200)
    found = LoweredLegs(MODEL, boxes).clearances(roots, lowerings)
    expected = np.array([naive(boxes.standing, *row) for row in zip(roots, lowerings, strict=True)])
    assert np.isinf(found[lowerings == 0.0]).all()
    near = np.isfinite(found)
    np.testing.assert_allclose(found[near & (expected < 0.1)], expected[near & (expected < 0.1)], atol=1e-5)
    assert (expected[near] < 0.0).any()
    # whoever is left out is far away
    assert (expected[~near & (lowerings > 0.0)] > 0.0).all()


def test_far_and_high_boxes_are_left_out_and_nothing_else() -> None:
    rng = np.random.default_rng(2)
    for _ in range(40):
        boxes = random_boxes(rng, 3)
        roots, lowerings = random_states(rng, 5)
        found = LoweredLegs(MODEL, boxes).clearances(roots, lowerings)
        for k in np.flatnonzero(lowerings > 0.0):
            expected = naive(boxes.standing, roots[k], float(lowerings[k]))
            assert found[k] == pytest.approx(expected, abs=1e-4) or (expected > 0.05 and found[k] > 0.05)


def test_a_node_is_blocked_by_what_its_legs_touch_around_its_key_time() -> None:
    rng = np.random.default_rng(3)
    boxes, path = random_boxes(rng, 80), walk(6)
    lowerings = rng.choice([0.0, 0.4], (7, 5)) * rng.uniform(0.5, 1.5, (7, 5))
    legs = LoweredLegs(MODEL, boxes)
    found = legs.blocked_nodes(path, lowerings, 0.02)
    for t, v in np.ndindex(7, 5):
        times = np.clip(t + np.array([-0.5, -0.25, 0.0, 0.25, 0.5]), 0.0, 6.0) * path.interval
        each = legs.clearances(sample_states(path.states, path.interval, times), np.full(5, lowerings[t, v]))
        assert found[t, v] == (each.min() < 0.02)
    assert found.any()
    assert not found[lowerings == 0.0].any()


def test_an_interval_is_blocked_by_what_is_shown_in_it() -> None:
    rng = np.random.default_rng(5)
    seen = set()
    for _ in range(30):
        boxes, path = random_boxes(rng, 8), walk(6)
        legs = LoweredLegs(MODEL, boxes)
        keys = np.clip(rng.uniform(-0.3, 0.6, 7), 0.0, None)
        times = path.interval * np.arange(7.0)
        tangents = monotone_tangents(times, keys[:, None], np.zeros(1))
        found = legs.blocked_intervals(path, keys, tangents[:, 0], 0.01)
        for k in range(6):
            at = times[k] + path.interval * np.arange(12) / 12
            shown = np.array([hermite(times, keys[:, None], tangents, float(time))[0][0] for time in at])
            each = legs.clearances(sample_states(path.states, path.interval, at), shown)
            assert found[k] == (each.min() < 0.01)
            seen.add(bool(found[k]))
    assert seen == {True, False}


def test_no_boxes_no_contact() -> None:
    legs = LoweredLegs(MODEL, Obstacles())
    roots, lowerings = random_states(np.random.default_rng(4), 8)
    assert np.isinf(legs.clearances(roots, lowerings)).all()


def test_what_moves_is_where_it_is_then() -> None:
    """A box crosses the way: no clearance is more than that from the box as it stands at the moment."""
    path, size = walk(12), Box((0.4, 0.8, 0.4))
    centers = np.array([[298.5, 0.4, -199.5], [301.5, 0.4, -199.5]])
    track = Track("crossing", size, np.array([0.0, 1.8]), centers, np.zeros(2), Repeat.ONCE)
    moving = Moving((track,))
    nothing = random_boxes(np.random.default_rng(0), 0)
    legs = LoweredLegs(MODEL, nothing).among(moving, path)
    times = np.linspace(0.0, 1.79, 90)
    roots, lowerings = sample_states(path.states, path.interval, times), np.full(90, 0.4)
    found = legs.clearances(roots, lowerings, times)
    expected = np.array([naive(moving.at(t), root, 0.4) for t, root in zip(times, roots, strict=True)])
    assert np.all(found <= expected + 1e-5)
    assert np.all(found >= expected - 0.3)  # what it sweeps in a key interval
    keys = np.full(13, 0.4)
    blocked = legs.blocked_intervals(path, keys, np.zeros(13), 0.02)
    hit = np.unique((times[expected < 0.0] / path.interval).astype(int))
    assert len(hit)
    assert blocked[hit].all()
    assert not blocked.all()
    assert legs.among(Moving(), path) is legs
