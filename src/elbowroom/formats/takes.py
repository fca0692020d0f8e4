"""A take: a skeleton of nodes and what each of them does over time, whatever the file it was read from."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.nodes import NodeTree
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

MAX_FRAMES = 200_000
MAX_POSES = 2_000_000  # frames times nodes of one take


@dataclass(frozen=True, eq=False)
class Take:
    """Local rotations and translations of all nodes at equal time steps, in the file's own axes and units."""

    name: str  # of the clip within its file
    tree: NodeTree  # the rest pose
    frame_time: float  # seconds from one frame to the next
    rotations: Floats  # (F, n, 4) local, xyzw
    translations: Floats  # (F, n, 3) local

    def __len__(self) -> int:
        return len(self.rotations)

    @property
    def fps(self) -> float:
        """Frames a second."""
        return 1.0 / self.frame_time

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return (len(self) - 1) * self.frame_time

    def world(self, nodes: NDArray[np.int64]) -> tuple[Floats, Floats]:
        """World rotations (F, k, 4) and positions (F, k, 3) of some nodes at all frames; scales are those at rest."""
        wanted = {above for node in map(int, nodes) for above in (node, *self.tree.ancestors(node))}
        turns: dict[int, Floats] = {}
        places: dict[int, Floats] = {}
        scales: dict[int, Floats] = {}
        for node in (int(node) for node in self.tree.order if int(node) in wanted):
            above = int(self.tree.parents[node])
            turn, place = self.rotations[:, node], self.translations[:, node]
            scale = self.tree.scales[node]
            if above >= 0:
                place = places[above] + quaternion.rotate(turns[above], scales[above] * place)
                turn = quaternion.multiply(turns[above], turn)
                scale = scales[above] * scale
            turns[node], places[node], scales[node] = turn, place, scale
        return (
            np.stack([turns[int(node)] for node in nodes], axis=1),
            np.stack([places[int(node)] for node in nodes], axis=1),
        )
