"""What a sole is over on its way: the ground that holds it highest, whichever way it goes, turns and slopes."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.world.ground.ground import Ground
from elbowroom.world.ground.sole import Sole, sole_on
from elbowroom.world.ground.swept import SoleSpot, set_highest_under
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

SOLE = Sole(0.12, 0.24, 0.05)
BETWEEN = 0.037  # metres: no place is farther from one that is looked at
SHARES = np.linspace(0.0, 1.0, 7)
LOW = [(0.0, 0.2 * n, 3.0, 0.2, 0.08 * n) for n in range(1, 4)]  # x, z, sizes and top of some steps and posts
LOW += [(-0.3 * n, 0.1 * n, 0.12, 0.12, 0.2) for n in range(1, 4)]


@exact_kernel
def highest(ground: Ground, sole: Sole, begin: SoleSpot, end: SoleSpot, near: float, shares: Floats) -> Floats:
    """`set_highest_under`, for who is no kernel."""
    out = np.empty(shares.shape[0])
    set_highest_under(ground, sole, begin, end, near, shares, out)
    return out


def tops(x: Floats, z: Floats) -> Floats:
    """How high the ground is at places."""
    over = np.zeros_like(x)
    for at_x, at_z, wide, deep, top in LOW:
        over = np.where((abs(x - at_x) <= 0.5 * wide) & (abs(z - at_z) <= 0.5 * deep), np.maximum(over, top), over)
    return over


def under(spot: Floats, less: float, about: float) -> float:
    """The highest that is so high all `about` metres round, under a sole that is `less` long and wide at all sides."""
    x, z, yaw = spot
    ahead = np.linspace(less - SOLE.back, SOLE.ahead - less, 40)[:, None, None]
    aside = np.linspace(less - SOLE.aside, SOLE.aside - less, 8)[:, None]
    around = np.arange(9) * np.pi / 4.0
    radius = np.where(np.arange(9) < 8, about, 0.0)
    ahead, aside = ahead + radius * np.cos(around), aside + radius * np.sin(around)
    there = x + ahead * np.sin(yaw) + aside * np.cos(yaw), z + ahead * np.cos(yaw) - aside * np.sin(yaw)
    return float(tops(*there).min(axis=2).max())


def test_it_is_the_highest_that_the_sole_is_over_but_for_what_lies_between_looks() -> None:
    boxes = [{"type": "box", "center": [x, 0.5 * top, z], "size": [wide, top, deep]} for x, z, wide, deep, top in LOW]
    ground = Scene.of("low things", boxes, finish=(0.0, 3.0)).ground
    rng, over = np.random.default_rng(2), 0
    for _ in range(50):
        begin = rng.uniform((-0.8, -0.4, -3.0), (0.8, 0.8, 3.0))
        end = begin + rng.uniform((-0.5, -0.5, -0.6), (0.5, 0.5, 0.6))
        found = highest(ground, SOLE, (*begin.tolist(), 0.0), (*end.tolist(), 0.0), 0.1, SHARES)
        for share, height in zip(SHARES.tolist(), found.tolist(), strict=True):
            spot = begin + share * (end - begin)
            assert under(spot, BETWEEN, BETWEEN) - 1e-6 <= height <= under(spot, -BETWEEN, 0.0) + 1e-6
            over += height > 0.05
    assert over > 25


@pytest.mark.parametrize("yaw", [0.0, math.pi])
def test_a_sole_that_slopes_as_its_way_does_is_held_where_it_would_lie(yaw: float) -> None:
    grade, ahead = math.tan(math.radians(20.0)), math.cos(yaw)
    points = [[x, y, z] for x in (-1.0, 1.0) for y, z in ((0.0, 1.0), (0.0, 4.0), (3.0 * grade, 4.0))]
    ground = Scene.of("ramp", [{"type": "hull", "points": points, "center": [0, 0, 0]}], finish=(0.0, 6.0)).ground
    places = 2.5 + ahead * 0.5 * SHARES
    heights = grade * (places - 1.0)
    slope = -ahead * math.radians(20.0)
    begin, end = (0.0, 2.5, yaw, slope), (0.0, 2.5 + ahead * 0.5, yaw, slope)
    found = highest(ground, SOLE, begin, end, float(heights[0]), SHARES)
    assert found == pytest.approx(heights, abs=1e-9)
    assert sole_on(ground, SOLE, (0.0, float(heights[0]), 2.5), yaw) == pytest.approx((heights[0], slope))
    level = highest(ground, SOLE, (*begin[:3], 0.0), (*end[:3], 0.0), float(heights[0]), SHARES)
    assert np.all(level > heights + 0.09 * grade), "one that is level is held by its higher end"


def test_there_is_none_where_no_foot_stands() -> None:
    ground = Scene.of("step", [{"type": "box", "center": [0, 0.05, 2], "size": [1, 0.1, 1]}], finish=(0.0, 3.0)).ground
    assert np.all(np.isneginf(highest(ground, SOLE, (0.6, 0.0, 0.0, 0.0), (0.6, 0.1, 0.0, 0.0), 30.0, SHARES)))


@pytest.mark.parametrize("aside", [0.004, 0.017, 0.035, 0.06])
def test_a_narrow_sole_that_turns_on_its_way_is_over_ground_all_the_way(aside: float) -> None:
    """No place that was looked at lay under it: who has narrow soles swung his feet into the treads of a stair."""
    step = {"type": "box", "center": [0.0, 0.05, 1.6], "size": [3.0, 0.1, 2.0]}
    ground, sole = Scene.of("step", [step], finish=(0.0, 3.0)).ground, Sole(0.12, 0.24, aside)
    found = highest(ground, sole, (0.0, 0.0, 0.3, 0.0), (0.05, 1.0, 0.1, 0.0), 0.0, SHARES)
    assert found[0] == pytest.approx(0.0)
    assert found[-1] == pytest.approx(0.1)
    assert np.all(np.diff(found) >= 0.0)
