"""The measures of a walk, on movements whose figures are known."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.clip import Clip
from elbowroom.experiment.judge.poses import Posed, Poser
from elbowroom.experiment.motion.angles import leg_angles
from elbowroom.experiment.motion.bands import (
    KNEE_ACCELERATION,
    KNEE_SPEED,
    STANCE_SHARES,
    Band,
    stance_share,
    wrist_sparc,
)
from elbowroom.experiment.motion.borne import borne, shares
from elbowroom.experiment.motion.curves import curves_of
from elbowroom.experiment.motion.cycles import PARTS, in_strides, mean_range
from elbowroom.experiment.motion.feet import FootTrack, feet
from elbowroom.experiment.motion.gaps import PassedGap, onset
from elbowroom.experiment.motion.knees import knees
from elbowroom.experiment.motion.published import KNEE, PELVIC_TILT, corridors
from elbowroom.experiment.motion.smooth import log_dimensionless_jerk, smoothness, sparc
from elbowroom.experiment.motion.sole import soles_of
from elbowroom.experiment.motion.stance import slides, standing_by_looks, stretches
from elbowroom.experiment.motion.trunk import trunk
from elbowroom.experiment.motion.turning import lead
from elbowroom.experiment.motion.walked import posed
from elbowroom.geometry import quaternion
from shared_data import SHARED, needs_shared

Floats = NDArray[np.float64]

RATE = 60.0
FLAT = np.array([[-0.18, 0.0], [0.0, 0.0], [0.07, 0.0]])  # of the foot below, whose ball is its second place


def foot(x: Floats, height: Floats) -> Floats:
    """A flat sole (N, 3, 3) that goes along x at a height."""
    along = np.array([-0.08, 0.1, 0.17])
    points = np.zeros((len(x), 3, 3))
    points[:, :, 0], points[:, :, 1] = x[:, None] + along, height[:, None]
    return points


def test_a_foot_that_stands_does_not_slide_and_one_that_slips_does() -> None:
    x = np.concatenate([np.zeros(30), np.linspace(0.0, 0.03, 30), np.full(30, 0.03)])
    always = np.ones(90, np.bool_)
    assert slides(foot(x, np.zeros(90)), always) == pytest.approx([0.03])
    assert slides(foot(0.0 * x, np.zeros(90)), always) == pytest.approx([0.0])


def test_a_foot_that_comes_back_has_slid() -> None:
    x = 0.02 * np.sin(np.linspace(0.0, np.pi, 61))
    assert slides(foot(x, np.zeros(61)), np.ones(61, np.bool_)) == pytest.approx([0.02], rel=1e-3)


def test_a_foot_that_rolls_from_heel_to_toe_does_not_slide() -> None:
    pitch = np.concatenate([np.linspace(-0.3, 0.0, 20), np.zeros(20), np.linspace(0.0, 0.5, 20)])
    points = foot(np.zeros(60), np.zeros(60))[:, :2]
    pivot = np.where(pitch < 0.0, -0.08, 0.1)
    for place in range(2):
        from_pivot = points[:, place, 0] - pivot
        points[:, place, 0] = pivot + from_pivot * np.cos(pitch)
        points[:, place, 1] = -from_pivot * np.sin(pitch)
    assert slides(points, np.ones(60, np.bool_))[0] < 2e-4


def test_a_foot_stands_by_its_looks_from_its_first_rest_to_its_last() -> None:
    slip = np.linspace(0.0, 0.02, 6)
    x = np.concatenate([np.linspace(-0.5, 0.0, 20), np.zeros(10), slip, np.full(10, 0.02), np.linspace(0.04, 0.5, 14)])
    height = np.concatenate([np.full(20, 0.002), np.zeros(30), np.full(10, 0.05)])
    sole = foot(x, height)
    standing = standing_by_looks(sole, RATE)
    assert list(stretches(standing)) == [slice(19, 45)]
    assert slides(sole, standing) == pytest.approx([0.02])
    assert not standing_by_looks(foot(x, height + 0.006), RATE).any()


def test_feet_are_told_in_millimetres() -> None:
    n = 40
    height = np.concatenate([np.full(10, -0.004), 0.03 + 0.05 * np.abs(np.linspace(-1, 1, 20)), np.zeros(10)])
    planned = np.concatenate([np.ones(10, bool), np.zeros(20, bool), np.ones(10, bool)])
    track = FootTrack(foot(np.zeros(n), height), planned, planned, FLAT, np.zeros(n))
    found = feet([track])
    assert found.in_ground == pytest.approx(4.0)
    assert found.clearance == pytest.approx(32.6, abs=0.1)
    assert found.as_planned.stances == 2
    assert found.as_planned.worst == 0.0


def test_a_foot_on_its_heel_over_an_edge_has_little_ground_under_it() -> None:
    ahead = np.linspace(-0.18, 0.07, 26)
    flat = np.stack([ahead, np.zeros(26)], axis=1)
    standing = np.concatenate([np.zeros(5, bool), np.ones(20, bool), np.zeros(5, bool)])
    heights = np.zeros((30, 26))
    assert shares(heights, standing, flat, np.zeros(30)) == pytest.approx(np.array([[0.0, 1.0]]))
    over = heights + np.where(ahead > -0.135, 0.17, 0.0)
    assert shares(over, standing, flat, np.zeros(30))[0, 1] == pytest.approx(0.25, abs=0.03)
    toes_over = heights + np.where(ahead > 0.02, 0.17, 0.0)
    assert shares(toes_over, standing, flat, np.zeros(30))[0, 1] == pytest.approx(1.0)


def test_a_foot_that_rolls_has_ground_under_all_of_it() -> None:
    ahead = np.linspace(-0.18, 0.0, 10)
    pitch = np.linspace(-0.4, 0.4, 60)[:, None]
    heights = np.where(pitch < 0.0, -np.sin(pitch) * (ahead + 0.18), -np.sin(pitch) * ahead)
    standing = np.ones(60, np.bool_)
    standing[[0, -1]] = False
    high_heeled = np.stack([ahead, np.linspace(0.04, 0.0, 10)], axis=1)
    for flat in (high_heeled, high_heeled * [1.0, 0.0]):
        assert shares(heights + flat[:, 1], standing, flat, np.zeros(60))[0, 1] == pytest.approx(1.0)


def test_stances_are_told_apart_by_where_the_body_goes() -> None:
    found = borne([np.array([[0.17, 0.6], [0.0, 1.0]]), np.array([[-0.17, 0.9], [-0.1, 0.7]]), np.empty((0, 2))])
    assert (found.up.stances, found.level.stances, found.down.stances) == (1, 1, 2)
    assert found.down.mean == pytest.approx(80.0)
    assert found.down.least == pytest.approx(70.0)
    assert borne([]).up.least is None


def test_strides_are_cut_at_whole_phases_and_drift_is_taken_off() -> None:
    phase = np.linspace(0.3, 4.6, 500)
    track = 0.02 * np.sin(4.0 * np.pi * phase) + 0.7 * phase
    strides = in_strides(track, phase)
    assert strides.shape == (3, PARTS)
    assert strides[:, 0] == pytest.approx(0.7 * np.arange(1, 4), abs=1e-3)
    assert mean_range(track, phase) == pytest.approx(0.04, rel=0.01)


def test_a_trunk_that_sways_and_turns_is_told_as_it_does() -> None:
    humanoid, n = proportional_humanoid(), 400
    roots = np.zeros((n, 7))
    roots[:, 2], roots[:, 6] = 0.7, np.linspace(0.0, 3.0, n)
    rest = posed(humanoid, np.zeros((n, DOF)), roots)
    wave, twice = np.sin(2.0 * np.pi * roots[:, 6]), np.sin(4.0 * np.pi * roots[:, 6])
    places = rest.positions + np.array([np.cos(0.7), 0.0, -np.sin(0.7)]) * 0.025 * wave[:, None, None]
    places[:, :, 1] += 0.02 * twice[:, None]
    yaw = quaternion.to_matrix(quaternion.about_axis(1, 0.7 + np.radians(4.0) * wave))
    roll = quaternion.to_matrix(quaternion.about_axis(2, np.radians(3.0) * wave))
    back = quaternion.to_matrix(quaternion.about_axis(1, 0.7 - np.radians(5.0) * wave))
    turns, skeleton = rest.rotations.copy(), humanoid.skeleton
    turns[:, skeleton.index("hips")] = yaw @ roll
    turns[:, skeleton.index("upperChest")] = back
    found = trunk(Posed(places, turns), skeleton, roots)
    assert found.up_down == pytest.approx(4.0, rel=0.02)
    assert found.side == pytest.approx(5.0, rel=0.01)
    assert found.rotation == pytest.approx(8.0, rel=0.01)
    assert found.list == pytest.approx(6.0, rel=0.01)
    assert found.thorax == pytest.approx(10.0, rel=0.01)
    assert found.against == pytest.approx(-1.0, abs=0.01)


@pytest.mark.parametrize(
    ("bone", "joint", "sign"), [("UpperLeg", "hip", -1), ("LowerLeg", "knee", 1), ("Foot", "ankle", -1)]
)
def test_angles_have_the_signs_of_gait_laboratories(bone: str, joint: str, sign: int) -> None:
    humanoid = proportional_humanoid()
    skeleton = humanoid.skeleton
    turned = skeleton.index(f"left{bone}")
    local = np.zeros((2, len(skeleton.names), 4))
    local[..., 3] = 1.0
    local[1, turned] = quaternion.about_axis(0, np.array(np.radians(20.0 * sign)))
    joints = Poser(humanoid).world(local, np.tile(skeleton.positions[0], (2, 1)), np.zeros((2, 3)))
    before, after = leg_angles(joints, skeleton, "left")[joint]
    assert after - before == pytest.approx(20.0, abs=1e-6)
    others = {
        name: angles[1] - angles[0] for name, angles in leg_angles(joints, skeleton, "left").items() if name != joint
    }
    assert others == {name: pytest.approx(0.0, abs=1e-6) for name in others}


def test_the_published_knee_is_a_persons() -> None:
    hip = np.interp(np.linspace(0, 1, PARTS), [0, 0.5, 0.85, 1.0], [25.0, -12.0, 25.0, 25.0])
    ankle = np.interp(np.linspace(0, 1, PARTS), [0, 0.25, 0.5, 0.65, 0.8, 1.0], [0.0, 7.0, 12.0, -15.0, 0.0, 0.0])
    found = curves_of({"hip": hip, "knee": KNEE, "ankle": ankle}, 0.6)
    assert found.inside == 1.0
    assert found.humps == 1
    assert found.loading == pytest.approx(19.7)
    assert found.toe_off == pytest.approx(34.1)
    assert found.swing_peak == pytest.approx(60.5)
    assert found.outside["knee"] == found.outside["ankle"] == found.outside["hip"] == 0.0
    stiff = curves_of({"hip": 0.0 * hip, "knee": KNEE, "ankle": ankle}, 0.6)
    assert stiff.outside["hip"] == pytest.approx(corridors()["hip"].low[0] - PELVIC_TILT)


def test_a_knee_that_bends_twice_has_two_humps() -> None:
    parts = np.linspace(0.0, 1.0, PARTS)
    knee = 10.0 - 8.0 * np.cos(4.0 * np.pi * parts / 0.6)
    assert curves_of({"hip": knee, "knee": knee, "ankle": knee}, 0.6).humps == 2


def test_smoothness_of_known_speeds() -> None:
    t = np.arange(0.0, 1.0, 1e-3)
    minimum_jerk = 30.0 * t**2 * (1.0 - t) ** 2
    assert sparc(minimum_jerk, 1000.0) == pytest.approx(-1.41, abs=0.02)  # Balasubramanian et al. 2015
    assert log_dimensionless_jerk(minimum_jerk, 1000.0) == pytest.approx(-np.log(720.0 / 1.875**2), abs=0.02)
    rough = minimum_jerk + 0.5 * np.sin(4.0 * np.pi * t) ** 2
    assert sparc(rough, 1000.0) < sparc(minimum_jerk, 1000.0) - 0.1
    assert log_dimensionless_jerk(rough, 1000.0) < log_dimensionless_jerk(minimum_jerk, 1000.0)


def test_smoothness_does_not_depend_on_size_and_needs_movement() -> None:
    rng = np.random.default_rng(3)
    places = np.cumsum(rng.normal(size=(300, 3)), axis=0)
    one, other = smoothness(places, RATE), smoothness(7.0 * places, RATE)
    assert one is not None
    assert other is not None
    assert one.sparc == pytest.approx(other.sparc)
    assert one.jerk == pytest.approx(other.jerk)
    assert smoothness(np.ones((300, 3)), RATE) is None


@pytest.mark.parametrize("stride", [0.97, 1.0, 1.1])
def test_smoothness_does_not_hang_on_where_in_a_stride_one_looks(stride: float) -> None:
    """Two strides may fill a window: if windows began at the same places of a stride, so would the figure."""
    times, found = np.arange(330.0) / RATE, []
    for begins in np.linspace(0.0, 1.0, 6, endpoint=False):
        turn = 2.0 * np.pi * (times / stride + begins)
        places = np.stack([0.02 * np.sin(turn + 1.0), 0.03 * np.cos(2.0 * turn), 0.2 * np.sin(turn)], axis=1)
        swing = smoothness(places, RATE)
        assert swing is not None
        found.append((swing.sparc, swing.jerk))
    assert np.ptp(found, axis=0).max() < 0.1


@needs_shared
@pytest.mark.parametrize("stride", [0.9, 0.95, 1.0, 1.05, 1.1])
def test_recorded_wrists_lie_in_the_band_and_reach_its_rough_end(stride: float) -> None:
    """At strides of a second, two of which fill a window, people's wrists are rougher too."""
    assert SHARED is not None
    found = [
        swing.sparc
        for name in ("walk01.bvh", "cmu_02_02_walk.bvh")
        for wrist in recorded_wrists(Clip.load(SHARED / "motions" / name), stride)
        if (swing := smoothness(wrist, RATE)) is not None
    ]
    low, high = wrist_sparc(stride)
    assert len(found) == 4
    assert max(found) < high
    assert low == pytest.approx(min(-3.0, *found), abs=0.03)


def test_a_knee_that_swings_is_as_fast_as_its_sine_and_one_that_snaps_is_told() -> None:
    t = np.arange(0.0, 20.0, 1.0 / RATE)
    swings = 30.0 + 30.0 * np.sin(2.0 * np.pi * t)
    found, omega = knees((swings, swings), RATE), 2.0 * np.pi
    assert found.fastest == pytest.approx(30.0 * omega, rel=0.01)
    assert found.speed == pytest.approx(30.0 * omega, rel=0.01)
    assert found.acceleration == pytest.approx(30.0 * omega**2, rel=0.01)
    snaps = swings.copy()
    snaps[300::60] += 8.0  # degrees, in a frame of each second
    assert knees((swings, snaps), RATE).acceleration > KNEE_ACCELERATION > 10.0 * found.acceleration


@needs_shared
def test_recorded_knees_have_nearly_as_much_as_the_band_allows() -> None:
    assert SHARED is not None
    clip = Clip.load(SHARED / "motions" / "cmu_02_02_walk.bvh")
    found = [knees([recorded_knee(clip, side)], RATE) for side in ("left", "right")]
    assert 0.9 * KNEE_SPEED < max(own.speed for own in found) < KNEE_SPEED
    assert 0.9 * KNEE_ACCELERATION < max(own.acceleration for own in found) < KNEE_ACCELERATION


def recorded_knee(clip: Clip, side: str) -> Floats:
    """The flexion of a knee, degrees (N,), at 60 frames a second of a clip that has 120."""
    hip, knee, ankle = (clip.motion.position(f"{side}{bone}")[::2] for bone in ("UpperLeg", "LowerLeg", "Foot"))
    thigh, shin = knee - hip, ankle - knee
    cosine = (thigh * shin).sum(axis=1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shin, axis=1)
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def recorded_wrists(clip: Clip, stride: float) -> list[Floats]:
    """Both wrists (N, 3) of a walk as seen from the hips, its mean stride played again and again."""
    phases = clip.planning.track.strides.phases
    played = np.arange(0.0, 12.0, 1.0 / RATE) / stride
    return [
        harmonics(played)
        @ np.linalg.lstsq(
            harmonics(phases), (clip.motion.position(hand) - clip.motion.position("hips"))[: len(phases)]
        )[0]
        for hand in ("leftHand", "rightHand")
    ]


def harmonics(phases: Floats) -> Floats:
    turns = 2.0 * np.pi * np.outer(phases, np.arange(1.0, 6.0))
    return np.hstack([np.ones((len(phases), 1)), np.cos(turns), np.sin(turns)])


def test_a_head_that_turns_first_leads() -> None:
    t = np.arange(0.0, 4.0, 1.0 / RATE)

    def turn(at: float) -> Floats:
        return np.clip(90.0 * (t - at), 0.0, 90.0)

    assert lead(turn(1.0), turn(1.4), RATE) == pytest.approx(0.4, abs=1e-6)
    assert lead(turn(1.4), turn(1.0), RATE) == pytest.approx(-0.4, abs=1e-6)
    assert lead(turn(1.0), np.zeros(len(t)), RATE) is None


def test_the_onset_lies_between_the_gap_that_turns_and_the_one_that_does_not() -> None:
    def passage(ratio: float, turn: float) -> PassedGap:
        return PassedGap(ratio, ratio, True, turn, 1.0, 1.0)

    assert onset((passage(1.0, 40.0), passage(1.2, 0.0))) == pytest.approx(1.1)
    assert onset((passage(1.0, 10.0), passage(1.2, 0.0))) is None
    assert onset((passage(1.0, 40.0), passage(1.2, 30.0))) == pytest.approx(1.2)


def test_the_stance_share_goes_through_the_published_ones() -> None:
    for speed, share in STANCE_SHARES:
        assert stance_share(speed) == pytest.approx(share)
    assert stance_share(1.25) == pytest.approx(0.5 * (60.4 + 59.3))
    assert stance_share(2.2) < 57.2


def test_a_figure_that_could_not_be_measured_is_not_inside() -> None:
    assert not Band("a", None, 0.0, 1.0, "").inside
    assert Band("a", 1.0, 0.0, 1.0, "m").inside
    assert Band("a", 1.0, 0.0, 1.0, "m").wanted == "0 to 1 m"


@pytest.mark.parametrize("humanoid", [Humanoid.default(), proportional_humanoid(1.2)], ids=["stock", "without a mesh"])
def test_soles_stand_on_the_ground_and_reach_from_heel_to_toe(humanoid: Humanoid) -> None:
    roots = np.zeros((1, 7))
    joints = posed(humanoid, np.zeros((1, DOF)), roots)
    for side, sole in zip(("left", "right"), soles_of(humanoid), strict=True):
        points, ankle = sole.points(joints)[0], joints.positions[0, humanoid.skeleton.index(f"{side}Foot")]
        assert abs(points[:, 1].min()) < 0.006
        assert points[:, 2].min() < ankle[2] - 0.03 * humanoid.skeleton.height
        assert points[:, 2].max() > ankle[2] + 0.08 * humanoid.skeleton.height
