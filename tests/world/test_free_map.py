"""The map of free distances is filled once where one comes near, on the levels and the floor that are asked for."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.world.obstacles.free_map import CELL, LEVELS, TILE, FreeMap
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

WALL = {"type": "box", "center": [2.0, 1.2, 0.0], "size": [2.0, 2.4, 6.0]}  # in it there is no floor
TREADS = [
    {"type": "box", "center": [0.0, 0.09 * (i + 1), 0.3 * i], "size": [1.0, 0.18 * (i + 1), 0.3]} for i in range(4)
]


def test_who_climbs_beside_a_wall_has_its_tiles_filled_once_for_each_level() -> None:
    scene, filled = Scene.of("stair", [WALL, *TREADS], finish=(0.0, 5.0)), list[float]()

    def near(low: Floats, high: Floats, heights: tuple[float, float]) -> Nearby:
        filled.append(heights[0])
        return scene.obstacles.near(low, high, heights)

    free, side = FreeMap(near, scene.ground), CELL * TILE
    within = np.array([2.5, 0.5]) * side, np.array([3.5, 0.5]) * side  # two tiles with their middles in the wall
    climbed = np.arange(0.0, 0.72, 0.01)
    for height in climbed.tolist():
        free.window(*within, (0.0, height, 0.0))
    levels = len(filled) // 2
    assert levels < 0.1 * len(climbed), "each height has its own"
    assert levels >= 3, "what is beside is not the same from everywhere"
    assert np.ptp(filled) > 0.5


@pytest.mark.parametrize("place", [[WALL], [WALL, *TREADS]])
def test_some_levels_are_as_in_the_whole(place: list[dict[str, object]]) -> None:
    rng = np.random.default_rng(7)
    beams = [
        {"type": "box", "center": rng.uniform((-1.0, 0.4, -1.0), (1.0, 2.7, 2.0)).tolist(), "size": [0.8, 0.1, 0.1]}
        for _ in range(6)
    ]
    scene = Scene.of("place", [*place, *beams], start=(0.0, -4.0), finish=(0.0, 5.0))
    whole_first, alone = (FreeMap(scene.obstacles.near, scene.ground) for _ in range(2))
    low, high = np.array([-0.7, -0.9]), np.array([1.3, 1.1])
    whole = whole_first.window(low, high)
    assert whole.distances.min() < 0.05
    for levels in ((6, 7), (0, 3), (2, len(LEVELS))):
        for free in (alone, whole_first):
            some = free.window(low, high, levels=levels)
            assert (some.x, some.z, some.lowest) == (whole.x, whole.z, 0 if scene.ground.plain else levels[0])
            np.testing.assert_array_equal(some.distances, whole.distances[some.lowest :][: len(some.distances)])


def test_a_level_costs_a_level() -> None:
    scene, asked = Scene.of("stair", [WALL, *TREADS], finish=(0.0, 5.0)), list[tuple[float, float]]()

    def near(low: Floats, high: Floats, heights: tuple[float, float]) -> Nearby:
        asked.append(heights)
        return scene.obstacles.near(low, high, heights)

    free = FreeMap(near, scene.ground)
    for _ in range(2):
        free.window(np.zeros(2), np.array([0.1, 0.1]), levels=(6, 7))
    ((low, high),) = asked
    assert low > LEVELS[6] - 0.8
    assert high - low < 1.6
    free.distances(np.zeros((1, 2)), 1.0)
    assert len(free.window(np.zeros(2), np.array([0.1, 0.1]), levels=(6, 7)).distances) == len(LEVELS)
    assert len(asked) == 2
