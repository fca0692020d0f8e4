"""The scenes of MotionBenchMaker (Chamzas et al., 2022) as obstacles, agreeing with coal on random capsules.

The figure of a million capsules is reached with `CAPSULES=1000000` in the environment; by itself the test takes fewer.
"""

import math
import os
import tarfile
from collections.abc import Iterator
from typing import Any

import coal
import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.experiment.judge.obstacles import obstacles_of
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Box, Cylinder, Shape, Sphere
from judged_bodies import scene_with
from shared_data import SHARED, needs_shared

yaml = pytest.importorskip("yaml", reason="the scenes are YAML: pip install pyyaml")

Floats = NDArray[np.float64]

ROBOTS = ("panda", "ur5")
CAPSULES = int(os.environ.get("CAPSULES", "4000"))
UP = np.array([-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)])  # their Z to our Y
TO_Y = np.array([math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)])  # their cylinders are about Z, ours about Y
CLOSE = 1e-5  # metres


def scenes(robot: str) -> Iterator[tuple[str, Any]]:
    """The first scene of each of a robot's problems."""
    assert SHARED is not None
    with tarfile.open(SHARED / "scenes" / "planning_benchmarks" / f"vamp_mbm_{robot}_problems.tar.bz2") as archive:
        for member in archive.getmembers():
            if member.name.endswith("scene0001.yaml"):
                file = archive.extractfile(member)
                assert file is not None
                yield member.name, yaml.safe_load(file.read())


def obstacles_in(scene: Any) -> Obstacles:
    """The primitives of a planning scene, Y up."""
    shapes, centers, turns, names = [], [], [], []
    for thing in scene["world"]["collision_objects"]:
        for primitive, pose in zip(thing["primitives"], thing["primitive_poses"], strict=True):
            shapes.append(shape_of(primitive["type"], [float(size) for size in primitive["dimensions"]]))
            turn = quaternion.multiply(UP, pose["orientation"])
            turns.append(quaternion.multiply(turn, TO_Y) if primitive["type"] == "cylinder" else turn)
            centers.append(quaternion.rotate(UP, np.array(pose["position"], np.float64)))
            names.append(str(thing["id"]))
    return Obstacles(tuple(shapes), np.array(centers), np.array(turns), tuple(names))


def shape_of(kind: str, size: list[float]) -> Shape:
    match kind, size:
        case "box", [x, y, z]:
            return Box((x, y, z))
        case "cylinder", [height, radius]:
            return Cylinder(radius, height)
        case "sphere", [radius]:
            return Sphere(radius)
    raise AssertionError(f"a primitive that is not known: {kind} {size}")


def touching_by_coal(segments: Floats, radius: float, obstacles: Obstacles) -> NDArray[np.bool_]:
    """Whether each capsule (6, N) touches anything."""
    judges, middles = obstacles_of(scene_with(obstacles)), 0.5 * (segments[:3] + segments[3:]).T
    steps = (segments[3:] - segments[:3]).T
    turns = quaternion.to_matrix(quaternion.between(np.tile([0.0, 0.0, 1.0], (len(steps), 1)), steps))
    lengths, request, result = np.linalg.norm(steps, axis=1), coal.CollisionRequest(), coal.CollisionResult()
    out = np.zeros(len(middles), np.bool_)
    for i, (turn, middle, length) in enumerate(zip(turns, middles, lengths.tolist(), strict=True)):
        capsule, place = coal.Capsule(radius, length), coal.Transform3s(turn, middle)
        for judge in judges:
            result.clear()
            if coal.collide(capsule, place, judge.shape, judge.place, request, result):
                out[i] = True
                break
    return out


@needs_shared
@pytest.mark.parametrize("robot", ROBOTS)
def test_capsules_touch_the_primitives_of_planning_scenes_where_coal_says_so(robot: str) -> None:
    found, rng, radius = list(scenes(robot)), np.random.default_rng(8), 0.06
    assert len(found) >= 5
    each = max(CAPSULES // len(found) // len(ROBOTS), 1)
    for _name, scene in found:
        obstacles = obstacles_in(scene)
        low, high = obstacles.first_bounds()
        begins = rng.uniform(low.min(axis=0), high.max(axis=0), (each, 3)).T
        segments = np.concatenate([begins, begins + rng.uniform(-0.3, 0.3, (3, each))]).astype(np.float32)
        gaps = clearance(segments[None], [radius], obstacles.standing)
        judged = touching_by_coal(segments.astype(np.float64), radius, obstacles)
        sure = np.abs(gaps) > CLOSE
        np.testing.assert_array_equal(gaps[sure] < 0.0, judged[sure])
        assert judged.any()
