"""Scenes that leave: their surfaces are where coal and trimesh's mathematics have them, and what moves there moves."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from avatar_builder import json_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.export.animation import Animation
from elbowroom.export.avatar_glb import avatar_glb
from elbowroom.export.formats import RootMotion
from elbowroom.export.place import place_glb, with_place
from elbowroom.formats.animations import read_animations, take_of
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.shapes import Box, Capsule, Cylinder, Hull, Shape, Sphere
from elbowroom.world.obstacles.triangles import triangles_of
from elbowroom.world.scene import Scene
from made_recording import made_recording

Floats = NDArray[np.float64]
STOCK = Humanoid.default()
VOLUMES: list[tuple[Shape, float]] = [
    (Box((1.0, 2.0, 3.0)), 6.0),
    (Sphere(0.5), 4.0 / 3.0 * np.pi * 0.125),
    (Capsule(0.3, 1.0), np.pi * 0.09 * (1.0 + 0.4)),
    (Cylinder(0.5, 2.0), np.pi * 0.5),
    (Hull(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))), 1.0 / 6.0),
]


@pytest.mark.parametrize(("shape", "volume"), VOLUMES, ids=lambda value: type(value).__name__)
def test_surfaces_are_closed_face_outwards_and_hold_what_the_shape_holds(shape: Shape, volume: float) -> None:
    corners = triangles_of(shape).reshape(-1, 3)
    body = trimesh.Trimesh(corners, np.arange(len(corners)).reshape(-1, 3), process=True)
    body.merge_vertices(digits_vertex=9)
    assert body.is_watertight
    assert body.volume == pytest.approx(volume, rel=0.03)


@pytest.mark.parametrize("name", ["d", "shapes", "traffic"])
def test_a_scene_is_written_with_every_obstacle_by_its_name(name: str) -> None:
    scene = Scene.load(name)
    content = json_of(place_glb(scene))
    names = [node["name"] for node in content["nodes"]]
    assert names[:2] == ["ground", "finish"]
    assert tuple(names[2:]) == scene.obstacles.names
    for node, (_, _, center, _) in zip(content["nodes"][2:], scene.obstacles, strict=False):
        np.testing.assert_allclose(node.get("translation", [0, 0, 0]), center, atol=1e-9)


def test_a_run_leaves_whole_place_avatar_and_motion(tmp_path: Path) -> None:
    scene = Scene.load("traffic")
    made = made_recording(tmp_path / "run.elbow", STOCK, 30)
    animation = Animation.of(made.recording, STOCK)
    alone = avatar_glb(animation, STOCK, RootMotion.HIPS)
    whole = with_place(alone, scene, animation)
    gltf = parse_gltf(whole, "run.glb")
    tree = read_nodes(gltf)
    (found,) = read_animations(gltf, len(tree))
    take = take_of(found, tree, "run")
    assert STOCK.rig is not None
    np.testing.assert_allclose(take.world(STOCK.rig.nodes)[1], animation.joints_in_world(), atol=1e-5)
    for track in scene.obstacles.moving.tracks:
        node = np.array([tree.names.index(track.name)])
        turns, places = take.world(node)
        centers, yaws = track.poses(made.times)
        np.testing.assert_allclose(places[:, 0], centers, atol=1e-5)
        assert quaternion.angle_between(turns[:, 0], quaternion.about_axis(1, yaws)).max() < 1e-5
    assert json_of(whole)["meshes"][: len(json_of(alone)["meshes"])] == json_of(alone)["meshes"]
