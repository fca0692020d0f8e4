"""The parts of large meshes, kept on disk: cutting them takes a while, and a place is opened more than once."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from elbowroom.kept_arrays import Arrays, kept
from elbowroom.world.obstacles.meshes.parts import ObstacleParts, parts_of
from elbowroom.world.obstacles.shapes import Box, Mesh, Shape

Floats = NDArray[np.float64]

_MANY = 2000  # triangles: fewer are cut at once
_PIECE, _BOX, _ITSELF = 0, 1, 2  # what a part is: of a mesh, in it, or the obstacle itself


def kept_parts(shapes: Sequence[Shape], centers: Floats, rotations: Floats, ground: float) -> ObstacleParts:
    """The same as `parts_of`."""
    meshes = [shape for shape in shapes if isinstance(shape, Mesh)]
    if sum(len(mesh.faces) for mesh in meshes) < _MANY:
        return parts_of(shapes, centers, rotations, ground)
    are = np.array([isinstance(shape, Mesh) for shape in shapes])
    made_of = [each for mesh in meshes for each in (mesh.vertices, mesh.faces)]
    whole = (np.array([ground]), are, centers, rotations, *made_of)
    return _read(kept(__file__, whole, lambda: _written(parts_of(shapes, centers, rotations, ground), are)), shapes)


def _written(parts: ObstacleParts, are: NDArray[np.bool_]) -> Arrays:
    """All but the obstacles that are parts of themselves."""
    own = parts.shapes
    kinds = [_PIECE if isinstance(shape, Mesh) else _BOX for shape in own]
    pieces = [shape for shape in own if isinstance(shape, Mesh)]
    return {
        "kinds": np.where(are[parts.owners], kinds, _ITSELF),
        "owners": parts.owners,
        "centers": parts.centers,
        "rotations": parts.rotations,
        "counts": np.array([len(piece.vertices) for piece in pieces], np.int64),
        "corners": np.concatenate([np.empty((0, 3)), *(piece.vertices for piece in pieces)]),
        "boxes": 2.0 * np.array([shape.half for shape in own]).reshape(-1, 3),
    }


def _read(arrays: Arrays, shapes: Sequence[Shape]) -> ObstacleParts:
    ends = np.cumsum(arrays["counts"]).tolist()
    soups = (
        Mesh(arrays["corners"][begin:end], np.arange(end - begin).reshape(-1, 3))
        for begin, end in zip([0, *ends], ends, strict=False)
    )
    found = []
    for kind, owner, size in zip(
        arrays["kinds"].tolist(), arrays["owners"].tolist(), arrays["boxes"].tolist(), strict=True
    ):
        found.append(next(soups) if kind == _PIECE else Box(tuple(size)) if kind == _BOX else shapes[owner])
    return ObstacleParts(tuple(found), arrays["centers"], arrays["rotations"], arrays["owners"])
