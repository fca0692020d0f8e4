"""The C-T roadmap G-T_x: an activity graph drawn out along a root path (paper, section 5.2).

A node is (vertex, depth): the group has the vertex's configuration at the key time of that depth. From a node one may
go to its own vertex or a neighbour of it at the next depth: the set CTN, a directed acyclic graph with one source.

A node is valid if the group's capsules keep a margin from every obstacle at that key time. The clearances of all
vertices at one depth come from a single batch, made when that depth is first touched: obstacles are moved into the
frame that carries the group, where the vertices' capsules stand still and are posed once for many roadmaps.
As in the paper, obstacles are looked at at key times only.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, inner_exact_kernel
from elbowroom.planning.model.limb import Limb, pose
from elbowroom.planning.paper.activity_graph import VISITORS, ActivityGraph, GraphArrays
from elbowroom.world.obstacles.clearance import clearance_into
from elbowroom.world.obstacles.layout import Spans
from elbowroom.world.obstacles.rows import at_span, span_count

Floats32 = NDArray[np.float32]
_REACH = 2.0  # a stretched limb reaches at most so much farther than the farthest reaching vertex that we know


@by_reference
class RoadmapArrays(NamedTuple):
    """The roadmap as compiled code sees it; columns of `clearances` are the rows of the graph's arrays."""

    limb: Limb
    segments: Floats32  # (C, 6, V) capsules of the graph's vertices at the start of this plan
    obstacles: Spans  # in the limb's frame at each key time, n+1
    clearances: Floats32  # (n+1, rows) metres; valid at depths that are `ready`
    ready: NDArray[np.bool_]  # (n+1,)


class PosedGraph:
    """An activity graph and the capsules of its vertices; follows the graph as it grows."""

    def __init__(self, limb: Limb, graph: ActivityGraph) -> None:
        self.limb = limb
        self.graph = graph
        self._segments = pose(limb, graph.vertices)
        self._resets = graph.resets

    @property
    def segments(self) -> Floats32:
        """The vertices' capsules (C, 6, V) in the limb's frame, metres."""
        if self._resets != self.graph.resets:
            self._segments = np.ascontiguousarray(self._segments[:, :, : self.graph.initial_size])
            self._resets = self.graph.resets
        known = self._segments.shape[2]
        if self.graph.size > known:
            new = pose(self.limb, self.graph.vertices[known:])
            self._segments = np.concatenate([self._segments, new], axis=2)
        return self._segments

    @property
    def reach(self) -> float:
        """No capsule of the limb gets farther than this from the limb's frame, metres."""
        ends = self.segments.transpose(0, 2, 1).reshape(-1, 3)
        return _REACH * float(np.linalg.norm(ends, axis=1).max()) + float(self.limb.radii.max())


class Roadmap:
    """The roadmap of one group along one root path, entered at configuration `start` (d,).

    `obstacles` are those at the n+1 key times in the frame that carries the group.
    """

    def __init__(self, posed: PosedGraph, obstacles: Spans, start: ArrayLike) -> None:
        self.graph = posed.graph
        self.source = self.graph.enter(start)
        depths, columns = span_count(obstacles), self.graph.arrays.capacity + VISITORS
        self.arrays = RoadmapArrays(
            posed.limb, posed.segments, obstacles, np.empty((depths, columns), np.float32), np.zeros(depths, np.bool_)
        )

    @property
    def horizon(self) -> int:
        """n: the depth of a complete path."""
        return span_count(self.arrays.obstacles) - 1

    def clearance(self, depth: int) -> Floats32:
        """The clearance in metres of every vertex of the graph at a depth, shape (V,); a view."""
        touch(self.graph.arrays, self.arrays, depth)
        return self.arrays.clearances[depth, : self.graph.size]

    def clearance_of(self, vertex: int, depth: int) -> float:
        """The clearance in metres of one vertex or visitor at a depth."""
        touch(self.graph.arrays, self.arrays, depth)
        return float(self.arrays.clearances[depth, vertex])


@exact_kernel
def touch(graph: GraphArrays, roadmap: RoadmapArrays, depth: int) -> None:
    """Make the clearances at `depth` ready: one batch over the graph's vertices, one over the visitors."""
    if roadmap.ready[depth]:
        return
    row, near, radii = roadmap.clearances[depth], at_span(roadmap.obstacles, depth), roadmap.limb.radii
    clearance_into(roadmap.segments, radii, near, row[: roadmap.segments.shape[2]])
    first, count = graph.capacity, graph.visitors[0]
    if count > 0:
        segments = pose(roadmap.limb, graph.vertices[first : first + count])
        clearance_into(segments, radii, near, row[first : first + count])
    roadmap.ready[depth] = True


@inner_exact_kernel
def clearance_at(roadmap: RoadmapArrays, segments: Floats32, depth: int) -> float:
    """The clearance in metres of one posture, capsules (C, 6, 1), at a depth."""
    out = np.empty(1, np.float32)
    clearance_into(segments, roadmap.limb.radii, at_span(roadmap.obstacles, depth), out)
    return float(out[0])
