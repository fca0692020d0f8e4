"""The map of free distances is filled once where somebody comes near, whatever height one comes from."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.free_map import CELL, TILE, FreeMap
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
