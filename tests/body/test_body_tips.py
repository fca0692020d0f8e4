"""What stands out at single vertices is held: by the least that holds it, and in every pose."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.fitting.flexing import PosedPoints, poses_of
from elbowroom.body.fitting.proportions import proportional_skeleton
from elbowroom.body.fitting.slim_capsule import Slim
from elbowroom.body.fitting.tips import Limits, Tips, with_tips

Floats = NDArray[np.float64]

HEAD = Slim(np.array([0.0, 1.55, 0.0]), np.array([0.0, 1.65, 0.0]), 0.1)
NECK = Slim(np.array([0.0, 1.45, 0.0]), np.array([0.0, 1.55, 0.0]), 0.06)
MARGIN = 0.005
SKELETON = proportional_skeleton(1.7)
POSES = poses_of(SKELETON)
JOINTS = {"head": SKELETON.index("head"), "neck": SKELETON.index("neck")}


def standing(points: Floats) -> PosedPoints:
    """Points (N, 3) in T-pose."""
    return PosedPoints(points, np.zeros(len(points), np.int64))


def tips_of_head(vertices: Floats, samples: Floats) -> dict[str, Tips]:
    """What is seen of a head."""
    tips = Tips(JOINTS["head"], standing(vertices), standing(samples), MARGIN, 0.01, 0.02)
    return {"head": tips}


def round_head() -> Floats:
    """Points on the head's capsule."""
    ways = np.random.default_rng(0).normal(size=(400, 3))
    ways *= HEAD.radius / np.linalg.norm(ways, axis=1, keepdims=True)
    points: Floats = ways + np.where(ways[:, 1:2] > 0.0, HEAD.end, HEAD.start)
    return points


def held(tip: Floats, most: int = 24) -> tuple[Slim, ...]:
    """The head's capsules where one of its vertices is at `tip`."""
    points = round_head()
    tips = tips_of_head(np.concatenate([points, [tip]]), points)
    found = with_tips({"head": (HEAD,), "neck": (NECK,)}, JOINTS, tips, POSES, Limits(most, 0.85))
    assert found["neck"][0] is NECK
    every = [slim.outside(np.concatenate([points, [tip]])) for slim in (*found["head"], NECK)]
    assert np.min(every, axis=0).max() <= MARGIN + 1e-9
    return found["head"]


@pytest.mark.parametrize("tip", [[0.0, 1.6, 0.1], [0.0, 1.4, 0.0]], ids=["on the head", "in the neck"])
def test_what_is_held_by_any_part_changes_nothing(tip: list[float]) -> None:
    (same,) = held(np.array(tip))
    assert same is HEAD


def test_for_a_short_nose_the_head_has_another_capsule_hardly_larger() -> None:
    (head,) = held(np.array([0.0, 1.6, 0.109]))
    assert head is not HEAD
    assert 0.9 < head.volume / HEAD.volume < 1.15


def test_a_long_nose_has_a_capsule_of_its_own_if_there_may_be_another() -> None:
    head, nose = held(np.array([0.0, 1.6, 0.16]))
    assert head is HEAD
    assert nose.volume < 0.05 * HEAD.volume
    (thicker,) = held(np.array([0.0, 1.6, 0.16]), most=2)
    assert thicker.volume > 1.15 * HEAD.volume


def test_of_two_capsules_the_nearer_one_grows() -> None:
    tip = np.array([0.0, 1.6, 0.108])
    crown = Slim(np.array([0.0, 1.7, 0.0]), np.array([0.0, 1.75, 0.0]), 0.05)
    tips = tips_of_head(np.concatenate([round_head(), [tip]]), round_head())
    head, same = with_tips({"head": (HEAD, crown)}, JOINTS, tips, POSES, Limits(24, 0.85))["head"]
    assert head.outside(tip[None])[0] <= MARGIN + 1e-9
    assert head.volume < 1.1 * HEAD.volume
    assert same is crown


def test_a_kneecap_is_held_when_the_knee_is_bent_too() -> None:
    """It hangs on both bones by half, so that it is before the end of either where the knee is bent."""
    knee, ankle, hip = (SKELETON.positions[SKELETON.index(f"left{bone}")] for bone in ("LowerLeg", "Foot", "UpperLeg"))
    thigh, shin = (
        Slim(hip, knee + np.array([0.0, 0.07, 0.0]), 0.08),
        Slim(knee - np.array([0.0, 0.05, 0.0]), ankle, 0.05),
    )
    joints = {name: SKELETON.index(f"left{bone}") for name, bone in (("thigh", "UpperLeg"), ("shin", "LowerLeg"))}
    cap = knee + np.array([0.0, 0.0, 0.045])
    both = POSES.carried(np.array([joints["thigh"], joints["shin"]]), np.array([cap, cap])).mean(axis=1)
    calf = shin.end + np.array([0.0, 0.0, shin.radius])
    vertices = np.concatenate([both, POSES.carried(np.array(joints["shin"]), calf)])
    seen = PosedPoints(vertices, np.tile(np.arange(len(POSES)), 2))
    first: dict[str, tuple[Slim, ...]] = {"thigh": (thigh,), "shin": (shin,)}

    def outside(held: dict[str, tuple[Slim, ...]]) -> Floats:
        every = [POSES.outside(slim, joints[name], seen) for name, some in held.items() for slim in some]
        nearest: Floats = np.min(every, axis=0)
        return nearest

    assert outside(first)[0] < MARGIN < 0.01 < outside(first).max()
    tips = {"shin": Tips(joints["shin"], seen, standing(np.zeros((0, 3))), MARGIN, 0.01, 0.02, leans=("thigh",))}
    found = with_tips(first, joints, tips, POSES, Limits(24, 0.85))
    assert outside(found).max() <= MARGIN + 1e-9
    assert found["thigh"] == (thigh,)
