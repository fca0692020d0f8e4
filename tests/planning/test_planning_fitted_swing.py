"""A recorded swing made to suit a body."""

import numpy as np
import pytest

from elbowroom.body.dof import ARMS, LOCAL_GROUPS, clamp
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.clips.swing import KEYS, Swing, resting
from elbowroom.planning.model.fitted_swing import fitted
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs

HUMANOID = proportional_humanoid(1.72)
PHASES = np.arange(KEYS + 1) / KEYS


def swing(abduction: float, internal: float, elbow: float) -> Swing:
    """A plain swing with the arms held so, degrees."""
    keys = {group: np.zeros((KEYS + 1, group.size)) for group in LOCAL_GROUPS}
    for group, shift in zip(ARMS, (0.0, np.pi), strict=True):
        flexion = 20.0 * np.sin(2.0 * np.pi * PHASES + shift)
        held = np.tile([abduction, internal, elbow], (KEYS + 1, 1))
        keys[group] = clamp(group, np.deg2rad(np.column_stack([flexion, held])))
        keys[group][-1] = keys[group][0]
    return Swing("made", 1.1, keys)


def clearances(worn: MotionSet, speed: float = 1.1) -> np.ndarray:
    """Of each group on the waist and what it keeps clear of over a stride, (3, KEYS)."""
    roots = np.zeros((KEYS, 7))
    roots[:, 3], roots[:, 6] = speed, PHASES[:-1]
    uppers = np.concatenate([worn.goal(g, roots[:, 6], roots[:, 3]) for g in LOCAL_GROUPS], axis=1)
    model = body_model(HUMANOID)
    found: np.ndarray = self_clearances(model, self_pairs(model), roots, uppers)
    return found


def test_a_swing_that_suits_is_left_as_it_is() -> None:
    motions = MotionSet(swing(10.0, 0.0, 20.0))
    worn = fitted(motions, HUMANOID)
    assert worn.swing is not None
    for group, keys in swing(10.0, 0.0, 20.0).keys.items():
        np.testing.assert_array_equal(worn.swing.keys[group], keys)
    assert fitted(STOCK, HUMANOID) is STOCK


@pytest.mark.parametrize("held", [(-12.0, 0.0, 15.0), (0.0, 40.0, 95.0), (-25.0, 60.0, 120.0)])
def test_arms_are_kept_out_of_the_body(held: tuple[float, float, float]) -> None:
    motions = MotionSet(swing(*held))
    assert clearances(motions).min() < -0.01
    worn = fitted(motions, HUMANOID)
    assert clearances(worn).min() >= -0.005
    assert worn.swing is not None
    for group in ARMS:
        keys = worn.swing.keys[group]
        np.testing.assert_array_equal(clamp(group, keys), keys)
        np.testing.assert_allclose(keys[-1], keys[0], atol=1e-12)
        assert np.abs(np.diff(keys, axis=0)).max() < 0.2  # no jump
        assert np.linalg.norm(keys - resting(group), axis=1).max() > 0.2  # it still swings
