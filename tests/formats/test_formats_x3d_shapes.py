"""Shapes as triangles: areas, volumes and normals that geometry gives."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.hanim.skin import skin_weights
from elbowroom.formats.x3d.expand import expand
from elbowroom.formats.x3d.files import FilesBeside, parse_x3d
from elbowroom.formats.x3d.mesh import Mesh
from elbowroom.formats.x3d.model import Node, Notes
from elbowroom.formats.x3d.pictures import mime_of, pixel_texture
from elbowroom.formats.x3d.shapes import triangles_of

Floats = NDArray[np.float64]


def node_of(text: str) -> Node:
    notes = Notes()
    return expand(parse_x3d(f"#X3D V3.3 utf8\n{text}".encode(), "a.x3dv", notes), FilesBeside(None, notes))[0]


def mesh_of(text: str) -> Mesh:
    mesh = triangles_of(node_of(text))
    assert mesh is not None
    return mesh


def volume(mesh: Mesh) -> float:
    a, b, c = mesh.points[mesh.triangles].transpose(1, 0, 2)
    return float(np.einsum("ti,ti->", a, np.cross(b, c)) / 6.0)


def area(mesh: Mesh) -> float:
    a, b, c = mesh.points[mesh.triangles].transpose(1, 0, 2)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Box { size 1 2 3 }", 6.0),
        ("Sphere { radius 2 }", 4.0 / 3.0 * np.pi * 8.0),
        ("Cylinder { radius 0.5 height 3 }", np.pi * 0.25 * 3.0),
        ("Cone { bottomRadius 0.5 height 3 }", np.pi * 0.25),
        ("Extrusion { crossSection [ 0.5 0.5 0.5 -0.5 -0.5 -0.5 -0.5 0.5 0.5 0.5 ] spine [ 0 0 0 0 0 4 ] }", 4.0),
    ],
)
def test_solids_hold_their_volume_and_face_outwards(text: str, expected: float) -> None:
    mesh = mesh_of(text)
    assert volume(mesh) == pytest.approx(expected, rel=0.05)
    if mesh.normals is not None:
        corner = mesh.points[mesh.triangles]
        facing = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        assert (np.einsum("ti,ti->t", facing, mesh.normals[mesh.triangles].mean(axis=1)) > 0.0).all()


def test_a_cylinder_without_lids_is_open() -> None:
    assert area(mesh_of("Cylinder { radius 1 height 2 top FALSE bottom FALSE }")) == pytest.approx(
        4.0 * np.pi, rel=0.02
    )


@pytest.mark.parametrize("seed", range(12))
def test_dented_polygons_keep_their_area(seed: int) -> None:
    """Star-shaped polygons in random planes, against the shoelace formula."""
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, 14))
    radii = rng.uniform(0.2, 1.0, 14)
    flat = np.column_stack([radii * np.cos(angles), radii * np.sin(angles)])
    x, y = flat.T
    expected = 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    points = flat @ axes[:2] + rng.normal(size=3)
    numbers = " ".join(f"{number:.9f}" for number in points.reshape(-1))
    text = "IndexedFaceSet {{ convex FALSE coord Coordinate {{ point [ {} ] }} coordIndex [ {} -1 ] }}"
    mesh = mesh_of(text.format(numbers, " ".join(map(str, range(14)))))
    assert len(mesh.triangles) == 12
    assert area(mesh) == pytest.approx(abs(expected), rel=1e-6)


SQUARE = "coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] }"


@pytest.mark.parametrize(
    "text",
    [
        f"IndexedFaceSet {{ {SQUARE} coordIndex [ 0 1 2 3 ] }}",
        f"IndexedTriangleSet {{ {SQUARE} index [ 0 1 2 0 2 3 ] }}",
        f"IndexedTriangleFanSet {{ {SQUARE} index [ 0 1 2 3 -1 ] }}",
        f"IndexedTriangleStripSet {{ {SQUARE} index [ 0 1 3 2 -1 ] }}",
        f"TriangleFanSet {{ {SQUARE} fanCount [ 4 ] }}",
        "TriangleStripSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0, 1 1 0 ] } stripCount [ 4 ] }",
        f"QuadSet {{ {SQUARE} }}",
        f"IndexedQuadSet {{ {SQUARE} index [ 0 1 2 3 ] }}",
    ],
)
def test_every_way_to_write_a_square(text: str) -> None:
    corner = (mesh := mesh_of(text)).points[mesh.triangles]
    normals = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    assert len(corner) == 2
    assert np.allclose(normals, [0.0, 0.0, 1.0])


def test_colours_of_corners_and_of_faces() -> None:
    colours = "color Color { color [ 1 0 0, 0 1 0 ] }"
    faces = f"IndexedFaceSet {{ {SQUARE} coordIndex [ 0 1 2 -1 0 2 3 -1 ] {colours}"
    by_face = mesh_of(f"{faces} colorPerVertex FALSE }}")
    assert by_face.colours is not None
    assert (by_face.colours[by_face.triangles[0], 0] == 1.0).all()
    assert (by_face.colours[by_face.triangles[1], 1] == 1.0).all()
    by_corner = mesh_of(f"{faces} colorIndex [ 0 0 1 -1 0 1 1 -1 ] }}")
    assert by_corner.colours is not None
    assert by_corner.colours[by_corner.triangles[0]][:, 0].tolist() == [1.0, 1.0, 0.0]


def test_creases() -> None:
    """Two squares at a right angle: smooth above 90 degrees, an edge below."""
    roof = (
        "IndexedFaceSet {{ coord Coordinate {{ point [ 0 0 0, 1 0 0, 1 0 1, 0 0 1, 0 1 0, 1 1 0 ] }}"
        " coordIndex [ 0 3 2 1 -1 0 1 5 4 -1 ] creaseAngle {} }}"
    )
    sharp, smooth = mesh_of(roof.format(1.5)), mesh_of(roof.format(1.6))
    assert sharp.normals is not None
    assert smooth.normals is not None
    assert len(sharp.points) == 8
    assert len(smooth.points) == 6
    assert np.allclose(smooth.normals[np.isin(smooth.sources, [0, 1])], [0.0, np.sqrt(0.5), np.sqrt(0.5)], atol=1e-3)


def test_a_wrong_index_is_told() -> None:
    with pytest.raises(InputError, match=r"line 2: IndexedFaceSet\.coordIndex points to number 4 of 4"):
        mesh_of(f"IndexedFaceSet {{ {SQUARE} coordIndex [ 0 1 4 ] }}")


def test_pixel_textures_become_png() -> None:
    png = pixel_texture(node_of("PixelTexture { image 2 1 3 0xFF0000 0x00FF00 }"))
    assert png is not None
    assert mime_of(png) == "image/png"
    assert pixel_texture(node_of("PixelTexture { image 0 0 0 }")) is None


def test_skin_weights_against_a_plain_loop() -> None:
    rng = np.random.default_rng(0)
    joints, given = [], []
    for _ in range(8):
        index = rng.choice(40, 25, replace=False)
        weight = rng.uniform(0.01, 1.0, 20)
        numbers = " ".join(map(repr, map(float, weight)))
        joints.append(
            node_of(f"HAnimJoint {{ skinCoordIndex [ {' '.join(map(str, index))} ] skinCoordWeight [ {numbers} ] }}")
        )
        given.append({int(i): float(w) for i, w in zip(index, [*weight, *[1.0] * 5], strict=True)})
    found = skin_weights(joints, 45)
    for point in range(45):
        ranked = sorted(((w[point], j) for j, w in enumerate(given) if point in w), key=lambda pair: -pair[0])[:4]
        total = sum(weight for weight, _ in ranked)
        expected = {j: weight / total for weight, j in ranked} or {0: 1.0}
        mine = {int(j): w for j, w in zip(found.joints[point], found.weights[point], strict=True) if w > 0.0}
        assert mine == pytest.approx(expected)
