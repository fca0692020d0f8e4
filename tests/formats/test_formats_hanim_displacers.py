"""Displacers: morph targets in the glTF, and the surface that is read is the one that they make."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.gltf import Gltf, parse_gltf
from elbowroom.formats.hanim.figure import parse_figure
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.packing import write_glb
from elbowroom.formats.triangles import triangle_mesh

Floats = NDArray[np.float64]

SQUARE = "0 0 0, 1 0 0, 1 1 0, 0 1 0"
PLAIN = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)


def displacer(weight: float, index: str = "2 3", moves: str = "0 0 2, 0 0 4") -> str:
    return f'HAnimDisplacer {{ name "smile" weight {weight} coordIndex [ {index} ] displacements [ {moves} ] }}'


def shape(coordinate: str) -> str:
    return f"Shape {{ geometry IndexedFaceSet {{ coordIndex [ 0 1 2 3 -1 ] coord {coordinate} }} }}"


def in_a_segment(displacers: str) -> Gltf:
    segment = (
        f"HAnimSegment {{ coord DEF Points Coordinate {{ point [ {SQUARE} ] }} displacers [ {displacers} ] "
        f"children [ {shape('USE Points')} ] }}"
    )
    return read(f'HAnimHumanoid {{ skeleton HAnimJoint {{ name "humanoid_root" children [ {segment} ] }} }}')


def in_a_skin(displacers: str) -> Gltf:
    joint = f'HAnimJoint {{ name "humanoid_root" skinCoordIndex [ 0 1 2 3 ] displacers [ {displacers} ] }}'
    coordinate = f"DEF Points Coordinate {{ point [ {SQUARE} ] }}"
    return read(f"HAnimHumanoid {{ skeleton {joint} skinCoord {coordinate} skin [ {shape('USE Points')} ] }}")


def read(text: str) -> Gltf:
    return parse_figure(f"#X3D V4.0 utf8\nPROFILE Full\n{text}\n".encode(), "made.x3dv").gltf()


def corners(gltf: Gltf) -> Floats:
    """The places of the square's corners, in the order of `SQUARE`."""
    points = triangle_mesh(gltf, read_nodes(gltf)).offsets[:, 0]
    distances = np.linalg.norm(points[None, :, :2] - PLAIN[:, None, :2], axis=2)
    found: Floats = points[distances.argmin(axis=1)]
    return found


@pytest.mark.parametrize("made", [in_a_segment, in_a_skin])
def test_a_displacer_is_a_morph_target_with_its_weight(made: Callable[[str], Gltf]) -> None:
    gltf = made(displacer(0.5))
    (mesh,) = gltf.root.value["meshes"]
    assert mesh["weights"] == [0.5]
    assert mesh["extras"]["targetNames"] == ["smile"]
    assert len(mesh["primitives"][0]["targets"]) == 1
    np.testing.assert_allclose(corners(gltf)[:, 2], [0, 0, 1, 2], atol=1e-6)


@pytest.mark.parametrize("made", [in_a_segment, in_a_skin])
def test_without_weight_nothing_moves(made: Callable[[str], Gltf]) -> None:
    gltf = made(displacer(0.0))
    assert gltf.root.value["meshes"][0]["weights"] == [0.0]
    np.testing.assert_allclose(corners(gltf), PLAIN, atol=1e-6)


def test_several_add_up_and_those_that_move_nothing_are_left_out() -> None:
    gltf = in_a_segment(displacer(1.0, "1", "0 0 3") + displacer(0.5, "1", "0 0 2") + displacer(1.0, "", ""))
    assert gltf.root.value["meshes"][0]["weights"] == [1.0, 0.5]
    assert corners(gltf)[1, 2] == pytest.approx(4.0)


@pytest.mark.parametrize("index", ["4", "-1"])
def test_a_point_that_is_not_there_is_told(index: str) -> None:
    with pytest.raises(InputError, match=r"coordIndex points to number .* of 4"):
        in_a_segment(displacer(1.0, index, "0 0 1"))


def test_weights_of_a_node_go_before_those_of_its_mesh_and_damaged_targets_are_told() -> None:
    content = dict(in_a_segment(displacer(0.5)).root.value)
    gltf = in_a_segment(displacer(0.5))
    shown = next(node for node in content["nodes"] if "mesh" in node)
    shown["weights"] = [2.0]
    assert corners(changed(gltf, content))[3, 2] == pytest.approx(8.0)
    shown["weights"] = [None]
    with pytest.raises(InputError, match="weights"):
        corners(changed(gltf, content))
    shown["weights"] = [1.0]
    target = content["meshes"][0]["primitives"][0]["targets"][0]["POSITION"]
    content["accessors"][target]["count"] -= 1
    with pytest.raises(InputError, match="vertices"):
        corners(changed(gltf, content))


def changed(gltf: Gltf, content: dict[str, object]) -> Gltf:
    assert gltf.buffers[0] is not None
    return parse_gltf(write_glb(content, bytes(gltf.buffers[0])), "changed.glb")
