"""A body against itself: tables against coal and against one pair after the other, the natural walk free for anyone."""

from dataclasses import replace
from pathlib import Path

import coal
import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.clips.stock_clips import HANGING
from elbowroom.body.dof import (
    ARMS,
    CHILDREN,
    DOF,
    LOCAL,
    LOCAL_GROUPS,
    SEARCH_ORDER,
    DofGroup,
    clamp,
    columns_of,
    limits,
)
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, group_capsules, posture_capsules
from elbowroom.geometry import quaternion
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.axis_distances import arm_clearances, clear_pairs, lower_to_body
from elbowroom.planning.model.self_contact import axis_distance
from elbowroom.planning.model.self_pairs import (
    EXEMPT,
    OVERLAP,
    seen_from_chest,
    self_clearances,
    self_pairs,
)
from elbowroom.planning.root.path import RootPath
from sampled import sampled
from shared_data import SHARED, needs_shared

Floats = NDArray[np.float64]


def random_uppers(rng: np.random.Generator, count: int) -> Floats:
    parts = []
    for group in LOCAL_GROUPS:
        low, high = limits(group).T
        parts.append(clamp(group, rng.uniform(0.6 * low, 0.6 * high, (count, group.size))))
    return np.concatenate(parts, axis=1)


def random_roots(rng: np.random.Generator, count: int) -> Floats:
    roots = rng.uniform(-1.0, 1.0, (count, 7))
    roots[:, 3:6] *= [1.2, 0.2, 0.5]
    return roots


def test_axis_distances_equal_the_double_precision_twin() -> None:
    rng = np.random.default_rng(0)
    first, second = rng.uniform(-0.5, 0.5, (2, 6, 4000)).astype(np.float32)
    second[3:, :500] = second[:3, :500] + (first[3:, :500] - first[:3, :500])  # parallel
    first[3:, 500:600] = first[:3, 500:600]  # points
    expected = [axis_distance(a.astype(float), b.astype(float)) for a, b in zip(first.T, second.T, strict=True)]
    assert np.allclose(clear_pairs(first, second), expected, atol=2e-5)


def coal_distance(ends: Floats, radius: float, other_ends: Floats, other_radius: float) -> float:
    def placed(segment: Floats, size: float) -> tuple[object, object]:
        along = segment[3:] - segment[:3]
        length = float(np.linalg.norm(along))
        turn = quaternion.to_matrix(quaternion.between([0.0, 0.0, 1.0], along if length > 1e-9 else [0.0, 0.0, 1.0]))
        shape = coal.Capsule(size, length) if length > 1e-9 else coal.Sphere(size)
        return shape, coal.Transform3s(turn, 0.5 * (segment[:3] + segment[3:]))

    one, other = placed(ends, radius), placed(other_ends, other_radius)
    return float(coal.distance(*one, *other, coal.DistanceRequest(), coal.DistanceResult()))


def test_tables_agree_with_the_whole_body_in_the_world_judged_by_coal() -> None:
    """Arm under waist and arm beside arm, each from its own table, against coal's distances of the posed body."""
    humanoid, rng = proportional_humanoid(1.72), np.random.default_rng(1)
    model, count = body_model(humanoid), 12
    pairs = self_pairs(model)
    uppers, roots = random_uppers(rng, count), random_roots(rng, count)
    q = np.zeros((count, DOF))
    q[:, DOF - uppers.shape[1] :] = uppers
    q[:, :3] = roots[:, :3]
    world, radii = posture_capsules(model, q, roots).astype(np.float64), humanoid.capsules.radii
    parts = {group: np.ascontiguousarray(uppers[:, columns_of(group)]) for group in CHILDREN}
    segments = {group: group_capsules(model, group, part) for group, part in parts.items()}
    left, right = ARMS
    table = arm_clearances(segments[left], segments[right], np.ascontiguousarray(pairs.allowed[right, left].T))
    for n in range(count):
        least = dict.fromkeys(SEARCH_ORDER, np.inf)
        for (group, other), allowed in pairs.allowed.items():
            capsules = pairs.capsules[other]
            crossing = min(
                coal_distance(world[a, :, n], radii[a], world[k, :, n], radii[k])
                + (radii[a] + radii[k] - allowed[i, j])
                for i, a in enumerate(pairs.capsules[group])
                for j, k in enumerate(capsules)
                if allowed[i, j] > EXEMPT
            )
            least[group] = min(least[group], crossing)
            if group not in CHILDREN:
                continue
            bodies = seen_from_chest(model, uppers[n : n + 1], roots[n : n + 1])[capsules, :, 0]
            gap = np.full(1, np.inf, np.float32)
            own = segments[group][:, :, n : n + 1].copy()
            lower_to_body(own, np.ascontiguousarray(bodies), allowed, np.ones(len(capsules), np.bool_), gap)
            assert np.isclose(gap[0], crossing, atol=1e-4) or min(float(gap[0]), crossing) < -0.1
            if (group, other) == (right, left):
                assert np.isclose(table[n, n], crossing, atol=1e-4) or min(table[n, n], crossing) < -0.1
        whole = self_clearances(model, pairs, roots[n : n + 1], uppers[n : n + 1])[:, 0]
        for mine, theirs in zip(whole, least.values(), strict=True):
            assert np.isclose(mine, theirs, atol=1e-4) or min(mine, theirs) < -0.1


def natural_clearance(humanoid: Humanoid) -> float:
    rng = np.random.default_rng(2)
    states = np.zeros((200, 7))
    states[:, 3], states[:, 6] = rng.uniform(0.0, 2.2, 200), rng.uniform(0.0, 1.0, 200)
    uppers = natural_walk()(RootPath(0.0, 1.0, states))
    model = body_model(humanoid)
    return float(self_clearances(model, self_pairs(model), states, uppers).min())


@pytest.mark.parametrize("height", [1.1, 1.72, 2.0])
def test_the_natural_walk_is_free_of_itself(height: float) -> None:
    assert natural_clearance(proportional_humanoid(height)) > 0.5 * OVERLAP


def _avatars() -> list[Path]:
    return sorted((SHARED / "avatars").glob("vrm*/*.vrm"))[:6] if SHARED else []


@needs_shared
@pytest.mark.parametrize("file", sampled(_avatars(), 3), ids=lambda file: file.stem)
def test_the_natural_walk_of_real_avatars_is_free_of_itself(file: Path) -> None:
    assert natural_clearance(Humanoid.load(file)) > 0.5 * OVERLAP


def test_arms_through_body_and_through_each_other_are_found() -> None:
    humanoid = proportional_humanoid(1.72)
    model = body_model(humanoid)
    pairs = self_pairs(model)
    uppers = np.zeros((3, sum(group.size for group in LOCAL_GROUPS)))
    start = DofGroup.LEFT_ARM.at.start - DofGroup.WAIST.at.start
    arm = DofGroup.LEFT_ARM.size
    hanging = natural_walk()(RootPath(0.0, 1.0, np.zeros((2, 7))))[0]
    uppers[:] = hanging
    uppers[0, start : start + arm] = np.deg2rad([20.0, -30.0, 70.0, 120.0])  # forearm through the belly
    uppers[1, start : start + 2 * arm] = np.deg2rad([80.0, -35.0, 0.0, 10.0] * 2)  # arms crossed straight ahead
    found = self_clearances(model, pairs, np.zeros((3, 7)), uppers).min(axis=0)
    assert found[0] < 0.0
    assert found[1] < 0.0
    assert found[2] > 0.0


def test_an_arm_beside_the_face_is_free_or_not_by_where_the_head_turns() -> None:
    model, rng = body_model(proportional_humanoid(1.72)), np.random.default_rng(3)
    uppers = np.zeros((2000, LOCAL))
    arm, head = columns_of(DofGroup.LEFT_ARM), columns_of(DofGroup.HEAD)
    low, high = limits(DofGroup.LEFT_ARM).T
    uppers[:, arm] = clamp(DofGroup.LEFT_ARM, rng.uniform(low, high, (2000, 4)))
    uppers[:, columns_of(DofGroup.RIGHT_ARM)] = HANGING
    free = []
    for nod, turn in ((0.0, 0.0), (0.7, 0.9)):
        uppers[:, head] = nod, turn
        free.append(self_clearances(model, self_pairs(model), np.zeros((2000, 7)), uppers).min(axis=0) >= 0.0)
    assert np.sum(free[0] & ~free[1]) > 5
    assert np.sum(free[1] & ~free[0]) > 5


def test_who_has_a_broad_head_may_look_over_a_shoulder_with_any_arm() -> None:
    humanoid = proportional_humanoid(1.72)
    capsules = humanoid.capsules
    broad = np.where([name == "head" for name in capsules.names], 1.5, 1.0)
    model = body_model(replace(humanoid, capsules=replace(capsules, radii=broad * capsules.radii)))
    looking = np.tile(natural_walk()(RootPath(0.0, 1.0, np.zeros((1, 7)))), (3, 1))
    looking[:, columns_of(DofGroup.HEAD).start + 1] = 0.0, *limits(DofGroup.HEAD)[1]
    assert (self_clearances(model, self_pairs(model), np.zeros((3, 7)), looking) >= 0.0).all()


@pytest.mark.parametrize("forward", [0.0, 0.5, 1.1, -0.7])
def test_hands_keep_off_the_legs_of_who_steps_sideways(forward: float) -> None:
    model, goals = body_model(Humanoid.default()), natural_walk()
    pairs = self_pairs(model, goals)
    phases = np.arange(24) / 24
    for lateral in (-0.6, -0.3, 0.15, 0.45, 0.8):
        roots = np.zeros((len(phases), 7))
        roots[:, 3], roots[:, 4], roots[:, 6] = forward, lateral, phases
        uppers = goals(RootPath(0.0, 1.0, roots))
        assert self_clearances(model, pairs, roots, uppers).min() > 0.0
