"""HAnimDisplacer: points of a skin or segment that a weight moves, in glTF a morph target (ISO/IEC 19774-1)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.x3d.model import Nodes

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MOST = 200  # of one skin or segment


@dataclass(frozen=True, eq=False)
class Displacer:
    """Where some points of a Coordinate node go at weight 1."""

    name: str
    weight: float  # as the file has it
    index: Ints  # (K,) points
    moves: Floats  # (K, 3)

    def target(self, sources: Ints) -> Floats | None:
        """How far the vertices (V,) of a mesh move that come from the points `sources`, (V, 3); None if none does."""
        moved = np.zeros((max(int(sources.max()), int(self.index.max())) + 1, 3))
        moved[self.index] = self.moves
        target: Floats = moved[sources]
        return target if target.any() else None


def displacers_in(nodes: Nodes, points: int) -> tuple[Displacer, ...]:
    """The displacers that hang on joints or a segment, whose points are numbers below `points`; raises `InputError`."""
    found: list[Displacer] = []
    for node in (displacer for holder in nodes for displacer in holder.nodes("displacers")):
        index, moves = node.integers("coordIndex"), node.vectors("displacements", 3)
        count = min(len(index), len(moves))
        if not count:
            continue
        if not 0 <= int(index.min()) <= int(index.max()) < points:
            raise InputError(f"{node.place}.coordIndex points to number {int(index.max())} of {points}")
        if len(found) == _MOST:
            raise InputError(f"{node.place}: more than {_MOST} displacers")
        name = node.text("name") or node.name
        found.append(Displacer(name, node.number("weight", 0.0), index[:count], moves[:count]))
    return tuple(found)
