"""The paper's scenes as VRML files: walked through as those of boxes are."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import ArrayLike

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.crossing import CrossingResult, controller_for, run_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.world.obstacles.shapes import Box
from elbowroom.world.scene import Scene


def as_vrml(scene: Scene) -> str:
    """A scene of boxes in VRML97: a floor, and a Box for each."""
    x, z = scene.ground_center
    nodes = [_box("Floor", (x, -0.05, z), (0.0, 1.0, 0.0, 0.0), (scene.ground_size[0], 0.1, scene.ground_size[1]))]
    for number, (_, shape, center, turn) in enumerate(scene.obstacles):
        assert isinstance(shape, Box)
        half = float(np.arccos(np.clip(turn[3], -1.0, 1.0)))
        axis = turn[:3] / np.sin(half) if half > 1e-9 else np.array([0.0, 1.0, 0.0])
        nodes.append(_box(f"Box_{number}", center, (*axis, 2.0 * half), shape.size))
    return "\n".join(["#VRML V2.0 utf8", *nodes])


def _box(name: str, center: ArrayLike, rotation: ArrayLike, size: ArrayLike) -> str:
    middle, turned, lengths = (
        " ".join(f"{value:.9g}" for value in np.ravel(each)) for each in (center, rotation, size)
    )
    shape = f"Shape {{ geometry Box {{ size {lengths} }} }}"
    return f"DEF {name} Transform {{ translation {middle} rotation {turned} children {shape} }}"


def written(scene: Scene, folder: Path) -> Path:
    """The file of a scene whose obstacles are a VRML world."""
    (folder / f"{scene.name}.wrl").write_text(as_vrml(scene), "utf-8")
    document = {**scene.to_dict(), "obstacles": [], "place": {"file": f"{scene.name}.wrl", "ground": 0.0}}
    path = folder / f"{scene.name}.json"
    path.write_text(json.dumps(document), "utf-8")
    return path


def crossed(scene: Scene, seed: int) -> CrossingResult:
    settings = CrossingSettings(seed=seed)
    return run_crossing(controller_for(Humanoid.default(), scene, settings), settings)


@pytest.mark.parametrize("name", ["a", *(pytest.param(name, marks=pytest.mark.long) for name in "bcd")])
def test_a_scene_of_the_paper_is_crossed_as_well_when_it_is_a_vrml_world(name: str, tmp_path: Path) -> None:
    boxes = Scene.load(name)
    world = Scene.load(written(boxes, tmp_path))
    assert world.start == boxes.start
    for seed in (1, 2):
        ours, theirs = crossed(world, seed), crossed(boxes, seed)
        assert (ours.passed, ours.straight) == (theirs.passed, theirs.straight) == (True, True)
        assert ours.passed_time_s == pytest.approx(theirs.passed_time_s, rel=0.1)
        assert ours.least_clearance >= 0.0
