"""The level triangles of all that stands, found together, against those of one thing after the other."""

import numpy as np

from elbowroom.geometry import quaternion
from elbowroom.world.ground.making import level_triangles
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

DRUM = {"type": "cylinder", "radius": 0.2, "height": 1.0}
BOX = {"type": "box", "size": [0.3, 1.0, 0.3]}
LEAF = {"type": "mesh", "vertices": [[-0.5, 0, 0], [0.5, 0, 0], [0, 0.2, 1]], "faces": [[0, 1, 2]]}


def _scene(count: int) -> Scene:
    rng = np.random.default_rng(count)
    turned = (quaternion.from_rotation_vector(rng.normal(0.0, 0.3, 3)).tolist() for _ in range(count))
    obstacles = [
        {**(DRUM, BOX, LEAF)[i % 3], "center": [float(i % 60) - 30.0, 2.0, 3.0 + i // 60], "rotation": turn}
        for i, turn in enumerate(turned)
    ]
    return Scene.from_dict(
        {
            "format": "elbowroom-scene", "version": 1, "name": "many", "ground": {"size": [80, 80], "center": [0, 20]},
            "start": {"position": [0, 0], "heading": 0}, "finish": {"position": [0, 50]}, "obstacles": obstacles,
        }
    )  # fmt: skip


def _alone(every: Obstacles, i: int) -> Obstacles:
    one = slice(i, i + 1)
    return Obstacles(
        every.shapes[one], every.centers[one], every.rotations[one], every.standing_names[one], ground=every.ground
    )


def test_level_triangles_of_all_are_those_of_each_to_the_bit() -> None:
    every = _scene(180).obstacles
    each = [level_triangles(_alone(every, i)) for i in range(len(every.shapes))]
    together = level_triangles(every)
    assert len(together) > 1000  # of some 8000 that are turned, more than are turned at once
    np.testing.assert_array_equal(together, np.concatenate(each))


def test_of_nothing_there_are_none() -> None:
    assert level_triangles(_scene(0).obstacles).shape == (0, 3, 3)
