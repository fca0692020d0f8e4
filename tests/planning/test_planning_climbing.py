"""Slower on stairs, the steeper the slower, and the same wherever one comes from; kerbs and sills slow nobody."""

from typing import Any

import numpy as np
import pytest

from elbowroom.planning.root.line.climbing import places_along, places_on, steep_places
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.world.scene import Scene

LINE = TravelLine((0.0, 0.0), 0.0, 0.0, 0.0, 0.0, True)


def stair(rise: float, deep: float, count: int) -> Scene:
    treads: list[dict[str, Any]] = [
        {"type": "box", "center": [0.0, 0.5 * rise * i, 2.0 + deep * i], "size": [2.0, rise * i, deep]}
        for i in range(1, count)
    ]
    end, top = 2.0 + deep * (count - 0.5), rise * count
    treads.append({"type": "box", "center": [0.0, 0.5 * top, 0.5 * (end + 7.0)], "size": [2.0, top, 7.0 - end]})
    return Scene.of("stair", treads, finish=(0.0, 6.0))


def steep(scene: Scene, speed: float = 1.1, begin: float = 0.0) -> np.ndarray:
    return steep_places(scene.ground, places_on(LINE, begin, 6.0 - begin), (0.0, 0.0, begin), speed)


def share(scene: Scene, speed: float = 1.1) -> float:
    return float(steep(scene, speed)[:, 2].min(initial=1.0))


def test_the_steeper_the_slower_an_even_stair_at_the_pace_of_people_and_one_step_slows_nobody() -> None:
    shares = [share(stair(0.17, deep, 8)) for deep in (0.28, 0.18, 0.14)]
    assert 0.15 < shares[2] < shares[1] < shares[0]
    assert 0.5 < 1.1 * shares[0] < 0.7
    assert share(stair(0.2, 0.3, 1)) == pytest.approx(1.0)
    assert share(Scene.of("plain", [], finish=(0.0, 6.0))) == pytest.approx(1.0)


def test_who_is_slow_is_not_slowed_and_the_places_lie_on_the_stair() -> None:
    scene = stair(0.17, 0.17, 8)
    assert share(scene, 0.2) == pytest.approx(1.0)
    places = steep(scene)
    assert places[:, 1].min() > 1.5
    assert places[:, 1].max() < 2.0 + 0.17 * 8 + 0.6


@pytest.mark.parametrize("begin", [0.37, 1.411])
def test_the_places_are_the_same_bit_for_bit_from_wherever_on_the_line_they_are_seen(begin: float) -> None:
    scene = stair(0.17, 0.28, 8)
    assert np.array_equal(steep(scene, begin=begin), steep(scene))


def test_along_a_way_they_are_those_of_its_legs() -> None:
    scene, way = stair(0.17, 0.28, 8), ((0.0, 0.0), (0.0, 3.0), (0.5, 6.0))
    first, later = (
        steep_places(scene.ground, places_along(way, range(2)), (0.0, height, z), 1.1)
        for z, height in ((0.3, 0.0), (2.55, 0.34))
    )
    assert len(first) > 10
    assert np.array_equal(first, later)
