import numpy as np
import pytest

from elbowroom.body.bones import REQUIRED
from elbowroom.body.dof import DOF, LOCAL_GROUPS, MAX_ELEVATION, DofGroup, clamp, limits, within_limits
from elbowroom.body.fitting.proportions import (
    proportional_capsules,
    proportional_humanoid,
    proportional_skeleton,
    stature,
)
from naive_pose import required_only

LEGS = ["pelvis", "leftThigh", "rightThigh", "leftShin", "rightShin", "leftFoot", "rightFoot"]
TRUNK = ["abdomen", "torso", "chest", "shoulders", "neck", "head"]
ARMS = ["leftUpperArm", "leftForearm", "leftHand", "rightUpperArm", "rightForearm", "rightHand"]


@pytest.mark.parametrize("height", [1.2, 1.72, 2.0])
def test_skeleton_is_a_mirrored_tree_of_this_stature(height: float) -> None:
    skeleton = proportional_skeleton(height)
    assert skeleton.names[0] == "hips"
    assert skeleton.parents[0] == -1
    assert all(0 <= parent < i for i, parent in enumerate(skeleton.parents) if i)
    assert set(skeleton.names) >= REQUIRED
    assert stature(skeleton) == pytest.approx(height)
    for name, place in zip(skeleton.names, skeleton.positions, strict=True):
        if name.startswith("left"):
            mirrored = skeleton.positions[skeleton.index("right" + name[4:])]
            np.testing.assert_allclose(mirrored, place * [-1.0, 1.0, 1.0], atol=1e-12)


def test_segment_lengths_are_those_of_drillis_and_contini() -> None:
    skeleton = proportional_skeleton(1.0)
    lengths = {("UpperArm", "LowerArm"): 0.186, ("LowerArm", "Hand"): 0.146, ("UpperLeg", "LowerLeg"): 0.245}
    for (a, b), expected in lengths.items():
        span = skeleton.positions[skeleton.index(f"left{b}")] - skeleton.positions[skeleton.index(f"left{a}")]
        assert np.linalg.norm(span) == pytest.approx(expected)


@pytest.mark.parametrize("full", [True, False])
def test_capsules_cover_the_body_in_the_agreed_order(full: bool) -> None:
    skeleton = proportional_skeleton(1.72)
    capsules = proportional_capsules(skeleton if full else required_only(skeleton))
    assert list(capsules.names) == LEGS + TRUNK + ARMS
    neck = int(full)  # a neck goes with the head; without its joint its capsule goes with the trunk
    assert [len(capsules.of(group)) for group in DofGroup] == [7, 5 - neck, 3, 3, 1 + neck]
    assert np.all(capsules.radii > 0.02)
    assert np.all(capsules.radii < 0.15)
    names = (skeleton if full else required_only(skeleton)).names
    chest = names[capsules.joints[capsules.names.index("chest")]]
    assert chest == ("upperChest" if full else "spine")


def test_capsules_reach_from_the_ground_to_the_crown() -> None:
    humanoid = proportional_humanoid(1.72)
    c = humanoid.capsules
    at = humanoid.skeleton.positions[c.joints]
    ends = np.stack([at + c.starts, at + c.ends])
    assert (ends[..., 1] - c.radii).min() == pytest.approx(0.0, abs=1e-9)
    assert (ends[..., 1] + c.radii).max() == pytest.approx(1.72)


def test_clamping_is_idempotent_and_within_limits() -> None:
    rng = np.random.default_rng(3)
    for group in LOCAL_GROUPS:
        q = clamp(group, rng.uniform(-4.0, 4.0, (500, group.size)))
        low, high = limits(group).T
        assert np.all(q >= low)
        assert np.all(q <= high)
        np.testing.assert_allclose(clamp(group, q), q, atol=1e-15)
        if group is not DofGroup.WAIST:
            assert np.linalg.norm(q[:, :2], axis=1).max() <= MAX_ELEVATION + 1e-12


def test_limits_see_a_too_high_arm() -> None:
    q = np.zeros(DOF)
    assert within_limits(q)
    q[6:8] = np.deg2rad([140.0, 140.0])
    assert not within_limits(q)
    q[6:8] = np.deg2rad([100.0, 100.0])
    assert within_limits(q)
    assert not within_limits(np.full((2, DOF), 3.0))
