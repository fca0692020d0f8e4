"""Nodes that show a mesh many times over, and nodes that nobody sees: as if the file had told each by itself."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from elbowroom.errors import InputError
from elbowroom.formats.glb_draft import GlbDraft
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.hidden_nodes import hidden_nodes
from elbowroom.formats.instances import EXTENSION
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.packing import write_glb
from elbowroom.formats.triangles import MeshBounds, triangle_mesh, triangle_parts
from elbowroom.geometry import quaternion
from place_builder import TRIANGLES

CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
Floats = np.ndarray[Any, np.dtype[np.float64]]


def crate(draft: GlbDraft) -> int:
    primitive = {"attributes": {"POSITION": draft.add_vertices(CORNERS, bounds=True)}}
    return draft.add("meshes", {"primitives": [primitive | {"indices": draft.add_indices(TRIANGLES)}]})


def triangles(data: bytes) -> Floats:
    """The corners (T, 3, 3) of all that is shown, in the world."""
    gltf = parse_gltf(data, "made.glb")
    tree = read_nodes(gltf)
    mesh = triangle_mesh(gltf, tree)
    matrices = tree.world_matrices(tree.rotations)[mesh.nodes[:, 0]]
    points = np.einsum("vij,vj->vi", matrices[:, :3, :3], mesh.offsets[:, 0]) + matrices[:, :3, 3]
    return np.asarray(points[mesh.triangles])


def instanced(many: dict[str, Floats]) -> bytes:
    """Crates below a node that is turned and moved, told as instances."""
    draft = GlbDraft()
    attributes = {name: draft.add_vertices(values) for name, values in many.items()}
    above = draft.add_node("above", translation=(1.0, 0.5, 0.0), rotation=(0.0, 0.6, 0.0, 0.8), scale=(1.0, 2.0, 1.0))
    draft.add_node("crates", above, mesh=crate(draft), extensions={EXTENSION: {"attributes": attributes}})
    return draft.finish()


@pytest.mark.parametrize("told", [("TRANSLATION",), ("ROTATION", "SCALE"), ("TRANSLATION", "ROTATION", "SCALE")])
def test_instances_are_where_nodes_of_their_own_would_be(told: tuple[str, ...]) -> None:
    rng = np.random.default_rng(3)
    every = {
        "TRANSLATION": rng.uniform(-5.0, 5.0, (6, 3)),
        "ROTATION": quaternion.normalize(rng.normal(size=(6, 4))),
        "SCALE": rng.uniform(0.3, 2.0, (6, 3)),
    }
    draft = GlbDraft()
    above = draft.add_node("above", translation=(1.0, 0.5, 0.0), rotation=(0.0, 0.6, 0.0, 0.8), scale=(1.0, 2.0, 1.0))
    mesh = crate(draft)
    for i in range(6):
        draft.add_node(f"crate {i}", above, mesh=mesh, **{name.lower(): every[name][i] for name in told})
    found = triangles(instanced({name: every[name] for name in told}))
    np.testing.assert_allclose(found, triangles(draft.finish()), atol=1e-5)


def test_all_instances_count_for_the_bounds() -> None:
    gltf = parse_gltf(instanced({"TRANSLATION": np.zeros((50, 3))}), "made.glb")
    tree = read_nodes(gltf)
    assert sum(len(part.triangles) for _, part in triangle_parts(gltf, tree)) == 600
    with pytest.raises(InputError, match="599 triangles"):
        list(triangle_parts(gltf, tree, MeshBounds(triangles=599)))


@pytest.mark.parametrize(
    ("many", "said"),
    [
        ({"TRANSLATION": np.zeros((2, 3)), "SCALE": np.ones((3, 3))}, "2 and 3 elements"),
        ({"ROTATION": np.zeros((2, 4))}, "unit quaternions"),
        ({"TRANSLATION": np.zeros((2, 4))}, "'VEC3'"),
        ({"TRANSLATION": np.full((2, 3), np.inf)}, "not finite"),
    ],
)
def test_wrong_instances_are_told(many: dict[str, Floats], said: str) -> None:
    with pytest.raises(InputError, match=said):
        triangles(instanced(many))


def hidden(change: Callable[[dict[str, Any]], object]) -> set[str]:
    """The names of hidden nodes in a file of four crates, one of them below another, after a change of its JSON."""
    draft = GlbDraft()
    mesh = crate(draft)
    first = draft.add_node("a", mesh=mesh)
    draft.add_node("b", first, mesh=mesh)
    draft.add_node("c", mesh=mesh)
    draft.add_node("d", mesh=mesh)
    gltf = parse_gltf(draft.finish(), "made.glb")
    content = dict(gltf.root.value)
    change(content)
    gltf = parse_gltf(write_glb(content, bytes(gltf.buffers[0] or b"")), "made.glb")
    tree = read_nodes(gltf)
    return {tree.names[node] for node in hidden_nodes(gltf, tree)}


def off(node: dict[str, Any]) -> None:
    node["extensions"] = {"KHR_node_visibility": {"visible": False}}


def test_nodes_of_other_scenes_are_hidden_and_what_hangs_on_them() -> None:
    assert hidden(lambda content: None) == set()
    assert hidden(lambda content: content.update(scenes=[{"nodes": [2, 3]}], scene=0)) == {"a", "b"}
    assert hidden(lambda content: content.update(scenes=[{"nodes": [2]}, {"nodes": [0]}], scene=1)) == {"c", "d"}
    assert hidden(lambda content: content.update(scenes=[{"nodes": [2]}, {"nodes": [0]}])) == {"a", "b", "d"}


def test_so_are_nodes_that_are_switched_off() -> None:
    assert hidden(lambda content: off(content["nodes"][0])) == {"a", "b"}
    assert hidden(lambda content: off(content["nodes"][1])) == {"b"}


def test_a_file_that_would_show_nothing_shows_all() -> None:
    assert hidden(lambda content: content.update(scenes=[{}], scene=0)) == set()
    assert hidden(lambda content: content.pop("scenes")) == set()
    assert hidden(lambda content: list(map(off, content["nodes"]))) == set()


def test_a_scene_that_is_none_is_told() -> None:
    with pytest.raises(InputError, match="scene"):
        hidden(lambda content: content.update(scene=7))
