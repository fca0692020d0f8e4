"""What stands out at single vertices is held: by the least that holds it."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.fitting.slim_capsule import Slim
from elbowroom.body.fitting.tips import Tips, with_tips

Floats = NDArray[np.float64]

HEAD = Slim(np.array([0.0, 1.55, 0.0]), np.array([0.0, 1.65, 0.0]), 0.1)
NECK = Slim(np.array([0.0, 1.45, 0.0]), np.array([0.0, 1.55, 0.0]), 0.06)
MARGIN = 0.005


def round_head() -> Floats:
    """Points on the head's capsule."""
    ways = np.random.default_rng(0).normal(size=(400, 3))
    ways *= HEAD.radius / np.linalg.norm(ways, axis=1, keepdims=True)
    points: Floats = ways + np.where(ways[:, 1:2] > 0.0, HEAD.end, HEAD.start)
    return points


def held(tip: Floats, most: int = 24) -> tuple[Slim, ...]:
    """The head's capsules where one of its vertices is at `tip`."""
    points = round_head()
    tips = {"head": Tips(np.concatenate([points, [tip]]), points, MARGIN, 0.02)}
    found = with_tips({"head": (HEAD,), "neck": (NECK,)}, tips, most, 0.85)
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
    tips = {"head": Tips(np.array([tip]), np.zeros((0, 3)), MARGIN, 0.02)}
    head, same = with_tips({"head": (HEAD, crown)}, tips, 24, 0.85)["head"]
    assert head.radius == pytest.approx(0.103)
    assert same.radius == crown.radius
