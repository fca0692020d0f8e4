"""Strides found in walks, and the swing that they become."""

from dataclasses import replace

import numpy as np
import pytest

from elbowroom.body.dof import ARMS, LOCAL_GROUPS, DofGroup, clamp
from elbowroom.clips.clip import Clip, motions_of
from elbowroom.clips.planning_motion import planning_motion
from elbowroom.clips.swing import resting, swing_of
from elbowroom.errors import InputError
from made_walk import FPS, PACE, SPEED, made_walk, upper_at
from sampled import sampled
from shared_data import SHARED, needs_shared


@pytest.mark.parametrize("on_the_spot", [False, True])
def test_phase_and_speed_of_our_own_gait_are_found(on_the_spot: bool) -> None:
    motion = planning_motion(made_walk(on_the_spot=on_the_spot))
    strides = motion.track.strides
    wanted = 0.3 + PACE * np.arange(len(motion)) / FPS
    away = strides.phases - wanted
    assert np.ptp(away[10:-10]) < 0.05
    assert abs(np.median(away) - round(float(np.median(away)))) < 0.08  # heel strike is where our gait has it
    assert strides.speed == pytest.approx(SPEED, rel=0.1)
    assert strides.on_the_spot is on_the_spot
    assert motion.track.states[30, 3] == pytest.approx(SPEED, rel=0.1)


def test_the_configurations_come_back() -> None:
    motion = planning_motion(made_walk())
    wanted = upper_at(0.3 + PACE * np.arange(len(motion)) / FPS)
    found = np.concatenate([motion.groups[group] for group in LOCAL_GROUPS], axis=1)
    middle = slice(20, -20)
    assert np.abs(found[middle, 3:] - wanted[middle, 3:]).max() < 0.02
    assert np.abs(found[middle, :2] - wanted[middle, :2]).max() < 0.02
    assert np.abs(found[middle, 2]).max() < 0.03
    assert motion.trunk_error.max() < 1e-3
    assert motion.arm_error.max() < 1e-3


def test_the_swing_is_the_stride_at_its_speed_and_rest_at_none() -> None:
    swing = swing_of(planning_motion(made_walk()), "made")
    phases = np.linspace(0.0, 2.0, 41)
    columns = {DofGroup.WAIST: slice(0, 3), DofGroup.LEFT_ARM: slice(3, 7), DofGroup.RIGHT_ARM: slice(7, 11)}
    columns[DofGroup.HEAD] = slice(11, 13)
    for group, at in columns.items():
        recorded = swing.goal(group, phases, np.full(41, swing.speed))
        assert (
            np.abs(recorded - upper_at(phases)[:, at]).max() < 0.12
        )  # our feet strike a little after they are farthest ahead
        np.testing.assert_allclose(recorded[0], recorded[20], atol=1e-9)
        np.testing.assert_allclose(swing.goal(group, phases, np.zeros(41)), np.tile(resting(group), (41, 1)), atol=1e-9)
        np.testing.assert_array_equal(clamp(group, recorded), recorded)
        steps = np.abs(np.diff(swing.goal(group, np.linspace(0, 1, 400), np.full(400, 1.2)), axis=0)).max()
        assert steps < 0.02  # no jump where the stride closes


def test_less_than_a_stride_and_standing_give_no_swing() -> None:
    short = made_walk(strides=1.2, first_phase=0.2)
    with pytest.raises(InputError, match="made"):
        swing_of(planning_motion(short), "made")
    still = made_walk()
    still = replace(still, turns=np.repeat(still.turns[:1], 50, axis=0), hips=np.repeat(still.hips[:1], 50, axis=0))
    with pytest.raises(InputError, match="nobody walks"):
        swing_of(planning_motion(still), "made")


WALKS = {
    # clip: m/s over the ground; whether it stays in place
    "cmu_02_02_walk.bvh": (1.3, 1.7, False),
    "walk01.bvh": (1.1, 1.5, False),
    "makehuman_walk1.bvh": (1.5, 2.6, True),
    "m2m_human-base-animations.glb#Walk_Loop": (0.8, 1.3, True),
    "m2m_human-base-animations.glb#Crouch_Fwd_Loop": (0.5, 0.9, True),
}


@needs_shared
@pytest.mark.parametrize("name", sampled(WALKS, 3))
def test_recorded_walks_give_a_swing(name: str) -> None:
    assert SHARED is not None
    clip = Clip.load(f"{SHARED}/motions/{name}")
    low, high, on_the_spot = WALKS[name]
    assert low <= clip.swing.speed <= high
    assert clip.planning.track.strides.on_the_spot is on_the_spot
    left, right = (clip.swing.keys[group] for group in ARMS)
    if "Crouch" not in name:  # arms swing opposite to their leg: back at their own side's heel strike
        assert left[0, 0] < left[16, 0]
        assert right[16, 0] < right[0, 0]


@needs_shared
@pytest.mark.parametrize("name", ["mocopi-mobile-arm-raise-turn.bvh", "fair1_wave_hello.bvh", "fair1_jumping.bvh"])
def test_who_does_not_walk_gives_no_swing(name: str) -> None:
    assert SHARED is not None
    with pytest.raises(InputError, match="nobody walks"):
        motions_of(Clip.load(f"{SHARED}/motions/{name}"))
