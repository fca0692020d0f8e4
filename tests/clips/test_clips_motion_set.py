"""What an avatar has learnt, given to graphs, goals and recordings."""

import json

import numpy as np
import pytest

from bvh_builder import BvhRecipe, random_motion, write_bvh
from elbowroom.body.clips.stock_clips import arm_swing_goal, stock_clips
from elbowroom.body.dof import ARMS, LOCAL_GROUPS, DofGroup, clamp, columns_of, followed, side_by_side
from elbowroom.clips.dodge import dodge_clips
from elbowroom.clips.files import parse_motion
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.clips.planning_motion import PlanningMotion, planning_motion
from elbowroom.clips.swing import KEYS, Swing, resting
from elbowroom.errors import InputError
from elbowroom.planning.paper.activity_graph import ActivityGraph


def learnt() -> MotionSet:
    """A made-up swing and a random clip."""
    rng = np.random.default_rng(0)
    keys = {}
    for group in LOCAL_GROUPS:
        rows = clamp(group, resting(group) + 0.2 * rng.standard_normal((KEYS + 1, group.size)))
        rows[-1] = rows[0]
        keys[group] = rows
    return MotionSet(Swing("made", 1.2, keys), dodge_clips(motion()))


def motion() -> PlanningMotion:
    made = random_motion(np.random.default_rng(1), 60, smooth=8.0)
    return planning_motion(parse_motion(write_bvh(made, BvhRecipe()), "a.bvh").clip().motion)


def test_without_clips_it_is_the_stock_walk() -> None:
    phases, speeds = np.linspace(0, 2, 30), np.linspace(-1, 2, 30)
    for group in ARMS:
        np.testing.assert_array_equal(STOCK.goal(group, phases, speeds), arm_swing_goal(group, phases, speeds))
        assert STOCK.clips(group)[: len(stock_clips(group))] == stock_clips(group)
    assert not STOCK.goal(DofGroup.WAIST, phases, speeds).any()
    assert STOCK.clips(DofGroup.WAIST) == stock_clips(DofGroup.WAIST)


def test_a_dodge_leads_from_rest_to_every_posture_of_the_motion() -> None:
    motions, recorded = learnt(), motion()
    for group in LOCAL_GROUPS:
        clips = [clip for clip in motions.dodges if clip.group is group]
        np.testing.assert_array_equal(clips[0].configurations[0], resting(group))
        known = np.concatenate([clip.configurations for clip in clips])
        gaps = np.linalg.norm(known[:, None] - recorded.groups[group], axis=2).min(axis=0)
        assert gaps.max() < 0.16
        assert len(ActivityGraph.from_clips(motions.clips(group), 8, 0.5, 1024).vertices) > 30


def test_a_set_survives_json_to_the_last_bit() -> None:
    motions = learnt()
    again = MotionSet.from_dict(json.loads(json.dumps(motions.to_dict())), "test")
    for group in LOCAL_GROUPS:
        phases = np.linspace(0, 1, 20)
        np.testing.assert_array_equal(again.goal(group, phases, phases), motions.goal(group, phases, phases))
        for one, other in zip(again.clips(group), motions.clips(group), strict=True):
            np.testing.assert_array_equal(one.configurations, other.configurations)
            np.testing.assert_array_equal(one.times, other.times)


def test_a_swing_from_before_the_head_was_planned_has_it_follow() -> None:
    written = json.loads(json.dumps(learnt().to_dict()))
    del written["swing"]["keys"]["HEAD"]
    swing = MotionSet.from_dict(written, "test").swing
    assert swing is not None
    uppers = side_by_side(swing.keys)
    np.testing.assert_array_equal(followed(uppers), uppers)
    assert np.ptp(uppers[:, columns_of(DofGroup.HEAD)]) > 0.1


def test_the_upright_set_lowers_nothing() -> None:
    raised = learnt().upright()
    goal = raised.goal(DofGroup.WAIST, np.linspace(0, 1, 20), np.ones(20))
    assert not goal[:, 2].any()
    assert goal[:, :2].any()
    assert not any(clip.configurations[:, 2].any() for clip in raised.dodges if clip.group is DofGroup.WAIST)


@pytest.mark.parametrize(
    "change",
    [
        lambda data: data.pop("swing"),
        lambda data: data["swing"].update(speed=0.0),
        lambda data: data["swing"]["keys"].pop("WAIST"),
        lambda data: data["dodges"][0].update(group="LEG"),
        lambda data: data["dodges"][0].update(keys=[[9.0, 9.0, 9.0]] * 2, times=[0, 1], group="WAIST"),
        lambda data: data["dodges"][0]["times"].reverse(),
        lambda data: data.update(dodges=[{}] * 2000),
    ],
)
def test_damaged_sets_are_refused(change: object) -> None:
    data = json.loads(json.dumps(learnt().to_dict()))
    change(data)  # type: ignore[operator]
    with pytest.raises(InputError, match=r"run\.elbow"):
        MotionSet.from_dict(data, "run.elbow")
