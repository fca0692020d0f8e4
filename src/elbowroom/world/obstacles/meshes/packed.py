"""What does not fit a row: hulls and meshes, packed one after the other."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.kept_arrays import Arrays, kept
from elbowroom.world.obstacles.layout import LINE
from elbowroom.world.obstacles.meshes.hulls import pack_hulls
from elbowroom.world.obstacles.meshes.meshes import pack_meshes
from elbowroom.world.obstacles.shapes import Hull, Mesh, Shape

Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_MANY = 2000  # triangles: fewer are packed at once
NOTHING = np.zeros(0, np.float32)


class Packed(NamedTuple):
    """Some hulls and meshes, flat."""

    lines: Floats32  # flat
    begins: dict[Hull | Mesh, int]  # the line at which each begins

    def begin(self, shape: Shape) -> int:
        """The line at which a shape begins; 0 for one that fits a row."""
        return self.begins.get(shape, 0) if isinstance(shape, Hull | Mesh) else 0


def pack(shapes: Iterable[Shape]) -> Packed:
    """Those that do not fit a row; equal ones are there once."""
    wanted = list(dict.fromkeys(shape for shape in shapes if isinstance(shape, Hull | Mesh)))
    hulls = pack_hulls([shape for shape in wanted if isinstance(shape, Hull)])
    meshes = [shape for shape in wanted if isinstance(shape, Mesh)]
    lines, begins = _kept_meshes(meshes)
    first = len(hulls.lines) // LINE
    places: dict[Hull | Mesh, int] = dict(hulls.begins.items())
    places |= {mesh: first + int(begin) for mesh, begin in zip(meshes, begins, strict=True)}
    return Packed(np.concatenate([hulls.lines, lines]), places)


def _kept_meshes(meshes: list[Mesh]) -> tuple[Floats32, Longs]:
    """`pack_meshes`, kept on disk where they are large."""
    if sum(len(mesh.faces) for mesh in meshes) < _MANY:
        return pack_meshes(meshes)

    def made() -> Arrays:
        lines, begins = pack_meshes(meshes)
        return {"lines": lines, "begins": begins}

    sizes = np.array([len(mesh.faces) for mesh in meshes])
    found = kept(__file__, (sizes, *(part for mesh in meshes for part in (mesh.vertices, mesh.faces))), made)
    return found["lines"], found["begins"]
