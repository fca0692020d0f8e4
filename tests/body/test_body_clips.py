import json

import numpy as np
import pytest
from scipy.sparse.csgraph import connected_components

from elbowroom.body.clips.clip import MotionClip
from elbowroom.body.clips.clip_data import parse_clips
from elbowroom.body.clips.stock_clips import arm_swing, arm_swing_goal, stock_clips
from elbowroom.body.dof import DOF, LOCAL_GROUPS, DofGroup, clamp
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.errors import InputError
from naive_pose import segment_gap

ARMS = [DofGroup.LEFT_ARM, DofGroup.RIGHT_ARM]


@pytest.mark.parametrize("group", LOCAL_GROUPS)
def test_stock_clips_stay_within_the_limits(group: DofGroup) -> None:
    for clip in stock_clips(group):
        dense = clip.sample(np.linspace(clip.times[0], clip.times[-1], 400))
        np.testing.assert_allclose(clamp(group, dense), dense, atol=1e-9, err_msg=clip.name)


@pytest.mark.parametrize("group", LOCAL_GROUPS)
@pytest.mark.parametrize(("k", "radius"), [(8, 0.6), (10, 0.4), (12, 0.4)])
def test_resampled_clips_make_one_graph(group: DofGroup, k: int, radius: float) -> None:
    vertices = np.concatenate([clip.resample(k) for clip in stock_clips(group)])
    distances = np.linalg.norm(vertices[:, None] - vertices[None], axis=-1)
    assert connected_components(distances < radius)[0] == 1


def test_clips_pass_exactly_through_their_keys_and_do_not_overshoot() -> None:
    for group in LOCAL_GROUPS:
        for clip in stock_clips(group):
            np.testing.assert_allclose(clip.sample(clip.times), clip.configurations, atol=1e-12)
            dense = clip.sample(np.linspace(clip.times[0], clip.times[-1], 300))
            assert np.all(dense <= clip.configurations.max(axis=0) + 1e-9)
            assert np.all(dense >= clip.configurations.min(axis=0) - 1e-9)


def test_a_loop_repeats_and_any_other_clip_rests() -> None:
    swing, bend = arm_swing(DofGroup.LEFT_ARM), stock_clips(DofGroup.WAIST)[0]
    t = np.linspace(-3.0, 3.0, 101)
    np.testing.assert_allclose(swing.sample(t), swing.sample(t + 4.0), atol=1e-12)
    np.testing.assert_array_equal(bend.sample(99.0), bend.configurations[-1])
    np.testing.assert_array_equal(bend.sample(-1.0), bend.configurations[0])
    assert swing.resample(8).shape == (8, 4)
    assert np.linalg.norm(swing.resample(8)[-1] - swing.resample(8)[0]) > 0.05
    np.testing.assert_array_equal(bend.resample(5)[[0, -1]], bend.configurations[[0, -1]])


def test_both_arms_have_the_same_gestures() -> None:
    for left, right in zip(*(stock_clips(group) for group in ARMS), strict=True):
        assert left.name == right.name
        np.testing.assert_array_equal(left.configurations, right.configurations)


def test_gestures_do_not_pass_through_the_own_body() -> None:
    humanoid = proportional_humanoid()
    model, names, radii = body_model(humanoid), humanoid.capsules.names, humanoid.capsules.radii
    trunk = [i for i, group in enumerate(humanoid.capsules.groups) if group in (DofGroup.ROOT, DofGroup.WAIST)]
    for clip in stock_clips(DofGroup.LEFT_ARM):
        q = np.zeros((9, DOF))
        q[:, 6:10] = clip.sample(np.linspace(clip.times[0], clip.times[-1], 9))
        segments = posture_capsules(model, q, np.zeros((9, 7))).astype(np.float64)
        for n in range(9):
            for part, allowed in (("leftHand", 0.0), ("leftForearm", 0.0), ("leftUpperArm", -0.05)):
                i = names.index(part)
                for j in trunk:
                    if (part, names[j]) == ("leftUpperArm", "shoulders"):
                        continue  # they share the shoulder
                    gap = segment_gap(segments[i, :, n], segments[j, :, n]) - radii[i] - radii[j]
                    assert gap > allowed, (clip.name, n, part, names[j])


@pytest.mark.parametrize("group", ARMS)
def test_the_arms_hang_at_rest_and_swing_more_when_faster(group: DofGroup) -> None:
    phases = np.linspace(0.0, 1.0, 200)
    still = arm_swing_goal(group, phases, np.zeros(200))
    np.testing.assert_allclose(still, np.tile(np.deg2rad([-2.0, 6.0, 3.0, 10.0]), (200, 1)))
    spans = [np.ptp(arm_swing_goal(group, phases, np.full(200, v))[:, 0]) for v in (0.2, 0.5, 1.2, 2.0, 3.0)]
    assert np.all(np.diff(spans) > 0.0)
    fast = arm_swing_goal(group, phases, np.full(200, 3.0))
    np.testing.assert_allclose(clamp(group, fast), fast)
    np.testing.assert_allclose(
        arm_swing_goal(group, phases, np.full(200, 1.2)), arm_swing(group).sample(phases), atol=0.01
    )


def test_arms_swing_opposite_to_each_other_when_fast_and_together_when_slow() -> None:
    phases = np.linspace(0.0, 1.0, 200, endpoint=False)
    for speed, sign, per_stride in ((1.3, -1.0, 1), (0.5, 1.0, 2), (-1.3, -1.0, 1)):
        left, right = (arm_swing_goal(group, phases, np.full(200, speed))[:, 0] for group in ARMS)
        assert sign * np.corrcoef(left, right)[0, 1] > 0.95
        assert np.argmax(np.abs(np.fft.rfft(left - left.mean()))) == per_stride
    # At the left heel strike the left arm is behind.
    assert (
        arm_swing_goal(DofGroup.LEFT_ARM, [0.0], [1.3])[0, 0] < arm_swing_goal(DofGroup.RIGHT_ARM, [0.0], [1.3])[0, 0]
    )


def test_the_change_of_swing_is_smooth() -> None:
    speeds = np.linspace(-2.0, 2.0, 2001)
    for phase in (0.0, 0.3, 0.7):
        goal = arm_swing_goal(DofGroup.LEFT_ARM, np.full(2001, phase), speeds)
        assert np.abs(np.diff(goal, axis=0)).max() < 0.01


def test_a_waist_does_not_swing() -> None:
    with pytest.raises(ValueError, match="WAIST"):
        arm_swing(DofGroup.WAIST)
    with pytest.raises(ValueError, match="WAIST"):
        arm_swing_goal(DofGroup.WAIST, [0.0], [1.0])


GOOD = {"name": "nod", "source": "authored", "loop": False, "keys": [[0, 0, 0, 0], [1, 10, 5, 0.5]]}


def written(**changes: object) -> str:
    return json.dumps({"part": "waist", "clips": [{**GOOD, **changes}]})


def test_a_clip_is_read_in_radians() -> None:
    (clip,) = parse_clips(written(), "x.json")
    np.testing.assert_allclose(clip.configurations[1], [np.deg2rad(10.0), np.deg2rad(5.0), 0.5])
    played = MotionClip(clip.name, clip.groups[0], clip.times, clip.configurations, clip.loop)
    assert played.duration == 1.0


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("{", "not JSON"),
        ("[" * 100_000, "not JSON"),
        ('{"part": "tail", "clips": []}', '"part"'),
        ('{"part": "arm", "clips": []}', '"clips"'),
        ('{"part": "arm", "clips": [3]}', "clips[0]"),
        (written(name=3), "name"),
        (written(loop=1), "loop"),
        (written(keys=[[0, 0, 0, 0]]), "keys"),
        (written(keys=[[0, 0, 0, 0], [1, 2]]), "keys[1]"),
        (written(keys=[[0, 0, 0, 0], [1, 2, 0, True]]), "keys[1]"),
        (written(keys=[[0, 0, 0, 0], [1, 2, 0, float("nan")]]), "keys[1]"),
        (written(keys=[[0, 0, 0, 0], [0, 2, 3, 0]]), "times"),
        (written(keys=[[0, 0, 0, 0], [1, 120, 0, 0]]), "limits"),
        (written(keys=[[0, 0, 0, 0], [1, 20, 0, -0.1]]), "limits"),
        (written(loop=True), "loop"),
    ],
)
def test_a_wrong_clip_is_named(text: str, place: str) -> None:
    with pytest.raises(InputError) as error:
        parse_clips(text, "x.json")
    assert "x.json" in str(error.value)
    assert place in str(error.value)
    assert "\n" not in str(error.value)
