"""Faces of PLY files: of any number of corners, with dents, in texts and in both orders of bytes."""

import struct
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.models.model import parse_model
from elbowroom.formats.models.ply.polygons import in_triangles
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.triangles import triangle_mesh

Face = tuple[int, ...]

# A U, begun in its dent: a fan from there leads out of it.
U = [(1, 1), (1, 3), (0, 3), (0, 0), (3, 0), (3, 3), (2, 3), (2, 1)]
PLACES = [(float(x), 0.5, float(z)) for x, z in U]
DENTED: list[Face] = [(0, 1, 2, 3, 4, 5, 6, 7)]
MIXED: list[Face] = [*DENTED, (2, 1, 6), (1, 2, 5, 6), (0, 7, 6, 1)]
FORMATS = ("ascii", "binary_little_endian", "binary_big_endian")


def ply(form: str, faces: list[Face], *, rich: bool = False, size: str = "uchar", corner: str = "int") -> bytes:
    """A file; a `rich` one has colours of vertices, something ahead of and behind the corners of a face, and edges."""
    extra = ["property uchar red", "property ushort flags"] if rich else []
    lines = [f"element vertex {len(PLACES)}", *(f"property float {axis}" for axis in "xyz"), *extra[:1]]
    lines += [f"element face {len(faces)}", *extra[1:], f"property list {size} {corner} vertex_indices"]
    edges = ["element edge 1", "property int vertex1", "property int vertex2"]
    lines += ["property float quality", *edges] if rich else []
    header = "\n".join(["ply", f"format {form} 1.0", "comment made by hand", *lines, "end_header"]) + "\n"
    colour, flags, quality = ([200] if rich else []), ([7] if rich else []), ([0.25] if rich else [])
    rows: list[list[Any]] = [[*place, *colour] for place in PLACES]
    rows += [[*flags, len(face), *face, *quality] for face in faces]
    rows += [[3, 4]] if rich else []
    if form == "ascii":
        return (header + "".join(" ".join(map(str, row)) + "\n" for row in rows)).encode()
    order, letters = ("<" if "little" in form else ">"), {"uchar": "B", "int": "i", "ushort": "H"}
    place, own = "fff" + "B" * rich, "H" * rich + letters[size]
    kinds = [place] * len(PLACES) + [f"{own}{len(face)}{letters[corner]}" + "f" * rich for face in faces]
    kinds += ["ii"] * rich
    return header.encode() + b"".join(struct.pack(order + kind, *row) for kind, row in zip(kinds, rows, strict=True))


def triangles(data: bytes) -> NDArray[np.float64]:
    """The corners (T, 3, 3) of what such a file shows."""
    gltf = parse_model(data, "made.ply").gltf
    mesh = triangle_mesh(gltf, read_nodes(gltf))
    corners: NDArray[np.float64] = mesh.offsets[:, 0][mesh.triangles]
    return corners


def area(corners: NDArray[np.float64]) -> float:
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return 0.5 * float(np.linalg.norm(normals, axis=1).sum())


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("rich", [False, True])
def test_a_dent_stays_open(form: str, rich: bool) -> None:
    found = triangles(ply(form, DENTED, rich=rich))
    assert len(found) == 6
    assert area(found) == pytest.approx(7.0)


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("size", ["uchar", "int"])
@pytest.mark.parametrize("corner", ["int", "ushort"])
def test_faces_of_different_sizes_are_read_in_any_order_of_bytes(form: str, size: str, corner: str) -> None:
    found = triangles(ply(form, MIXED, rich=True, size=size, corner=corner))
    assert len(found) == 6 + 1 + 2 + 2
    assert area(found) == pytest.approx(sum(map(face_area, MIXED)))


def face_area(face: Face) -> float:
    """By the shoelace formula."""
    x, z = np.array([U[corner] for corner in face], float).T
    return 0.5 * abs(float(np.dot(x, np.roll(z, -1)) - np.dot(z, np.roll(x, -1))))


@pytest.mark.parametrize("form", FORMATS)
def test_all_else_stays_as_it_was(form: str) -> None:
    cut = in_triangles(ply(form, MIXED, rich=True))
    as_triangles: list[Face] = [(0, 1, 2)] * 11
    expected = ply(form, as_triangles, rich=True)
    assert len(cut) == len(expected)
    assert cut.split(b"end_header\n")[0] == expected.split(b"end_header\n")[0]
    if form == "ascii":
        lines = cut.splitlines()
        assert all(line.startswith(b"7 3 ") and line.endswith(b" 0.25") for line in lines[-12:-1])
        assert lines[-1] == b"3 4"
    else:
        assert cut[-8:] == expected[-8:]
        assert cut.count(struct.pack("<f" if "little" in form else ">f", 0.25)) == 11


@pytest.mark.parametrize("form", FORMATS)
def test_triangles_alone_are_left_as_they_are(form: str) -> None:
    given = ply(form, [(0, 1, 2), (3, 4, 5)])
    assert in_triangles(given) is given


@pytest.mark.parametrize(
    "damage",
    [
        (b"element face 4", b"element face 999999999999"),
        (b"element face 4", b"element face -4"),
        (b"element face 4", b"element face 5"),
        (b"list uchar int", b"list float int"),
        (b"list uchar int", b"list char int"),
        (b"vertex_indices", b"texcoord"),
        (b"property float x", b"property list uchar int x"),
        (b"property float x", b"property quaternion x"),
        (b"format", b"formed"),
    ],
)
@pytest.mark.parametrize("form", FORMATS)
def test_what_is_not_understood_is_left_to_the_library(form: str, damage: tuple[bytes, bytes]) -> None:
    given = ply(form, MIXED).replace(*damage, 1)
    cut = in_triangles(given)
    assert cut is given or damage[1] == b"list char int"


@pytest.mark.parametrize("form", FORMATS)
def test_a_file_that_is_cut_off_anywhere_ends_in_one_line(form: str) -> None:
    whole = ply(form, MIXED, rich=True)
    for length in range(0, len(whole) - 9, 7):
        said = ""
        try:
            parse_model(whole[:length], "cut.ply")
        except InputError as error:
            said = str(error)
        assert "\n" not in said


def test_a_corner_that_is_none_is_no_face_of_ours() -> None:
    given = ply("binary_little_endian", [*DENTED, (0, 1, 2, 99)])
    assert in_triangles(given) is given
