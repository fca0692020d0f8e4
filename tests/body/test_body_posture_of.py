"""From rotations back to the planning degrees of freedom."""

import numpy as np
import pytest

from elbowroom.body.dof import DOF, LOCAL_GROUPS, DofGroup, clamp, limits
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, local_rotations
from elbowroom.body.pose.posture_of import arm_angles, arm_directions, chest_rotation, waist_angles
from elbowroom.geometry import quaternion

SIDES = {DofGroup.LEFT_ARM: "left", DofGroup.RIGHT_ARM: "right"}


def random_posture(rng: np.random.Generator) -> np.ndarray:
    q = np.zeros(DOF)
    for group in LOCAL_GROUPS:
        q[group.at] = clamp(group, rng.uniform(*limits(group).T))
    return q


def test_posing_and_back_gives_the_same_configuration() -> None:
    humanoid = Humanoid.default()
    model, skeleton = body_model(humanoid), humanoid.skeleton
    chest = model.tree.chest
    rng = np.random.default_rng(1)
    for _ in range(200):
        q = random_posture(rng)
        turns = local_rotations(model, q, np.zeros(7))
        turns[0] = quaternion.IDENTITY  # all else is told against hips, which lean as they go down
        for joint in range(1, len(turns)):
            turns[joint] = quaternion.multiply(turns[skeleton.parents[joint]], turns[joint])
        np.testing.assert_allclose(waist_angles(turns[chest]), q[DofGroup.WAIST.at][:2], atol=1e-9)
        back = quaternion.conjugate(turns[chest])
        for group, side in SIDES.items():
            upper, lower = (
                quaternion.multiply(back, turns[skeleton.index(side + b)]) for b in ("UpperArm", "LowerArm")
            )
            np.testing.assert_allclose(arm_angles(upper, lower, side), q[group.at], atol=1e-9)


@pytest.mark.parametrize("side", ["left", "right"])
def test_any_arm_keeps_the_directions_of_its_bones(side: str) -> None:
    rng = np.random.default_rng(2)
    upper, lower = quaternion.normalize(rng.standard_normal((2, 500, 4)))
    outwards = np.array([1.0 if side == "left" else -1.0, 0.0, 0.0])
    first, second = arm_directions(arm_angles(upper, lower, side), side)
    np.testing.assert_allclose(first, quaternion.rotate(upper, outwards), atol=1e-9)
    # the upper arm's roll has a say in the forearm's plane, which matters where the elbow is all but straight
    away = np.linalg.norm(second - quaternion.rotate(lower, outwards), axis=1)
    straight = np.abs(np.sum(first * second, axis=1)) > 0.9
    assert away[~straight].max() < 0.15
    assert away.max() < 0.7


def test_the_waist_is_the_nearest_of_all() -> None:
    rng = np.random.default_rng(3)
    chests = quaternion.normalize(rng.standard_normal((100, 4)))
    best = np.abs(np.sum(chest_rotation(waist_angles(chests)) * chests, axis=1))
    others = rng.uniform(-np.pi, np.pi, (4000, 2))
    found = np.abs(chest_rotation(others) @ chests.T)
    assert (best >= found.max(axis=0) - 1e-9).all()
