"""The faces of a file that is a text, with a line for each element."""

from functools import partial

import numpy as np

from elbowroom.formats.models.ply.faces import Faces, Ints
from elbowroom.formats.models.ply.header import Header


def text_faces(data: bytes, header: Header) -> Faces:
    """Read them; raises ValueError where a line is not what it should be, IndexError where there are too few."""
    lines = data[len(header.text) :].splitlines(keepends=True)
    points, passed = np.zeros((0, 3)), 0
    for element in header.before:
        if element.name == "vertex":
            axes = [element.at(axis) for axis in "xyz"]
            words = [line.split() for line in lines[passed : passed + element.count]]
            points = np.array([[float(each[axis]) for axis in axes] for each in words]).reshape(-1, 3)
        passed += element.count
    faces = [lines[passed + number].split() for number in range(header.faces.count)]
    (corners,) = header.faces.lists
    first = header.faces.at(corners.name)
    sizes = [int(face[first]) for face in faces]
    if any(len(face) != len(header.faces.properties) + size for face, size in zip(faces, sizes, strict=True)):
        raise ValueError("not a line for each face")
    own = [int(word) for face, size in zip(faces, sizes, strict=True) for word in face[first + 1 : first + 1 + size]]
    begin = len(header.text) + sum(map(len, lines[:passed]))
    end = begin + sum(map(len, lines[passed : passed + len(faces)]))
    written = partial(_written, faces, first, sizes)
    return Faces(points, np.array(own, np.int64), np.array(sizes, np.int64), (begin, end), written)


def _written(faces: list[list[bytes]], first: int, sizes: list[int], triangles: Ints, owners: Ints) -> bytes:
    lines = list[bytes]()
    for triangle, owner in zip(triangles.tolist(), owners.tolist(), strict=True):
        face, three = faces[owner], [b"3", *(b"%d" % corner for corner in triangle)]
        lines.append(b" ".join([*face[:first], *three, *face[first + 1 + sizes[owner] :]]) + b"\n")
    return b"".join(lines)
