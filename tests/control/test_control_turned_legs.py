"""Legs between two frames are where the judge has them, who turns joints by the shortest arc."""

import numpy as np

from elbowroom.body.dof import DOF, LOCAL
from elbowroom.body.gait.foot_state import Z
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, leg_capsules
from elbowroom.body.root import RISES, ROOT_STATE, SHOWN, RootState
from elbowroom.control.feet.turned_legs import turned_at, turned_legs
from elbowroom.control.shown.body_check import BodyCheck, Frames
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes
from elbowroom.experiment.judge.motion import Moments, ShownMotion
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.world.scene import Scene

AVATAR = Humanoid.default()
SHARES = np.array([0.25, 0.5, 0.75])
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
        found = turned_legs(MODEL, (first, second), uppers, SHARES)
        assert np.abs(found.axes - judged(np.stack([first, second]))).max() < 1e-5
        farthest = max(farthest, np.abs(found.axes - leg_capsules(MODEL, found.states)).max())
    assert farthest > 2e-3, "they are where straight interpolants are"


# Somebody goes down a stair backwards, and the right foot is put from before the body to behind it at once.
BEFORE = (
    -0.018, 2.4953, 6.2899, -0.5628, 0.001, -0.0073, 5.3388, 0.3815, -0.3473, 0.1295, 0.0, 0.2985, 0.0,
    0.0865, 0.031, -0.0002, 0.1493, 0.0001, 0.9829, 0.0, 0.0, 0.0, -0.0854, 0.3031, 0.0044, -0.0165, 0.0, 0.2,
)  # fmt: skip
AFTER = (
    -0.018, 2.4859, 6.2898, -0.5636, 0.001, -0.0072, 5.3557, 0.3757, -0.3484, 0.1343, 0.0, 0.2957, 0.0,
    0.0855, 0.006, 0.0003, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -0.0852, -0.0876, -0.0009, 0.0829, 0.0263, 0.6179,
)  # fmt: skip


def shown(values: tuple[float, ...]) -> np.ndarray:
    return np.array([*values, *[0.0] * (SHOWN - len(values))])


def test_a_foot_that_is_put_elsewhere_at_once_is_looked_at_all_the_way() -> None:
    """Straight on it is clear of the treads, with legs that turn by the shortest arcs it is in one."""
    treads = [
        {"type": "box", "center": [0.0, 0.085 * k, 1.86 + 0.28 * k], "size": [1.8, 0.17 * k, 0.28]} for k in range(1, 8)
    ]
    scene, upper = Scene.of("stair", treads, finish=(0.0, 9.0)), np.zeros(LOCAL)
    check, rows = BodyCheck(AVATAR, scene), (shown(BEFORE), shown(AFTER))
    straight = [rows[0] + share * (rows[1] - rows[0]) for share in np.linspace(0.0, 1.0, 21)]
    assert min(check.clearance(row, upper, 0.0) for row in straight) > 0.0
    q = np.zeros((2, DOF))
    q[:, :3] = [row[:3] for row in rows]
    verdict = judge(ShownMotion.at_rate(q, np.stack(rows)), AVATAR, scene, JudgeSettings(mesh=False))
    assert verdict.capsules.touching > 0
    assert not check.free_between(Frames(rows, (upper, upper), (0.0, 1 / 60)))


def test_feet_that_hardly_move_are_not_looked_at_again() -> None:
    row = shown(BEFORE)
    assert len(turned_at(row, row)) == 0
    moved, far = row.copy(), row.copy()
    moved[ROOT_STATE + Z] += 0.05
    far[ROOT_STATE + Z] += 0.3
    assert len(turned_at(row, moved)) == 0
    assert np.diff(turned_at(row, far), prepend=0.0, append=1.0).max() <= 0.02 / 0.3
