"""X3D and VRML97 as Castle Game Engine reads them: what `tovrmlx3d` writes again is the same figure."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.formats.hanim.figure import HanimFigure, read_figure
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.triangles import triangle_mesh
from hanim_builder import HanimRecipe, build_hanim
from shared_data import SHARED

Floats = NDArray[np.float64]

REAL = sorted(SHARED.glob("avatars/hanim_*/*")) if SHARED else []
MADE = {
    "xml": ("a.x3d", HanimRecipe("xml", scale=0.0254, bent=0.7)),
    "classic": ("a.x3dv", HanimRecipe("classic", skinned=True, prefix="Joe_", named=False, displaced=True)),
    "vrml97": ("a.wrl", HanimRecipe("vrml", "1.1", z_up=True)),
}
ENCODINGS = {"xml": "x3d", "classic": "x3dv"}
SINGLE = 1e-6  # metres for each metre: they compute in single precision

pytestmark = pytest.mark.skipif(
    shutil.which("tovrmlx3d") is None, reason="no tovrmlx3d: it comes with `apt-get install view3dscene`"
)


def converted(file: Path, folder: Path, encoding: str) -> Path:
    """The file as the other program writes it."""
    target = folder / f"converted.{ENCODINGS[encoding]}"
    command = ["tovrmlx3d", file.name, f"--encoding={encoding}", "--force-x3d"]
    target.write_bytes(subprocess.run(command, cwd=file.parent, check=True, capture_output=True, timeout=60).stdout)
    return target


def look(file: Path) -> tuple[HanimFigure, Floats, Floats]:
    """A figure as its file poses it, the places of its joints (J, 3) and of its triangles' corners (T, 3, 3)."""
    figure = read_figure(file, default_pose=False)
    gltf = figure.gltf()
    tree = read_nodes(gltf)
    world, mesh = tree.world_matrices(tree.rotations), triangle_mesh(gltf, tree)
    carried = world[mesh.nodes]
    places = np.einsum("vkij,vkj->vki", carried[..., :3, :3], mesh.offsets) + carried[..., :3, 3]
    points: Floats = np.einsum("vk,vki->vi", mesh.weights, places)
    return figure, world[[joint.node for joint in figure.joints], :3, 3], points[mesh.triangles]


def compare(file: Path, folder: Path, encoding: str) -> None:
    ours, joints, triangles = look(file)
    theirs, their_joints, their_triangles = look(converted(file, folder, encoding))
    assert [(j.definition, j.name) for j in theirs.joints] == [(j.definition, j.name) for j in ours.joints]
    assert theirs.version == ours.version
    near = SINGLE * max(1.0, float(np.abs(joints).max()))
    np.testing.assert_allclose(their_joints, joints, atol=near)
    np.testing.assert_allclose(their_triangles, triangles, atol=near)


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("path", REAL, ids=lambda path: path.name)
def test_real_files(path: Path, encoding: str, tmp_path: Path) -> None:
    file = tmp_path / path.name
    file.write_bytes(path.read_bytes())
    compare(file, tmp_path, encoding)


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("made", MADE)
def test_made_files(made: str, encoding: str, tmp_path: Path) -> None:
    name, recipe = MADE[made]
    file = tmp_path / name
    file.write_bytes(build_hanim(recipe))
    compare(file, tmp_path, encoding)
