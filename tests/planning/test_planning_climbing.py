"""Slower on stairs that are steeper than even ones, the steeper the slower; even ones and kerbs slow nobody."""

from typing import Any

import numpy as np
import pytest

from elbowroom.planning.root.line.climbing import steep_places
from elbowroom.world.scene import Scene

ROUTE = np.array([[0.0, 0.0], [0.0, 6.0]])


def stair(rise: float, deep: float, count: int) -> Scene:
    treads: list[dict[str, Any]] = [
        {"type": "box", "center": [0.0, 0.5 * rise * i, 2.0 + deep * i], "size": [2.0, rise * i, deep]}
        for i in range(1, count)
    ]
    end, top = 2.0 + deep * (count - 0.5), rise * count
    treads.append({"type": "box", "center": [0.0, 0.5 * top, 0.5 * (end + 7.0)], "size": [2.0, top, 7.0 - end]})
    return Scene.of("stair", treads, finish=(0.0, 6.0))


def share(scene: Scene, speed: float = 1.1) -> float:
    return float(steep_places(scene.ground, ROUTE, 0.0, speed)[:, 2].min(initial=1.0))


def test_the_steeper_the_slower_and_an_even_stair_and_one_step_slow_nobody() -> None:
    shares = [share(stair(0.17, deep, 8)) for deep in (0.28, 0.18, 0.14)]
    assert 0.15 < shares[2] < shares[1] < 0.6
    assert shares[0] == pytest.approx(1.0)
    assert share(stair(0.2, 0.3, 1)) == pytest.approx(1.0)
    assert share(Scene.of("plain", [], finish=(0.0, 6.0))) == pytest.approx(1.0)


def test_who_is_slow_is_not_slowed_and_the_places_lie_on_the_stair() -> None:
    scene = stair(0.17, 0.17, 8)
    assert share(scene, 0.2) == pytest.approx(1.0)
    places = steep_places(scene.ground, ROUTE, 0.0, 1.1)
    assert places[:, 1].min() > 1.5
    assert places[:, 1].max() < 2.0 + 0.17 * 8 + 0.6
