"""The activity graph G_x of one local group: what its limb has learnt to do (paper, section 4.1).

Vertices are configurations of the group, resampled from clips; any two at Euclidean distance < r are joined. The
graph lives in preallocated arrays, so that a compiled search can add vertices ("Enhance", Figure 6) while it runs.

Beside the graph's own vertices there is room for a few visitors: configurations of one planning call that do not
belong to the graph, such as the posture shown at this moment. Edges lead from a visitor into the graph, never back.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.clips.clip import MotionClip
from elbowroom.body.dof import MAX_ELEVATION, DofGroup, clamp, limits
from elbowroom.by_reference import by_reference
from elbowroom.errors import InputError
from elbowroom.jit import exact_kernel, inner_exact_kernel

VISITORS = 32  # room for the visitors of one planning call
MAX_CAPACITY = 4096  # vertices; the neighbour table grows with its square
_SAME = 1e-6  # configurations closer than this, in radians, are one vertex

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


@by_reference
class GraphArrays(NamedTuple):
    """The graph as compiled code sees it. Rows 0..size-1 are the graph's, rows from `capacity` on are visitors."""

    vertices: Floats  # (rows, d) radians
    neighbors: Ints  # (rows, rows) ascending vertex numbers, the first `degrees` of each row are valid
    degrees: Ints  # (rows,)
    size: Ints  # (1,) number of the graph's own vertices
    visitors: Ints  # (1,) number of visitors
    limits: Floats  # (d, 2) radians; where both are equal the component is held there
    elevation: float  # the first two components are no longer than this, radians; infinite for the waist
    radius: float  # r, radians
    capacity: int  # rows for the graph's own vertices


class ActivityGraph:
    """An activity graph with room to grow.

    `configurations` (V, d) are brought within the limits of `group`, duplicates are merged; `radius` r > 0 in radians
    bounds how far the group moves from one key frame to the next; beyond `capacity` vertices it grows no further.
    New vertices keep to `bounds` (d, 2), the limits of the group if they are not given.
    """

    def __init__(
        self,
        group: DofGroup,
        configurations: ArrayLike,
        radius: float,
        capacity: int = 512,
        bounds: Floats | None = None,
    ) -> None:
        points = clamp(group, np.asarray(configurations, np.float64).reshape(-1, group.size))
        _check(points, radius, capacity)
        self.group = group
        self.resets = 0  # how often the graph was begun anew
        self._initial = points
        rows = capacity + VISITORS
        self.arrays = GraphArrays(
            np.zeros((rows, points.shape[1])),
            np.zeros((rows, rows), np.int32),
            np.zeros(rows, np.int32),
            np.zeros(1, np.int32),
            np.zeros(1, np.int32),
            limits(group) if bounds is None else np.array(bounds, np.float64),
            MAX_ELEVATION if group.is_arm else np.inf,
            float(radius),
            int(capacity),
        )
        self._begin()

    @classmethod
    def from_clips(
        cls,
        clips: Sequence[MotionClip],
        samples_per_clip: int,
        radius: float,
        capacity: int = 512,
        accept: Callable[[Floats], NDArray[np.bool_]] | None = None,
        bounds: Floats | None = None,
    ) -> "ActivityGraph":
        """The graph of several clips of one group, each resampled at k = `samples_per_clip` equal times (section 4.1).

        `accept` says for configurations (V, d) which of them may become vertices; all may if it is not given.
        """
        if samples_per_clip < 1:
            raise InputError(f"activity graph: samples_per_clip is {samples_per_clip}, at least 1 is needed")
        if len({clip.group for clip in clips}) != 1:
            raise InputError(f"activity graph: {len(clips)} clips given, at least one is needed and all of one group")
        points = np.concatenate([clip.resample(samples_per_clip) for clip in clips])
        return cls(clips[0].group, points if accept is None else points[accept(points)], radius, capacity, bounds)

    def reset(self) -> None:
        """Forget every vertex that was added since construction, and all visitors."""
        self.resets += 1
        self._begin()

    def _begin(self) -> None:
        self.arrays.size[0] = 0
        self.arrays.visitors[0] = 0
        for point in self._initial:
            insert(self.arrays, point)
        self.initial_size = self.size

    def copy(self) -> "ActivityGraph":
        """An independent graph with the vertices that this one began with."""
        return ActivityGraph(self.group, self._initial, self.arrays.radius, self.arrays.capacity, self.arrays.limits)

    @property
    def size(self) -> int:
        """The number of vertices, visitors not counted."""
        return int(self.arrays.size[0])

    @property
    def vertices(self) -> Floats:
        """The vertices' configurations (V, d), radians; a view."""
        return self.arrays.vertices[: self.size]

    @property
    def full(self) -> bool:
        """Whether no vertex can be added."""
        return self.size == self.arrays.capacity

    def configuration(self, vertex: int) -> Floats:
        """The configuration (d,) of a vertex or visitor, radians."""
        row: Floats = self.arrays.vertices[vertex]
        return row.copy()

    def neighbors(self, vertex: int) -> Ints:
        """The vertices that share an edge with `vertex`, ascending."""
        return self.arrays.neighbors[vertex, : self.arrays.degrees[vertex]].copy()

    def insert(self, configuration: ArrayLike) -> int:
        """Add a configuration (d,), link it to all vertices within r, and return its number; "Enhance" in Figure 6.

        Returns the vertex that is already there for a known configuration, and -1 if the graph is full.
        """
        return int(insert(self.arrays, np.ascontiguousarray(configuration, np.float64)))

    def enter(self, configuration: ArrayLike) -> int:
        """The vertex, or new visitor, from which a search starts at `configuration` (d,). Earlier visitors leave.

        A visitor is linked to every vertex within r. Where there is none within r, a row of way stations leads
        straight to the nearest vertex in steps shorter than r, so that the way back to the graph is always open and
        keeps to the speed limit.
        """
        start = np.ascontiguousarray(configuration, np.float64)
        self.arrays.visitors[0] = 0
        known = find(self.arrays, start)
        return int(known) if known >= 0 else int(self._admit_row(start))

    def _admit_row(self, start: Floats) -> int:
        distances = np.linalg.norm(self.vertices - start, axis=1)
        nearest = self.vertices[np.argmin(distances)]
        way = float(distances.min())
        step = max(0.9 * self.arrays.radius, way / (VISITORS - 1))
        stations = int(np.ceil(way / step)) - 1 if way >= self.arrays.radius else 0
        first = self.arrays.capacity
        for i in range(stations + 1):
            _admit(self.arrays, start + (nearest - start) * (i / (stations + 1)))
        for i in range(stations):
            _link(self.arrays, first + i, first + i + 1)
        return first


def _check(points: Floats, radius: float, capacity: int) -> None:
    if not np.isfinite(points).all() or len(points) == 0:
        raise InputError("activity graph: needs at least one configuration, all finite")
    if not radius > 0.0:
        raise InputError(f"activity graph: radius is {radius} rad, it must be positive")
    if not len(points) <= capacity <= MAX_CAPACITY:
        raise InputError(f"activity graph: capacity is {capacity}, allowed are {len(points)} to {MAX_CAPACITY}")


@inner_exact_kernel
def squared_distance(a: Floats, b: Floats) -> float:
    """Squared Euclidean distance of two configurations (d,), summed in order."""
    total = 0.0
    for k in range(a.shape[0]):
        total += (a[k] - b[k]) * (a[k] - b[k])
    return total


@exact_kernel
def find(graph: GraphArrays, configuration: Floats) -> int:
    """The vertex at `configuration` (d,), or -1."""
    for i in range(graph.size[0]):
        if squared_distance(graph.vertices[i], configuration) < _SAME * _SAME:
            return i
    return -1


@exact_kernel
def _link(graph: GraphArrays, source: int, target: int) -> None:
    graph.neighbors[source, graph.degrees[source]] = target
    graph.degrees[source] += 1


@exact_kernel
def insert(graph: GraphArrays, configuration: Floats) -> int:
    """`ActivityGraph.insert` for compiled code; visitors within r get an edge to the new vertex as well."""
    known = find(graph, configuration)
    if known >= 0 or graph.size[0] == graph.capacity:
        return known
    new = graph.size[0]
    for k in range(configuration.shape[0]):
        graph.vertices[new, k] = configuration[k]
    graph.degrees[new] = 0
    reach = graph.radius * graph.radius
    for i in range(new):
        if squared_distance(graph.vertices[i], configuration) < reach:
            _link(graph, i, new)
            _link(graph, new, i)
    for i in range(graph.capacity, graph.capacity + graph.visitors[0]):
        if squared_distance(graph.vertices[i], configuration) < reach:
            _link(graph, i, new)
    graph.size[0] += 1
    return int(new)


@exact_kernel
def _admit(graph: GraphArrays, configuration: Floats) -> None:
    """Add a visitor with edges to every vertex within r."""
    new = graph.capacity + graph.visitors[0]
    for k in range(configuration.shape[0]):
        graph.vertices[new, k] = configuration[k]
    graph.degrees[new] = 0
    reach = graph.radius * graph.radius
    for i in range(graph.size[0]):
        if squared_distance(graph.vertices[i], configuration) < reach:
            _link(graph, new, i)
    graph.visitors[0] += 1
