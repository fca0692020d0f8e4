import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOWERING, DofGroup, limits
from elbowroom.body.kinematics import body_model, posture_capsules
from elbowroom.body.proportions import proportional_humanoid
from elbowroom.planning.lowered_legs import LoweredLegs
from elbowroom.world.boxes import Boxes
from elbowroom.world.clearance import clearance_of

Floats = NDArray[np.float64]

HUMANOID = proportional_humanoid(1.72)
MODEL = body_model(HUMANOID)
LEGS = HUMANOID.capsules.of(DofGroup.ROOT)
DEEPEST = float(limits(DofGroup.WAIST)[2, 1])


def random_boxes(rng: np.random.Generator, count: int) -> Boxes:
    turns = rng.normal(size=(count, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    centers = rng.uniform([-2.0, 0.0, -2.0], [2.0, 2.2, 2.0], (count, 3))
    return Boxes(centers + np.array([300.0, 0.0, -200.0]), turns, rng.uniform(0.02, 0.2, (count, 3)))


def random_states(rng: np.random.Generator, count: int) -> tuple[Floats, Floats]:
    roots = rng.uniform([-1.5, -1.5, -4, -0.6, -0.5, -1, -3], [1.5, 1.5, 4, 2.0, 0.5, 1, 3], (count, 7))
    roots[:, :2] += [300.0, -200.0]
    return roots, rng.choice([0.0, 1.0], count) * rng.uniform(0.0, DEEPEST, count)


def naive(boxes: Boxes, root: Floats, lowering: float) -> float:
    q = np.zeros(DOF)
    q[LOWERING] = lowering
    here, table = root.copy(), boxes.table.copy()
    here[:2] = 0.0
    table[:, [0, 2]] -= root[:2]
    segments = posture_capsules(MODEL, q, here)[LEGS][:, :, 0]
    return float(clearance_of(segments, HUMANOID.capsules.radii[LEGS], table))


def test_clearances_are_those_of_the_whole_body_posed() -> None:
    rng = np.random.default_rng(1)
    boxes = random_boxes(rng, 25)
    roots, lowerings = random_states(rng, 200)
    found = LoweredLegs(MODEL, boxes).clearances(roots, lowerings)
    expected = np.array([naive(boxes, *row) for row in zip(roots, lowerings, strict=True)])
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
            expected = naive(boxes, roots[k], float(lowerings[k]))
            assert found[k] == pytest.approx(expected, abs=1e-4) or (expected > 0.05 and found[k] > 0.05)


def test_a_lowering_touches_if_it_does_at_any_moment_of_its_row() -> None:
    rng = np.random.default_rng(3)
    boxes = random_boxes(rng, 25)
    roots, _ = random_states(rng, 24)
    roots = roots.reshape(6, 4, 7)
    lowerings = np.array([0.0, 0.4, 0.2, 0.4, 0.6])
    legs = LoweredLegs(MODEL, boxes)
    found = legs.touching(roots, lowerings, 0.02)
    for t in range(6):
        for v, lowering in enumerate(lowerings):
            each = legs.clearances(roots[t], np.full(4, lowering))
            assert found[t, v] == (each.min() < 0.02)
    assert found.any()
    assert not found[:, 0].any()


def test_no_boxes_no_contact() -> None:
    legs = LoweredLegs(MODEL, Boxes(np.empty((0, 3)), np.empty((0, 4)), np.empty((0, 3))))
    roots, lowerings = random_states(np.random.default_rng(4), 8)
    assert np.isinf(legs.clearances(roots, lowerings)).all()
