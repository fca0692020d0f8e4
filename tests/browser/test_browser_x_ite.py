"""H-Anim and X3D as X_ITE reads them: the same joints in the same places, the same triangles."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.formats.hanim.figure import HanimFigure, parse_figure
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.x3d.files import parse_x3d
from elbowroom.formats.x3d.model import Notes
from elbowroom.formats.x3d.shapes import triangles_of
from elbowroom.geometry import quaternion
from hanim_builder import HanimRecipe, build_hanim
from shared_data import SHARED
from x_ite import XIte

Floats = NDArray[np.float64]

REAL = sorted(SHARED.glob("avatars/hanim_*/*")) if SHARED else []
MADE = [
    HanimRecipe("xml", scale=0.0254, bent=0.7),
    HanimRecipe("classic", z_up=True, bent=0.3, prefix="Joe_", named=False),
    HanimRecipe("vrml", "1.1"),
]


# What moves joints by itself, or waits for files that are not there; our reader leaves it out too.
_RESTLESS = re.compile(
    r"<ROUTE[^>]*>|<Script.*?</Script>|<ExternProtoDeclare.*?</ExternProtoDeclare>|<ProtoInstance[^>]*/>", re.DOTALL
)


@pytest.fixture(scope="module")
def x_ite(chromium: Any) -> Iterator[XIte]:
    judge = XIte(chromium)
    yield judge
    judge.close()


def compare(x_ite: XIte, data: bytes, file: str) -> None:
    """Joint positions as the file has them, and with every joint turned at random."""
    figure = parse_figure(data, file, default_pose=False)
    text = _RESTLESS.sub("", data.decode())
    rng = np.random.default_rng(3)
    axes = rng.normal(size=(len(figure.joints), 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    angles = rng.uniform(-1.0, 1.0, len(figure.joints))
    for turned in (False, True):
        turns = np.column_stack([axes, angles]).tolist() if turned else []
        found = x_ite.joints(text, turns)
        assert [joint["name"] for joint in found] == [joint.definition for joint in figure.joints]
        ours = positions(figure, quaternion.from_rotation_vector(axes * angles[:, None]) if turned else None)
        theirs = np.array([joint["position"] for joint in found])
        assert np.abs(ours - theirs).max() < 1e-6 * max(1.0, float(np.abs(theirs).max()))


def positions(figure: HanimFigure, rotations: Floats | None) -> Floats:
    """World positions (J, 3) of a figure's joints, with these rotations of theirs or those of the file."""
    tree = read_nodes(figure.gltf())
    nodes = [joint.node for joint in figure.joints]
    local = tree.rotations.copy()
    if rotations is not None:
        local[nodes] = rotations
    return tree.world_matrices(local)[nodes, :3, 3]


@pytest.mark.parametrize(
    "path",
    [*REAL[::2], *(pytest.param(path, marks=pytest.mark.long) for path in REAL[1::2])],
    ids=lambda path: path.name,
)
def test_joints_of_real_files(x_ite: XIte, path: Path) -> None:
    compare(x_ite, path.read_bytes(), path.name)


@pytest.mark.parametrize("recipe", MADE, ids=lambda recipe: recipe.encoding)
def test_joints_of_made_files(x_ite: XIte, recipe: HanimRecipe) -> None:
    compare(x_ite, build_hanim(recipe), "made.wrl")


STAR = [[np.cos(a) * r, np.sin(a) * r, 0.0] for a, r in zip(np.arange(10) * np.pi / 5, [1.0, 0.4] * 5, strict=True)]
# Steps of equal length: X_ITE takes the bisector of the two edges at a point for its tangent, the standard their sum.
BENT = [[0, 0, 0], [0, 1, 0], [0.6, 1.8, 0], [1.6, 1.8, 0], [1.6, 2.4, -0.8]]
LOOP = np.round([[np.cos(a), 0.0, np.sin(a)] for a in np.arange(13) * np.pi / 6], 9)
SQUARE = [[0.2, 0.2], [0.2, -0.2], [-0.2, -0.2], [-0.2, 0.2], [0.2, 0.2]]
EDGES = [[0.3, 0.0], [0.1, -0.25], [-0.2, -0.1], [0.05, 0.2], [0.3, 0.0]]


def numbers(values: Any) -> str:
    return "[ " + " ".join(f"{number:.9g}" for number in np.asarray(values, float).reshape(-1)) + " ]"


GEOMETRIES = {
    "box": "Box { size 1 2 3 }",
    "concave": f"IndexedFaceSet {{ convex FALSE coord Coordinate {{ point {numbers(STAR)} }}"
    f" coordIndex {numbers([*range(10), -1])} }}",
    "clockwise": "IndexedFaceSet { ccw FALSE coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] }"
    " coordIndex [ 0 1 2 3 -1 ] }",
    "extrusion": f"Extrusion {{ crossSection {numbers(SQUARE)} spine {numbers(BENT)} }}",
    "turned": f"Extrusion {{ crossSection {numbers(EDGES)} spine {numbers(BENT)} convex FALSE"
    " scale [ 1 1, 0.5 2, 2 1, 1 1, 0.3 0.3 ] orientation [ 0 1 0 0, 0 1 0 0.4, 1 0 0 0.3, 0 0 1 0.2, 0 1 0 1 ] }",
    "straight": f"Extrusion {{ crossSection {numbers(EDGES)} spine [ 0 0 0, 1 1 1, 2 2 2 ] }}",
    "ring": f"Extrusion {{ crossSection {numbers(EDGES)} spine {numbers(LOOP)} beginCap FALSE endCap FALSE }}",
    "ground": "ElevationGrid { xDimension 3 zDimension 4 xSpacing 2 zSpacing 0.5 height [ 0 1 0 2 1 3 0 1 1 2 0 1 ] }",
}


def test_triangles(x_ite: XIte) -> None:
    text = "#X3D V3.3 utf8\nPROFILE Full\n" + "".join(f"Shape {{ geometry {g} }}\n" for g in GEOMETRIES.values())
    shapes = parse_x3d(text.encode(), "shapes.x3dv", Notes()).roots
    for name, shape, theirs in zip(GEOMETRIES, shapes, x_ite.triangles(text), strict=True):
        geometry = shape.node("geometry")
        mesh = triangles_of(geometry) if geometry else None
        assert mesh is not None
        ours = mesh.points[mesh.triangles]
        other = np.array(theirs).reshape(-1, 3, 4)[:, :: -1 if name == "clockwise" else 1, :3]  # it turns them later
        assert np.allclose(ours.min(axis=(0, 1)), other.min(axis=(0, 1)), atol=1e-5), name
        assert np.allclose(ours.max(axis=(0, 1)), other.max(axis=(0, 1)), atol=1e-5), name
        for mine, yours in zip(measures(ours), measures(other), strict=True):
            assert np.allclose(mine, yours, atol=1e-4), name


def measures(triangles: Floats) -> tuple[Floats, Floats]:
    """Area vector sums that do not depend on how faces are cut: the whole area, and volume with first moments."""
    a, b, c = triangles.transpose(1, 0, 2)
    cross = np.cross(b - a, c - a)
    volumes = np.einsum("ti,ti->t", a, np.cross(b, c)) / 6.0
    moments = ((a + b + c) / 4.0 * volumes[:, None]).sum(axis=0)
    return np.append(cross.sum(axis=0) / 2.0, np.linalg.norm(cross, axis=1).sum() / 2.0), np.append(
        moments, volumes.sum()
    )
