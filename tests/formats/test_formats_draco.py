"""Draco meshes: the same avatar with and without compression; damaged data is one line."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from avatar_builder import Recipe, build
from compressed_builder import draco_file
from compressed_vrm import with_draco, with_meshopt
from elbowroom.body.stock import stock_avatar_path
from elbowroom.errors import InputError
from elbowroom.formats.gltf import parse_gltf, read_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.triangles import triangle_mesh
from shared_data import SHARED, needs_shared


def test_a_draco_mesh_is_read_with_its_skin() -> None:
    data, points, _ = draco_file()
    gltf = parse_gltf(data, "d.glb")
    tree = read_nodes(gltf)
    mesh = triangle_mesh(gltf, tree)
    assert len(mesh.triangles) == len(points) // 3
    plain = parse_gltf(build(Recipe(points=20)), "p.glb")
    expected = triangle_mesh(plain, read_nodes(plain))
    found = triangle_mesh(gltf, tree)
    world = [
        np.einsum("pij,pj->pi", m[s.nodes[:, 0]][:, :3, :3], s.offsets[:, 0]) + m[s.nodes[:, 0]][:, :3, 3]
        for s, m in ((expected, tree.world_matrices(tree.rotations)), (found, tree.world_matrices(tree.rotations)))
    ]
    used = world[0][: len(points) // 3 * 3]
    distance = np.linalg.norm(used[:, None] - world[1][None], axis=2)
    nearest = distance.argmin(axis=1)
    assert distance.min(axis=1).max() < 1e-3
    assert np.array_equal(expected.nodes[: len(used), 0], found.nodes[nearest, 0])


@pytest.mark.parametrize("damage", [b"x", b"DRACO\x02\x02\x01\x01\x00\x00", bytes(300)])
def test_damaged_data_is_one_line(damage: bytes) -> None:
    gltf = parse_gltf(draco_file(damage)[0], "d.glb")
    with pytest.raises(InputError, match="damaged") as caught:
        triangle_mesh(gltf, read_nodes(gltf))
    assert "\n" not in str(caught.value)


@needs_shared
def test_a_real_draco_file_has_its_triangles() -> None:
    assert SHARED is not None
    gltf = read_gltf(SHARED / "scenes" / "chess-board.glb")
    assert len(triangle_mesh(gltf, read_nodes(gltf)).triangles) == 178_848


@pytest.mark.parametrize("compressed", [with_draco, with_meshopt])
def test_a_compressed_vrm_keeps_its_surface(compressed: Callable[[bytes], bytes]) -> None:
    data = stock_avatar_path().read_bytes()
    np.testing.assert_allclose(middles(compressed(data)), middles(data), atol=5e-5)


def middles(data: bytes) -> NDArray[np.float64]:
    """The middle of every triangle, (T, 3), in the terms of the nodes that carry it."""
    gltf = parse_gltf(data, "a.vrm")
    mesh = triangle_mesh(gltf, read_nodes(gltf))
    corners = mesh.offsets[mesh.triangles, 0]
    return np.asarray(corners.mean(axis=1))
