import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.bones import PARENTS
from elbowroom.body.dof import CHILDREN, DOF, LOCAL, LOCAL_GROUPS, DofGroup, followed, limits
from elbowroom.body.fitting.proportions import proportional_capsules, proportional_humanoid, proportional_skeleton
from elbowroom.body.gait.lowered_hips import hips_sinks
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose import kinematics
from elbowroom.body.pose.kinematics import BodyModel, body_model
from elbowroom.body.skeleton import Skeleton
from elbowroom.geometry import quaternion
from naive_pose import arm_rotations, capsule_ends, chest_rotation, joint_frames, required_only, same_rotation

Floats = NDArray[np.float64]


def with_fingers(skeleton: Skeleton) -> Skeleton:
    names, parents, places = list(skeleton.names), list(skeleton.parents), list(skeleton.positions)
    for bone, parent in PARENTS.items():
        if parent in names and bone not in names and ("Index" in bone or "Thumb" in bone):
            names.append(bone)
            parents.append(names.index(parent))
            places.append(places[names.index(parent)] + [0.04 if "left" in bone else -0.04, 0.0, 0.01])
    return Skeleton(tuple(names), np.array(parents), np.array(places))


def bodies() -> dict[str, Humanoid]:
    skeletons = {
        "small": proportional_skeleton(1.3),
        "fingers": with_fingers(proportional_skeleton(1.8)),
        "required": required_only(proportional_skeleton(1.72)),
    }
    return {name: Humanoid(name, s, proportional_capsules(s)) for name, s in skeletons.items()}


BODIES = bodies()


@pytest.fixture(params=list(BODIES))
def humanoid(request: pytest.FixtureRequest) -> Humanoid:
    return BODIES[request.param]


@pytest.fixture
def model(humanoid: Humanoid) -> BodyModel:
    return body_model(humanoid)


def random_postures(n: int, seed: int) -> tuple[Floats, Floats]:
    rng = np.random.default_rng(seed)
    low, high = np.concatenate([limits(group) for group in LOCAL_GROUPS]).T
    q = np.concatenate([rng.normal(size=(n, 3)), rng.uniform(low, high, (n, LOCAL))], axis=1)
    roots = rng.uniform([-3, -3, -7, -1, -0.7, -1.5, -5], [3, 3, 7, 2, 0.7, 1.5, 5], (n, 7))
    return q, roots


def naive_capsules(humanoid: Humanoid, model: BodyModel, q: Floats, root: Floats) -> Floats:
    local = kinematics.local_rotations(model, q, root)
    frames = joint_frames(humanoid.skeleton, local, kinematics.hips_position(model, q, root), root)
    return capsule_ends(humanoid.capsules, *frames)


def test_whole_body_equals_its_naive_twin(humanoid: Humanoid, model: BodyModel) -> None:
    q, roots = random_postures(40, 1)
    segments = kinematics.posture_capsules(model, q, roots)
    assert segments.dtype == np.float32
    for n in range(len(q)):
        np.testing.assert_allclose(segments[:, :, n], naive_capsules(humanoid, model, q[n], roots[n]), atol=1e-5)


def test_waist_and_arms_follow_the_conventions(humanoid: Humanoid, model: BodyModel) -> None:
    skeleton = humanoid.skeleton
    chest = skeleton.index("upperChest" if skeleton.has("upperChest") else "spine")
    for q, root in zip(*random_postures(40, 2), strict=True):
        local = kinematics.local_rotations(model, q, root)
        np.testing.assert_allclose(np.linalg.norm(local, axis=1), 1.0, atol=1e-12)
        still = np.zeros(7)
        _, rotations = joint_frames(skeleton, local, kinematics.hips_position(model, q, root), still)
        hips = quaternion.about_axis(0, hips_sinks(1.0, np.zeros(1), q[5:6])[0, 2])
        assert same_rotation(rotations[chest], quaternion.multiply(hips, chest_rotation(q[3:6]))) < 1e-9
        since_chest = quaternion.multiply(quaternion.conjugate(rotations[chest]), rotations[skeleton.index("head")])
        assert same_rotation(since_chest, chest_rotation(q[14:16])) < 1e-9
        for side, arm in (("left", q[6:10]), ("right", q[10:14])):
            upper, lower = arm_rotations(arm, side == "left")
            assert same_rotation(local[skeleton.index(f"{side}UpperArm")], upper) < 1e-9
            assert same_rotation(local[skeleton.index(f"{side}LowerArm")], lower) < 1e-9
        np.testing.assert_allclose(local[0], hips, atol=1e-12)


def test_groups_compose_to_the_whole_body(humanoid: Humanoid, model: BodyModel) -> None:
    q, roots = random_postures(30, 3)
    whole = kinematics.posture_capsules(model, q, roots)
    pelvis, heading = kinematics.pelvis_frames(model, roots)
    chest, turn = kinematics.chest_frames(model, q[:, 3:6])
    chest_place = pelvis + quaternion.rotate(heading, chest)
    chest_turn = quaternion.multiply(heading, turn)

    def moved(segments: NDArray[np.float32], place: Floats, rotation: Floats) -> Floats:
        ends = np.moveaxis(segments.astype(np.float64).reshape(len(segments), 2, 3, -1), -1, 0)
        world = place[:, None, None] + quaternion.rotate(rotation[:, None, None], ends)
        return np.moveaxis(world, 0, -1).reshape(segments.shape)

    of = humanoid.capsules.of
    np.testing.assert_array_equal(kinematics.leg_capsules(model, roots, q[:, 5]), whole[of(DofGroup.ROOT)])
    trunk = moved(kinematics.group_capsules(model, DofGroup.WAIST, q[:, DofGroup.WAIST.at]), pelvis, heading)
    np.testing.assert_allclose(trunk, whole[of(DofGroup.WAIST)], atol=1e-5)
    for group in CHILDREN:
        arm = moved(kinematics.group_capsules(model, group, q[:, group.at]), chest_place, chest_turn)
        np.testing.assert_allclose(arm, whole[of(group)], atol=1e-5)


def test_mirrored_configuration_gives_the_mirrored_body() -> None:
    humanoid = proportional_humanoid()
    model, names = body_model(humanoid), humanoid.capsules.names
    q, roots = random_postures(30, 4)
    mirrored_q = np.concatenate([q[:, :4], -q[:, 4:5], q[:, 5:6], q[:, 10:14], q[:, 6:10], q[:, 14:] * [1, -1]], axis=1)
    mirrored_roots = roots * [-1, 1, -1, 1, -1, -1, 1] + [0, 0, 0, 0, 0, 0, 0.5]
    a = kinematics.posture_capsules(model, q, roots).reshape(len(names), 2, 3, -1)
    b = kinematics.posture_capsules(model, mirrored_q, mirrored_roots).reshape(len(names), 2, 3, -1)
    for i, name in enumerate(names):
        other = name.replace("left", "RIGHT").replace("right", "left").replace("RIGHT", "right")
        expected = a[names.index(other)] * np.array([-1.0, 1.0, 1.0])[:, None]
        if other == name and abs(humanoid.capsules.starts[i, 0]) > 0.0:  # a lateral capsule: its ends change places
            expected = expected[::-1]
        np.testing.assert_allclose(b[i], expected, atol=2e-5, err_msg=name)


def test_two_builds_make_the_same_gesture() -> None:
    tall, short = proportional_skeleton(1.9), proportional_skeleton(1.3)
    wide = short.positions * np.array([1.4, 0.9, 1.0])
    builds = [tall, Skeleton(short.names, short.parents, wide)]
    for q, _ in zip(*random_postures(20, 5), strict=True):
        directions = []
        for skeleton in builds:
            model = body_model(Humanoid("x", skeleton, proportional_capsules(skeleton)))
            local = kinematics.local_rotations(model, q, np.zeros(7))
            places, _ = joint_frames(skeleton, local, kinematics.hips_position(model, q, np.zeros(7)), np.zeros(7))
            pairs = [("leftUpperArm", "leftLowerArm"), ("rightLowerArm", "rightHand"), ("chest", "upperChest")]
            spans = np.array([places[skeleton.index(b)] - places[skeleton.index(a)] for a, b in pairs])
            directions.append(spans / np.linalg.norm(spans, axis=1, keepdims=True))
        np.testing.assert_allclose(directions[0], directions[1], atol=1e-9)


def test_the_root_moves_the_body_rigidly() -> None:
    model = body_model(proportional_humanoid())
    q, roots = random_postures(20, 6)
    at_origin = roots * [0, 0, 0, 1, 1, 1, 1]
    ends = kinematics.posture_capsules(model, q, at_origin).astype(np.float64)
    ends = np.moveaxis(ends.reshape(len(ends), 2, 3, -1), -1, 0)
    place = np.stack([roots[:, 0], np.zeros(20), roots[:, 1]], axis=-1)
    turned = quaternion.rotate(quaternion.about_axis(1, roots[:, 2])[:, None, None], ends) + place[:, None, None]
    there = kinematics.posture_capsules(model, q, roots)
    np.testing.assert_allclose(there, np.moveaxis(turned, 0, -1).reshape(there.shape), atol=1e-5)


def test_one_posture_and_many_are_equal_bit_for_bit() -> None:
    model = body_model(proportional_humanoid())
    q, roots = random_postures(8, 7)
    many = kinematics.posture_capsules(model, q, roots)
    for n in range(len(q)):
        np.testing.assert_array_equal(kinematics.posture_capsules(model, q[n], roots[n])[:, :, 0], many[:, :, n])


def test_the_root_part_of_q_is_ignored() -> None:
    model = body_model(proportional_humanoid())
    q, roots = random_postures(4, 8)
    other = q + np.array([5.0, 5.0, 5.0] + [0.0] * LOCAL)
    a, b = (kinematics.posture_capsules(model, x, roots) for x in (q, other))
    np.testing.assert_array_equal(a, b)


def test_all_zero_is_the_standing_figure() -> None:
    humanoid = proportional_humanoid()
    names = humanoid.capsules.names
    ends = kinematics.posture_capsules(body_model(humanoid), np.zeros(DOF), np.zeros(7))[:, :, 0]
    for side, x in (("left", 1.0), ("right", -1.0)):
        upper = ends[names.index(f"{side}UpperArm")]
        np.testing.assert_allclose((upper[3:] - upper[:3])[[0, 2]], 0.0, atol=1e-6)
        assert upper[4] < upper[1]
        assert np.sign(upper[0]) == x
        assert ends[names.index(f"{side}Foot"), 1] < 0.05


def test_t_pose_is_a_right_angle_of_abduction() -> None:
    humanoid = proportional_humanoid()
    q = np.zeros(DOF)
    q[[7, 11]] = np.pi / 2
    model = body_model(humanoid)
    local = kinematics.local_rotations(model, q, np.zeros(7))
    arms = [humanoid.skeleton.index(side + "UpperArm") for side in ("left", "right")]
    np.testing.assert_allclose(local[arms], [quaternion.IDENTITY] * 2, atol=1e-12)


def test_where_nobody_plans_the_head_the_gaze_stays_roughly_forward() -> None:
    humanoid = proportional_humanoid()
    model, head = body_model(humanoid), humanoid.skeleton.index("head")
    for bend, twist in [(1.2, 0.0), (-0.4, 0.0), (0.0, 0.7), (0.9, -0.6)]:
        q = np.zeros(DOF)
        q[3:5] = bend, twist
        q[3:] = followed(q[3:])
        local = kinematics.local_rotations(model, q, np.zeros(7))
        _, rotations = joint_frames(humanoid.skeleton, local, model.offsets[0], np.zeros(7))
        turned = np.linalg.norm(quaternion.to_rotation_vector(rotations[head]))
        assert turned <= 0.5 * np.linalg.norm(quaternion.to_rotation_vector(chest_rotation(q[3:6])))
