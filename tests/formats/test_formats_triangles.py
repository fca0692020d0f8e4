"""Triangles with all joints of each vertex: every primitive mode, weights made whole, damage refused."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.gltf import Gltf, parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.packing import write_glb
from elbowroom.formats.triangles import TriangleMesh, triangle_mesh

POINTS = np.arange(15, dtype="<f4").reshape(5, 3)


def asset(primitive: dict[str, Any], arrays: Mapping[str, NDArray[Any]] | None = None, skinned: bool = True) -> Gltf:
    """Two joints and one mesh of five points; `arrays` by attribute name, `indices` among them."""
    arrays = {"POSITION": POINTS, **(arrays or {})}
    views, accessors, start, attributes = [], [], 0, {}
    for name, array in arrays.items():
        views.append({"buffer": 0, "byteOffset": start, "byteLength": array.nbytes})
        kind = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}[1 if array.ndim == 1 else array.shape[1]]
        component = {"f": 5126, "u": 5123}[array.dtype.kind]
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(array), "type": kind})
        start += array.nbytes
        if name == "indices":
            primitive = primitive | {"indices": len(views) - 1}
        else:
            attributes[name] = len(views) - 1
    node = {"mesh": 0, "translation": [0.0, 0.0, 9.0]} | ({"skin": 0} if skinned else {})
    content: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "nodes": [{"children": [1]}, {"translation": [1.0, 0.0, 0.0]}, node],
        "meshes": [{"primitives": [primitive | {"attributes": attributes}]}],
        "skins": [{"joints": [0, 1]}],
        "buffers": [{"byteLength": start}],
        "bufferViews": views,
        "accessors": accessors,
    }
    return parse_gltf(write_glb(content, b"".join(array.tobytes() for array in arrays.values())), "made.glb")


def read(gltf: Gltf) -> TriangleMesh:
    return triangle_mesh(gltf, read_nodes(gltf))


def slots(*rows: int) -> NDArray[np.uint16]:
    return np.tile(np.array(rows, "<u2"), (5, 1))


def weights(*rows: float) -> NDArray[np.float32]:
    return np.tile(np.array(rows, "<f4"), (5, 1))


@pytest.mark.parametrize(
    ("mode", "triangles"),
    [
        (4, [[0, 1, 2]]),
        (5, [[0, 1, 2], [1, 2, 3], [2, 3, 4]]),
        (6, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]),
        (0, []),
        (1, []),
    ],
)
def test_primitive_modes(mode: int, triangles: list[list[int]]) -> None:
    mesh = read(asset({"mode": mode}, skinned=False))
    assert mesh.triangles.tolist() == triangles
    assert not mesh.skinned.any()


def test_indices_choose_the_corners() -> None:
    mesh = read(asset({}, {"indices": np.array([4, 2, 0, 1, 1, 3, 0], "<u2")}, skinned=False))
    assert mesh.triangles.tolist() == [[4, 2, 0], [1, 1, 3]]  # what is left over makes no triangle
    np.testing.assert_array_equal(mesh.offsets[:, 0], POINTS)
    assert set(mesh.nodes.ravel()) == {2}


def test_weights_sum_to_one_and_the_greatest_comes_first() -> None:
    mesh = read(asset({}, {"JOINTS_0": slots(0, 1, 1, 1), "WEIGHTS_0": weights(0.5, 1.5, 0.0, 0.0)}))
    assert mesh.nodes.tolist() == [[1, 0]] * 5
    np.testing.assert_allclose(mesh.weights, [[0.75, 0.25]] * 5)
    np.testing.assert_array_equal(mesh.offsets[:, 1], POINTS)
    assert mesh.skinned.all()


def test_a_second_set_of_joints_counts() -> None:
    second: dict[str, NDArray[Any]] = {"JOINTS_1": slots(1, 0, 0, 0), "WEIGHTS_1": weights(0.6, 0.0, 0.0, 0.0)}
    mesh = read(asset({}, {"JOINTS_0": slots(0, 0, 0, 0), "WEIGHTS_0": weights(0.4, 0.0, 0.0, 0.0), **second}))
    assert mesh.nodes[0].tolist() == [1, 0]
    np.testing.assert_allclose(mesh.weights[0], [0.6, 0.4])


def test_a_vertex_without_weight_goes_with_its_first_joint() -> None:
    mesh = read(asset({}, {"JOINTS_0": slots(1, 0, 0, 0), "WEIGHTS_0": weights(0.0, 0.0, 0.0, 0.0)}))
    assert mesh.nodes[:, 0].tolist() == [1] * 5
    np.testing.assert_array_equal(mesh.weights[:, 0], 1.0)


@pytest.mark.parametrize(
    ("arrays", "word"),
    [
        ({"indices": np.array([0, 1, 5], "<u2")}, "vertex 5 of 5"),
        ({"JOINTS_0": slots(2, 0, 0, 0), "WEIGHTS_0": weights(1.0, 0.0, 0.0, 0.0)}, "joint 2 of 2"),
        ({"JOINTS_0": slots(0, 0, 0, 0)}, "WEIGHTS"),
        ({}, "JOINTS_n and WEIGHTS_n are needed"),
    ],
)
def test_damage_is_refused(arrays: dict[str, NDArray[Any]], word: str) -> None:
    with pytest.raises(InputError, match=word):
        read(asset({}, arrays))
