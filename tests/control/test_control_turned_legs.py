"""Legs between two frames are where the judge has them, who turns joints by the shortest arc."""

import numpy as np

from elbowroom.body.dof import DOF, LOCAL
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, leg_capsules
from elbowroom.body.root import RISES, RootState
from elbowroom.control.feet.turned_legs import SHARES, turned_legs
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes
from elbowroom.experiment.judge.motion import Moments, ShownMotion
from elbowroom.experiment.judge.poses import Poser

AVATAR = Humanoid.default()
MODEL = body_model(AVATAR)


def judged(roots: np.ndarray) -> np.ndarray:
    """The ends (C, 6, N) of the capsules of pelvis and legs between two frames, as the judge poses them."""
    motion, zeros = ShownMotion.at_rate(np.zeros((2, DOF)), roots), np.zeros(len(SHARES), np.int64)
    placed = CapsuleShapes(AVATAR).placed(Poser(AVATAR).at(motion, Moments(zeros, zeros + 1, SHARES, SHARES / 60.0)))
    ends = [placed.middles - placed.half_axes, placed.middles + placed.half_axes]
    return np.concatenate(ends, axis=-1)[:, MODEL.roots.indices].transpose(1, 2, 0)


def test_legs_between_two_frames_are_where_the_judge_has_them() -> None:
    rng, uppers, farthest = np.random.default_rng(3), (np.zeros(LOCAL), np.zeros(LOCAL)), 0.0
    for _ in range(20):
        first = RootState(forward=rng.uniform(0.1, 1.2), phase=rng.uniform(0.0, 1.0)).as_array()
        second = first.copy()
        second[1], second[6] = 0.02, first[6] + 0.015
        for row in (first, second):
            row[RISES : RISES + 4 : 2] = rng.uniform(0.0, 0.15, 2)
        found = turned_legs(MODEL, (first, second), uppers)
        assert np.abs(found.axes - judged(np.stack([first, second]))).max() < 1e-5
        farthest = max(farthest, np.abs(found.axes - leg_capsules(MODEL, found.states)).max())
    assert farthest > 2e-3, "they are where straight interpolants are"
