"""The capsules' judge: a case worked out by hand, and brute force."""

import coal
import numpy as np
import pytest

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.experiment.judge.capsule_judge import CapsuleJudge
from elbowroom.experiment.judge.case import Case
from elbowroom.experiment.judge.ledger import Ledger
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.obstacles import obstacles_of
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.clearance import pairwise_clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from judged_bodies import T_POSE, gliding, random_boxes, random_postures, scene_with, upright
from sampled import sampled

BODY = proportional_humanoid(1.72)
CAPSULES = JudgeSettings(mesh=False)


def hand_of(humanoid: Humanoid) -> tuple[np.ndarray, np.ndarray, float]:
    """Both ends of the left hand's capsule in T-pose, and its radius."""
    which = humanoid.capsules.names.index("leftHand")
    segments = posture_capsules(body_model(humanoid), T_POSE[None], np.zeros((1, 7)))[which, :, 0].astype(float)
    return segments[:3], segments[3:], float(humanoid.capsules.radii[which])


def post_before_the_hand(front: float) -> Obstacles:
    """A post wider than high: its front face at z = `front`, in the way of nothing but the left hand."""
    a, b, _ = hand_of(BODY)
    middle = 0.5 * (a + b)
    return upright(((middle[0], middle[1], front + 0.3), (0.02, 0.6, 0.6)))


def test_a_hand_pushed_into_a_post_is_reported_in_full() -> None:
    _, _, radius = hand_of(BODY)
    reach = max(end[2] for end in hand_of(BODY)[:2]) + radius
    q, roots = gliding(T_POSE, 61, speed=0.6)  # one second, 0.6 m
    front = reach + 0.57  # the last 30 mm are inside
    verdict = judge(ShownMotion.at_rate(q, roots), BODY, scene_with(post_before_the_hand(front)), CAPSULES)
    assert not verdict.clean
    assert verdict.frames == 61
    assert verdict.poses == 241
    (contact,) = verdict.capsules.contacts
    assert (contact.part, contact.obstacle) == ("leftHand", "box 0")
    assert contact.deepest.time == pytest.approx(1.0)
    assert verdict.capsules.deepest == pytest.approx(0.03, abs=2e-5)
    assert contact.first == pytest.approx(0.57 / 0.6, abs=1.5 / 240)
    assert contact.last == pytest.approx(1.0)
    assert verdict.capsules.touching == contact.poses == pytest.approx(0.03 / 0.6 * 240, abs=1)


def test_a_hand_that_stops_before_a_post_is_clean() -> None:
    _, _, radius = hand_of(BODY)
    reach = max(end[2] for end in hand_of(BODY)[:2]) + radius
    q, roots = gliding(T_POSE, 61, speed=0.6)
    verdict = judge(ShownMotion.at_rate(q, roots), BODY, scene_with(post_before_the_hand(reach + 0.607)), CAPSULES)
    assert verdict.clean
    assert verdict.capsules.contacts == ()
    least = verdict.capsules.least
    assert least is not None
    assert (least.part, least.obstacle) == ("leftHand", "box 0")
    assert least.clearance == pytest.approx(0.007, abs=1e-5)
    assert least.time == pytest.approx(1.0)


def test_a_contact_between_two_frames_is_seen() -> None:
    """A thin board is jumped over by the frames, not by the poses between them."""
    _, _, radius = hand_of(BODY)
    a, b, _ = hand_of(BODY)
    q, roots = gliding(T_POSE, 2, speed=0.6 * 60, z=-0.3)  # from 0.3 m before to 0.3 m behind
    thin = upright(((0.5 * (a[0] + b[0]), a[1], 0.5 * (a[2] + b[2])), (0.02, 0.6, 0.002)))
    motion = ShownMotion.at_rate(q, roots)
    assert judge(motion, BODY, scene_with(thin), JudgeSettings(60.0, mesh=False)).clean
    verdict = judge(motion, BODY, scene_with(thin), CAPSULES)
    assert verdict.capsules.touching == 1
    assert verdict.capsules.deepest == pytest.approx(radius + 0.001, abs=2e-5)


def test_without_obstacles_everything_is_far() -> None:
    q, roots = gliding(T_POSE, 3, speed=1.0)
    verdict = judge(ShownMotion.at_rate(q, roots), BODY, scene_with(Obstacles()), CAPSULES)
    assert verdict.clean
    assert verdict.capsules.least is None
    assert verdict.mesh is None


@pytest.mark.parametrize("seed", sampled(range(4)))
def test_nothing_is_missed(seed: int) -> None:
    """Every pair judged one by one, with end points from the body's own kinematics, gives the same."""
    rng = np.random.default_rng(seed)
    q, roots = random_postures(rng, 12)
    boxes = random_boxes(rng, 3)
    segments = posture_capsules(body_model(BODY), q, roots).astype(float)
    distances = np.array(
        [
            [[coal_distance(segments[c, :, n], float(r), boxes, b) for b in range(3)] for n in range(12)]
            for c, r in enumerate(BODY.capsules.radii)
        ]
    )
    motion, ledger = ShownMotion.at_rate(q, roots), Ledger(1e-5)
    moments = motion.moments(60.0)
    judges = CapsuleJudge(BODY, obstacles_of(scene_with(boxes)))
    judges.judge(Case(Poser(BODY).at(motion, moments), moments.times, 0, ledger))
    assert ledger.least is not None
    assert ledger.least.clearance == pytest.approx(distances.min(), abs=1e-5)
    clear, touching = distances.min(axis=(0, 2)) > 0.0, distances.min(axis=(0, 2)) < -2e-5
    assert set(np.flatnonzero(touching)) <= ledger.touching <= set(np.flatnonzero(~clear))
    for contact in ledger.contacts:
        part, box = BODY.capsules.names.index(contact.part), int(contact.obstacle.split()[1])
        assert contact.deepest.clearance == pytest.approx(distances[part, :, box].min(), abs=1e-5)


def test_agrees_with_our_own_clearance() -> None:
    rng = np.random.default_rng(9)
    q, roots = random_postures(rng, 40)
    near = random_boxes(rng, 2)
    boxes = Obstacles.boxes(near.centers + np.array([4.0, 0.0, 0.0]), near.rotations, near.half_sizes)
    gaps = pairwise_clearance(posture_capsules(body_model(BODY), q, roots), BODY.capsules.radii, boxes.standing)
    verdict = judge(ShownMotion.at_rate(q, roots), BODY, scene_with(boxes), JudgeSettings(rate=60.0, mesh=False))
    assert verdict.capsules.least is not None
    assert verdict.capsules.least.clearance == pytest.approx(float(gaps.min()), abs=1e-5)


def coal_distance(segment: np.ndarray, radius: float, boxes: Obstacles, index: int) -> float:
    a, b = segment[:3], segment[3:]
    capsule = coal.Capsule(radius, float(np.linalg.norm(b - a)))
    turn = quaternion.to_matrix(quaternion.between([0.0, 0.0, 1.0], b - a))
    box = coal.Box(*(2.0 * boxes.half_sizes[index]))
    place = coal.Transform3s(quaternion.to_matrix(boxes.rotations[index]), boxes.centers[index])
    at = coal.Transform3s(turn, 0.5 * (a + b))
    return float(coal.distance(capsule, at, box, place, coal.DistanceRequest(), coal.DistanceResult()))
