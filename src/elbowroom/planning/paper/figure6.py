"""The search of the paper's Figure 6, as printed: depth first through a C-T roadmap, nearest to the goal first.

Kept as in the figure, with what follows from it: the stack may hold a node many times and a dead end is explored anew
from every way into it (there is no visited set); the nodes that do not collide are pushed farthest first, so that the
one nearest to the goal of the next key time is popped first; where none is free, one random configuration within r of
the dead end is tried, pushed and kept in the activity graph (Enhance); the empty stack is failure.

Where the figure is silent: of equally near nodes the vertex itself is popped before its neighbours, an older neighbour
before a younger one; a random configuration is uniform in the ball of radius r (in the components that are not held)
and clamped to the limits; one that runs into the avatar's own trunk collides too (`self_contact`); one that hits a
known vertex is that vertex; a full graph draws none. One check is counted for each candidate tested, as the paper
counts them, though most answers come from a table. Out of checks, the search stops.
"""

import math
from time import perf_counter_ns

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper
from elbowroom.planning.model.limb import pose
from elbowroom.planning.model.self_contact import clear_of_trunk
from elbowroom.planning.paper.activity_graph import GraphArrays, insert, squared_distance
from elbowroom.planning.paper.roadmap import Roadmap, RoadmapArrays, clearance_at, touch
from elbowroom.planning.result import PlanStatus, SearchResult

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

_FOUND, _EXHAUSTED, _OUT_OF_BUDGET = 0, 1, 2
_STATUS = (PlanStatus.FOUND, PlanStatus.EXHAUSTED, PlanStatus.OUT_OF_BUDGET)
_INSIDE = 1.0 - 1e-9  # random neighbours lie strictly within r, rounding included


def search(
    roadmap: Roadmap, goals: Floats, rng: np.random.Generator, margins: Floats, budget: int = 60_000
) -> SearchResult:
    """Search a path of depth n from the roadmap's source (paper, Figure 6).

    `goals` (n+1, d) are the goal configurations at the key times; `margins` (n+1,) in metres are the clearances that
    count as free there; `budget` is the greatest number of collision checks. One number is drawn from `rng`.
    """
    began = perf_counter_ns()
    graph = roadmap.graph
    state = rng.integers(1, 2**63, size=1, dtype=np.uint64)
    path = np.zeros(roadmap.horizon + 1, np.int32)
    status, checks, nodes, enhanced = _search(
        graph.arrays,
        roadmap.arrays,
        np.ascontiguousarray(goals, np.float64),
        roadmap.source,
        np.ascontiguousarray(margins, np.float64),
        int(budget),
        state,
        path,
    )
    vertices = path if status == _FOUND else path[:0]
    configurations = graph.arrays.vertices[vertices]
    spent = perf_counter_ns() - began
    return SearchResult(_STATUS[status], configurations, vertices, checks, nodes, enhanced, spent)


@helper
def _uniform(state: NDArray[np.uint64]) -> float:
    """The next number of [-1, 1): xorshift64 (G. Marsaglia, J. Statistical Software 8, 2003), the upper 53 bits."""
    x = state[0]
    x ^= x << np.uint64(13)
    x ^= x >> np.uint64(7)
    x ^= x << np.uint64(17)
    state[0] = x
    return float(x >> np.uint64(11)) * 2.0**-52 - 1.0


@helper
def _sample_neighbor(graph: GraphArrays, target: int, state: NDArray[np.uint64]) -> Floats:
    """A random configuration within r of `target` and within the limits; Search_New_Neighbor in the figure."""
    size = graph.vertices.shape[1]
    step = np.empty(size)
    length = 1.0
    while length >= 1.0:
        length = 0.0
        for k in range(size):
            step[k] = _uniform(state) if graph.limits[k, 0] < graph.limits[k, 1] else 0.0
            length += step[k] * step[k]
    for k in range(size):
        value = graph.vertices[target, k] + graph.radius * _INSIDE * step[k]
        step[k] = min(max(value, graph.limits[k, 0]), graph.limits[k, 1])
    elevation = math.sqrt(step[0] * step[0] + step[1] * step[1])
    if elevation > graph.elevation:
        step[0] *= graph.elevation / elevation
        step[1] *= graph.elevation / elevation
    return step


@helper
def _push_free(
    graph: GraphArrays, roadmap: RoadmapArrays, goal: Floats, target: int, depth: int, margin: float, stack: Ints
) -> int:
    """Push the nodes of CTN(target) that are free at `depth`, farthest from `goal` first; returns their number.

    `stack` is the free part of the stack. An insertion sort, stable, on the stack itself.
    """
    free = roadmap.clearances[depth]
    keys = np.empty(graph.degrees[target] + 1)
    count = 0
    for i in range(graph.degrees[target] - 1, -2, -1):
        vertex = graph.neighbors[target, i] if i >= 0 else target
        if free[vertex] < margin:
            continue
        key = squared_distance(graph.vertices[vertex], goal)
        place = count
        while place > 0 and keys[place - 1] < key:
            keys[place], stack[place] = keys[place - 1], stack[place - 1]
            place -= 1
        keys[place], stack[place] = key, vertex
        count += 1
    return count


@helper
def _enhance(
    graph: GraphArrays, roadmap: RoadmapArrays, target: int, depth: int, margin: float, state: NDArray[np.uint64]
) -> int:
    """Try one random new neighbour of `target`; returns its vertex in the enhanced graph, or -1 if it collides."""
    candidate = _sample_neighbor(graph, target, state)
    limb = roadmap.limb
    segments = pose(limb, candidate.reshape(1, -1))
    if clearance_at(roadmap, segments, depth) < margin or not clear_of_trunk(segments, limb.trunk, limb.allowed)[0]:
        return -1
    size = graph.size[0]
    vertex = insert(graph, candidate)
    if vertex >= size:
        for t in range(roadmap.ready.shape[0]):
            roadmap.clearances[t, vertex] = clearance_at(roadmap, segments, t)
    return vertex


@exact_kernel
def _search(
    graph: GraphArrays,
    roadmap: RoadmapArrays,
    goals: Floats,
    source: int,
    margins: Floats,
    budget: int,
    state: NDArray[np.uint64],
    path: Ints,
) -> tuple[int, int, int, int]:
    """Figure 6; fills `path` (n+1,) and returns status, checks, nodes, vertices added."""
    horizon, size = len(goals) - 1, graph.size[0]
    # What lies on the stack are siblings of the nodes on the path: at most one CTN for each depth.
    rows = graph.vertices.shape[0]
    stack = np.empty(horizon * rows + 1, np.int32)
    depths = np.empty(horizon * rows + 1, np.int32)
    stack[0], depths[0] = source, 0
    top, checks, nodes = 1, 0, 0
    while top > 0:
        top -= 1
        target, depth = stack[top], depths[top]
        nodes += 1
        path[depth] = target
        if depth == horizon:
            return _FOUND, checks, nodes, graph.size[0] - size
        checks += graph.degrees[target] + 1
        if checks > budget:
            return _OUT_OF_BUDGET, budget, nodes, graph.size[0] - size
        touch(graph, roadmap, depth + 1)
        count = _push_free(graph, roadmap, goals[depth + 1], target, depth + 1, margins[depth + 1], stack[top:])
        if count == 0 and graph.size[0] < graph.capacity:
            if checks == budget:
                return _OUT_OF_BUDGET, budget, nodes, graph.size[0] - size
            checks += 1
            vertex = _enhance(graph, roadmap, target, depth + 1, margins[depth + 1], state)
            if vertex >= 0:
                stack[top] = vertex
                count = 1
        for i in range(count):
            depths[top + i] = depth + 1
        top += count
    return _EXHAUSTED, checks, nodes, graph.size[0] - size
