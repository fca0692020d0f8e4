"""The judge's own kinematics: equal to the body's, written twice; and the poses between frames."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF
from elbowroom.body.fitting.proportions import proportional_capsules, proportional_humanoid, proportional_skeleton
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, hips_position, local_rotations, posture_capsules
from elbowroom.errors import InputError
from elbowroom.experiment.judge.motion import Moments, ShownMotion
from elbowroom.experiment.judge.poses import Posed, Poser
from elbowroom.geometry import quaternion
from feet_walks import random_carriage, random_feet
from judged_bodies import random_postures
from naive_pose import required_only

Floats = NDArray[np.float64]

SMALL = required_only(proportional_skeleton(1.3))
BODIES = {
    "stock": Humanoid.default(),
    "average": proportional_humanoid(1.72),
    "required bones": Humanoid("required", SMALL, proportional_capsules(SMALL)),
}
FAST = np.array([0.3, 0.7, 0.0, 2.8, 0.0, 0.0, 0.4])  # legs stretched to their limit


def posed_at_frames(humanoid: Humanoid, q: Floats, roots: Floats) -> Posed:
    frames = np.arange(len(q))
    return Poser(humanoid).at(ShownMotion.at_rate(q, roots), Moments(frames, frames, np.zeros(len(q)), frames / 60))


@pytest.mark.parametrize("told", ["root", "feet", "carriage"])
@pytest.mark.parametrize("name", BODIES)
def test_equal_to_the_kinematics_of_the_body(name: str, told: str) -> None:
    humanoid, rng = BODIES[name], np.random.default_rng(4)
    q, roots = random_postures(rng, 200)
    roots[:20, 3:] = FAST[3:]
    roots = roots if told == "root" else random_feet(rng, roots)
    roots = random_carriage(rng, roots) if told == "carriage" else roots
    posed, capsules = posed_at_frames(humanoid, q, roots), humanoid.capsules
    ends = [
        posed.positions[:, capsules.joints] + np.einsum("ncij,cj->nci", posed.rotations[:, capsules.joints], offsets)
        for offsets in (capsules.starts, capsules.ends)
    ]
    theirs = np.moveaxis(posture_capsules(body_model(humanoid), q, roots), -1, 0)
    np.testing.assert_allclose(np.concatenate(ends, axis=-1), theirs, atol=2e-6)


@pytest.mark.parametrize("told", ["root", "feet", "carriage"])
@pytest.mark.parametrize("name", BODIES)
def test_equal_to_what_the_page_is_sent(name: str, told: str) -> None:
    humanoid, rng = BODIES[name], np.random.default_rng(5)
    model = body_model(humanoid)
    q, roots = random_postures(rng, 50)
    roots = roots if told == "root" else random_feet(rng, roots)
    roots = random_carriage(rng, roots) if told == "carriage" else roots
    rotations, hips = Poser(humanoid).local(q, roots)
    theirs = np.array([local_rotations(model, *row) for row in zip(q, roots, strict=True)])
    same = np.abs(np.sum(rotations * theirs, axis=-1))
    np.testing.assert_allclose(same, 1.0, atol=1e-12)
    np.testing.assert_allclose(hips, [hips_position(model, *row) for row in zip(q, roots, strict=True)], atol=1e-12)


def test_between_frames_as_on_the_page() -> None:
    humanoid = BODIES["average"]
    q, roots = random_postures(np.random.default_rng(6), 2)
    poser, motion = Poser(humanoid), ShownMotion.at_rate(q, roots)
    posed = poser.at(motion, Moments(np.array([0]), np.array([1]), np.array([0.25]), np.array([0.25 / 60])))
    (a, b), hips = poser.local(q, roots)
    near = np.where(np.sum(a * b, axis=-1, keepdims=True) < 0.0, -b, b)
    angle = np.arccos(np.clip(np.sum(a * near, axis=-1, keepdims=True), -1.0, 1.0))
    sine = np.maximum(np.sin(angle), 1e-12)
    blend = np.where(angle < 1e-6, a, (np.sin(0.75 * angle) * a + np.sin(0.25 * angle) * near) / sine)
    places = 0.75 * roots[:1, :3] + 0.25 * roots[1:, :3]
    expected = poser.world(quaternion.normalize(blend)[None], 0.75 * hips[:1] + 0.25 * hips[1:], places)
    np.testing.assert_allclose(posed.positions, expected.positions, atol=1e-9)
    np.testing.assert_allclose(posed.rotations, expected.rotations, atol=1e-9)


def test_240_poses_a_second_and_every_frame_among_them() -> None:
    motion = ShownMotion.at_rate(np.zeros((61, DOF)), np.zeros((61, 7)))
    moments = motion.moments(240.0)
    assert len(moments.times) == 241
    np.testing.assert_allclose(np.diff(moments.times), 1 / 240)
    np.testing.assert_array_equal(moments.first[moments.share == 0.0], np.arange(61))


def test_uneven_frames_are_cut_finely_enough() -> None:
    times = np.array([0.0, 0.05, 0.05, 0.0501, 0.3])
    motion = ShownMotion(times, np.zeros((5, DOF)), np.zeros((5, 7)), np.arange(5) == 0, np.ones(5, bool))
    moments = motion.moments(100.0)
    assert np.diff(moments.times).max() <= 1 / 100 + 1e-9
    assert np.isin(times, moments.times).all()


def test_nothing_is_shown_between_a_frame_and_a_jump() -> None:
    jumps = np.array([True, False, True, False])
    motion = ShownMotion(np.arange(4) / 60, np.zeros((4, DOF)), np.zeros((4, 7)), jumps, np.ones(4, bool))
    moments = motion.moments(240.0)
    assert not np.any((moments.first == 1) & (moments.share > 0.0))
    assert np.count_nonzero(moments.first == 0) == np.count_nonzero(moments.first == 2) == 4
    assert [(run.start, run.stop) for run in motion.runs()] == [(0, 2), (2, 4)]


def test_too_many_poses_are_refused() -> None:
    motion = ShownMotion.at_rate(np.zeros((3, DOF)), np.zeros((3, 7)), rate=1 / 3600)
    with pytest.raises(InputError, match="rate"):
        motion.moments(10_000.0)
