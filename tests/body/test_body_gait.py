import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOWERING, DofGroup, limits
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.gait.cycle import foot_poses
from elbowroom.body.gait.legs import leg_rotations
from elbowroom.body.gait.lowered_hips import STEEPEST, hips_sinks
from elbowroom.body.gait.stride import STANDARD_LEG, feet_standing, phase_rate, quickness, stride_length
from elbowroom.body.pose import kinematics
from elbowroom.body.pose.kinematics import BodyModel, body_model
from elbowroom.geometry import quaternion
from naive_pose import joint_frames, segment_gap

Floats = NDArray[np.float64]

# Forward, lateral, turn.
MOTIONS = [
    (0.3, 0.0, 0.0),
    (0.8, 0.0, 0.0),
    (1.2, 0.0, 0.0),
    (1.6, 0.0, 0.0),
    (2.5, 0.0, 0.0),
    (1.2, 0.0, 0.8),
    (-0.6, 0.0, 0.0),
    (0.0, 0.6, 0.0),
    (0.0, -0.8, 0.0),
    (0.0, 0.0, 1.5),
    (0.8, 0.5, -0.5),
]
HEIGHTS = [0.9, 1.3, 1.72, 2.5]
LOWERINGS = [0.0, 0.3, float(limits(DofGroup.WAIST)[2, 1])]


def steady_walk(motion: tuple[float, float, float], strides: float, n: int, scale: float = 1.0) -> Floats:
    """Root states (n, 7) of a constant motion of a body of this scale, integrated exactly."""
    forward, lateral, turn = motion
    rate = quickness(scale) * phase_rate(*motion)
    t = np.linspace(0.0, strides / rate, n)
    heading = turn * t
    along = t if turn == 0.0 else np.sin(heading) / turn
    across = 0.0 * t if turn == 0.0 else (1.0 - np.cos(heading)) / turn
    x, z = forward * across + lateral * along, forward * along - lateral * across
    columns = [x, z, heading, forward + 0 * t, lateral + 0 * t, turn + 0 * t, rate * t]
    return np.stack(columns, axis=-1)


def lowered_by(lowering: float) -> Floats:
    """A body that does nothing but crouch."""
    q = np.zeros(DOF)
    q[LOWERING] = lowering
    return q


def legs(model: BodyModel, roots: Floats, lowering: float = 0.0) -> Floats:
    feet, drops = foot_poses(model.gait.legs, model.gait.scale, roots)
    sinks = hips_sinks(model.gait.half_leg, drops, np.full(len(roots), lowering))
    return leg_rotations(model.leg_rest, feet, sinks, roots)


def sole_points(height: float, roots: Floats, lowering: float = 0.0) -> tuple[BodyModel, Floats]:
    """World places (n, 2, 3, 3) of heel, sole under the toes' joint and toe tip of both feet, by forward kinematics."""
    humanoid = proportional_humanoid(height)
    model, skeleton = body_model(humanoid), humanoid.skeleton
    out = np.empty((len(roots), 2, 3, 3))
    q = lowered_by(lowering)
    local = np.array([kinematics.local_rotations(model, q, root) for root in roots])
    hips = np.array([kinematics.hips_position(model, q, root) for root in roots])
    places, turns = joint_frames(skeleton, local, hips, roots)
    for i, side in enumerate(("left", "right")):
        foot, toes = skeleton.index(f"{side}Foot"), skeleton.index(f"{side}Toes")
        ankle, above, heel = skeleton.positions[foot, 1], skeleton.positions[toes, 1], model.gait.legs[i, 7]
        out[:, i, 0] = places[:, foot] + quaternion.rotate(turns[:, foot], [0.0, -ankle, -heel])
        out[:, i, 1] = places[:, toes] + quaternion.rotate(turns[:, toes], [0.0, -above, 0.0])
        out[:, i, 2] = out[:, i, 1] + quaternion.rotate(turns[:, toes], [0.0, 0.0, 0.035 * height])
    return model, out


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("height", HEIGHTS)
def test_the_standing_foot_stands_still_on_the_ground(motion: tuple[float, float, float], height: float) -> None:
    roots = steady_walk(motion, 2.0, 240, height / 1.72)
    model, soles = sole_points(height, roots)
    feet, _ = foot_poses(model.gait.legs, model.gait.scale, roots)
    assert soles[..., 1].min() > -0.01
    standing = feet_standing(model.gait.scale, roots)
    for side in range(2):
        changes = np.flatnonzero(np.diff(standing[:, side])) + 1
        for stance in np.split(np.arange(len(roots)), changes):
            pitch = feet[stance, side, 4]
            for point, carries in ((0, pitch <= 0.0), (1, pitch >= 0.0)):
                held = soles[stance[carries & standing[stance, side]], side, point]
                if len(held):
                    assert np.ptp(held[:, [0, 2]], axis=0).max() < 0.01
                    assert abs(held[:, 1]).max() < 0.01


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("lowering", LOWERINGS)
def test_legs_do_not_pass_through_each_other(motion: tuple[float, float, float], lowering: float) -> None:
    humanoid = proportional_humanoid()
    model, names, radii = body_model(humanoid), humanoid.capsules.names, humanoid.capsules.radii
    segments = kinematics.leg_capsules(model, steady_walk(motion, 1.0, 24), lowering).astype(np.float64)
    for n in range(segments.shape[2]):
        for a in ("Thigh", "Shin", "Foot"):
            for b in ("Thigh", "Shin", "Foot"):
                i, j = names.index("left" + a), names.index("right" + b)
                gap = segment_gap(segments[i, :, n], segments[j, :, n]) - radii[i] - radii[j]
                assert gap > (-0.02 if a == b == "Thigh" else -0.005), (a, b, n)


@pytest.mark.parametrize("motion", MOTIONS)
def test_joints_move_without_jumps_and_knees_bend_forward(motion: tuple[float, float, float]) -> None:
    model = body_model(proportional_humanoid())
    rotations = legs(model, steady_walk(motion, 1.0, 1001))
    steps = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(rotations[:-1]), rotations[1:]))
    assert np.linalg.norm(steps, axis=-1).max() < np.deg2rad(1.5)
    knees = quaternion.to_rotation_vector(rotations[:, :, 1])
    assert knees[..., 0].min() > -1e-6
    assert knees[..., 0].max() < np.deg2rad(100.0)


@pytest.mark.parametrize("phase", [0.0, 0.2, 0.4, 0.6, 0.8])
def test_joints_follow_the_speed_without_jumps(phase: float) -> None:
    model = body_model(proportional_humanoid())
    for column, low, high in ((3, -1.0, 2.5), (4, -0.8, 0.8), (5, -2.0, 2.0)):
        roots = np.zeros((801, 7))
        roots[:, column], roots[:, 6] = np.linspace(low, high, 801), phase
        rotations = legs(model, roots)
        steps = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(rotations[:-1]), rotations[1:]))
        assert np.linalg.norm(steps, axis=-1).max() < np.deg2rad(4.0)


def test_a_resting_body_stands_as_in_its_file_at_any_phase() -> None:
    humanoid = proportional_humanoid()
    model = body_model(humanoid)
    roots = np.zeros((50, 7))
    roots[:, 6] = np.linspace(-2.0, 3.0, 50)
    rotations = legs(model, roots)
    assert np.linalg.norm(quaternion.to_rotation_vector(rotations), axis=-1).max() < np.deg2rad(8.0)
    _, drops = foot_poses(model.gait.legs, model.gait.scale, roots)
    assert 0.0 <= drops.min() <= drops.max() < 0.005
    assert phase_rate(0.0, 0.0, 0.0) == 0.0


@pytest.mark.parametrize("motion", [(1.2, 0.0, 0.0), (-0.7, 0.0, 0.0), (2.2, 0.0, 0.0)])
def test_half_a_cycle_later_left_and_right_change_places(motion: tuple[float, float, float]) -> None:
    model = body_model(proportional_humanoid())
    roots = np.zeros((40, 7))
    roots[:, 3:6], roots[:, 6] = motion, np.linspace(0.0, 1.0, 40)
    later = roots + np.array([0, 0, 0, 0, 0, 0, 0.5])
    a, b = legs(model, roots), legs(model, later)
    mirror = np.array([1.0, -1.0, -1.0, 1.0])  # a rotation seen in the mirror of the plane x = 0
    np.testing.assert_allclose(b[:, ::-1] * mirror, a, atol=1e-9)


def test_cadence_is_that_of_grieve_and_gear() -> None:
    for speed in (0.8, 1.2, 1.8):
        published = 64.8 / 60.0 * (speed / 1.72) ** 0.57
        assert phase_rate(speed, 0.0, 0.0) == pytest.approx(published, rel=0.06)
        assert stride_length(speed) * phase_rate(speed, 0.0, 0.0) == pytest.approx(speed)
    assert 1.25 < stride_length(1.2) < 1.45
    assert stride_length(0.0) == 0.0
    lengths = [stride_length(v) for v in np.linspace(0.0, 2.5, 60)]
    assert np.all(np.diff(lengths) > 0.0)


def test_the_pelvis_bobs_a_little() -> None:
    model = body_model(proportional_humanoid())
    heights = [
        kinematics.hips_position(model, np.zeros(DOF), root)[1] for root in steady_walk((1.2, 0.0, 0.0), 1.0, 60)
    ]
    assert 0.01 < np.ptp(heights) < 0.05
    assert max(heights) <= model.offsets[0, 1]


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("lowering", LOWERINGS[1:])
def test_who_crouches_keeps_the_feet_where_they_were(motion: tuple[float, float, float], lowering: float) -> None:
    roots = steady_walk(motion, 1.0, 60)
    _, upright = sole_points(1.72, roots)
    model, crouched = sole_points(1.72, roots, lowering)
    # an upright leg that is nearly straight is a little short of its target, most so in a run: its knee does not snap
    np.testing.assert_allclose(crouched, upright, atol=0.015)
    hips = [[middle_of_hips(model, lowered_by(by), root) for by in (0.0, lowering)] for root in roots]
    sunk = np.diff(np.array(hips), axis=1)[:, 0]
    np.testing.assert_allclose(sunk[:, 1], -lowering * 0.25 * model.gait.legs[:, 8:10].sum(), atol=1e-12)


def middle_of_hips(model: BodyModel, q: Floats, root: Floats) -> Floats:
    """The middle between the joints of the legs (3,) in the root frame."""
    middle = model.offsets[model.tree.legs[:, 0]].mean(axis=0)
    turned, hips = kinematics.joint_pose(model, q, root)
    place: Floats = hips + quaternion.rotate(turned[0], middle)
    return place


def test_who_goes_down_leans_forward_from_the_hips_and_the_deeper_the_more() -> None:
    lowerings = np.linspace(0.0, LOWERINGS[-1], 200)
    leans = hips_sinks(0.4, np.zeros(200), lowerings)[:, 2]
    assert leans[0] == 0.0
    assert np.all(np.diff(leans) >= 0.0)
    assert np.diff(leans).max() <= STEEPEST * lowerings[1]
    assert leans[lowerings < 0.1].max() < np.deg2rad(5.0)  # knees alone do it
    assert np.deg2rad(30.0) < leans[-1] < np.deg2rad(40.0)
    for height in HEIGHTS:
        model = body_model(proportional_humanoid(height))
        turned = kinematics.local_rotations(model, lowered_by(0.4), np.zeros(7))[0]
        lean = hips_sinks(0.4, np.zeros(1), np.array([0.4]))[0, 2]
        np.testing.assert_allclose(turned, quaternion.about_axis(0, lean), atol=1e-12)


@pytest.mark.parametrize("motion", MOTIONS)
def test_crouching_legs_keep_to_the_range_of_their_joints(motion: tuple[float, float, float]) -> None:
    model = body_model(proportional_humanoid())
    roots = steady_walk(motion, 1.0, 240)
    for lowering in np.linspace(0.0, LOWERINGS[-1], 8):
        rotations = legs(model, roots, lowering)
        flexion = quaternion.to_rotation_vector(rotations[:, :, 1])[..., 0]
        assert flexion.min() > -1e-6
        assert flexion.max() < np.deg2rad(135.0)
        thigh, shin = rotations[:, :, 0], rotations[:, :, 1]
        feet, _ = foot_poses(model.gait.legs, model.gait.scale, roots)
        flat = np.abs(feet[..., 4]) < np.deg2rad(5.0)
        hips = quaternion.about_axis(0, hips_sinks(1.0, np.zeros(1), np.array([lowering]))[0, 2])
        lean = quaternion.rotate(quaternion.multiply(hips, quaternion.multiply(thigh, shin)), [0.0, 1.0, 0.0])
        upward = quaternion.rotate(thigh, [0.0, -1.0, 0.0])[..., 1].max()
        assert motion[0] > 2.0 or upward < np.sin(np.deg2rad(30.0))  # hips flex by 120
        bent = np.arccos(lean[..., 1]) - feet[..., 4]
        assert bent[flat].max() < np.deg2rad(64.0 if motion[0] > 2.0 else 58.0)  # a run's stance reaches farther back


def test_going_down_is_smooth() -> None:
    model = body_model(proportional_humanoid())
    for phase in (0.0, 0.3, 0.7):
        root = np.array([[0.0, 0.0, 0.0, 1.1, 0.0, 0.0, phase]])
        rotations = np.concatenate([legs(model, root, lowering) for lowering in np.linspace(0.0, LOWERINGS[-1], 400)])
        steps = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(rotations[:-1]), rotations[1:]))
        assert np.linalg.norm(steps, axis=-1).max() < np.deg2rad(4.0)


@pytest.mark.parametrize("height", [0.9, 1.3, 2.5])
def test_strides_fit_the_legs(height: float) -> None:
    """Grieve & Gear 1966: at one speed the stride grows with the stature to the power of 0.57."""
    scale = body_model(proportional_humanoid(height)).gait.scale
    stride, adult = 1.1 / (quickness(scale) * phase_rate(1.1, 0.0, 0.0)), stride_length(1.1)
    assert quickness(1.0) == 1.0
    assert stride / adult == pytest.approx((height / 1.72) ** 0.57, rel=0.01)
    assert 0.9 < stride / (scale * STANDARD_LEG) < 2.6  # leg lengths: a child's run, a giant's stroll
