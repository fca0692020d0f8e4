"""What a mapping looks at: the names, parents and places of a file's nodes, whatever its format."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class FileNodes:
    """The nodes of a file in its rest pose."""

    names: tuple[str, ...]  # (n,)
    parents: NDArray[np.int64]  # (n,) -1 for a root
    positions: NDArray[np.float64]  # (n, 3) in the world, Y up, any unit
    joints: frozenset[int] = field(default_factory=frozenset)  # that move a skin; empty where none is known

    def __len__(self) -> int:
        return len(self.names)

    @cached_property
    def order(self) -> tuple[int, ...]:
        """All nodes, parents before children; brothers in the order of the file."""
        children: list[list[int]] = [[] for _ in self.names]
        for node, parent in enumerate(self.parents):
            if parent >= 0:
                children[parent].append(node)
        level = [node for node, parent in enumerate(self.parents) if parent < 0]
        order: list[int] = []
        while level:
            order += level
            level = [child for node in level for child in children[node]]
        return tuple(order)

    def ancestors(self, node: int) -> list[int]:
        """The nodes above `node`, nearest first."""
        above = []
        while (node := int(self.parents[node])) >= 0:
            above.append(node)
        return above
