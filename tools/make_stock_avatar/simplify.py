"""Fewer triangles where the surface is flat: edge collapse by quadric error, many independent edges at a time.

Method: M. Garland and P. Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH 1997.
"""

import numpy as np
from numpy.typing import NDArray

from make_stock_avatar.fields import Array, Field, normals
from make_stock_avatar.polygonise import Mesh, drawn_to, snapped

_EVENNESS = 2e-3  # how much edge length counts beside the error: keeps triangles even, so that joints bend smoothly
_ROUNDS = 80

Index = NDArray[np.int64]


def simplified(mesh: Mesh, field: Field, target: int) -> Mesh:
    """A closed mesh with about `target` points, all on the zero level of `field`."""
    points, triangles = mesh.points, mesh.triangles
    quadrics = _quadrics(points, triangles)
    for _ in range(_ROUNDS):
        excess = len(np.unique(triangles)) - target
        if excess <= 0:
            break
        edges, places, costs = _candidates(points, triangles, quadrics)
        chosen = _independent(edges, costs, len(points), excess)
        chosen = chosen[_safe(points, triangles, edges[chosen], places[chosen])]
        if len(chosen) == 0:
            break
        points, quadrics, triangles = _collapsed(points, quadrics, triangles, edges[chosen], places[chosen])
    used, compact = np.unique(triangles, return_inverse=True)
    size = float(np.linalg.norm(points[triangles[:, 0]] - points[triangles[:, 1]], axis=1).mean())
    points = drawn_to(field, points[used], size, steps=3)
    return Mesh(points, normals(field, points), compact.reshape(-1, 3))


def _quadrics(points: Array, triangles: Index) -> Array:
    """The sum of squared distances to the planes around each point, as matrices (V, 4, 4)."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    cross = np.cross(b - a, c - a)
    area = np.maximum(np.linalg.norm(cross, axis=1, keepdims=True), 1e-15)
    plane = np.column_stack([cross / area, -((cross / area) * a).sum(axis=1)])
    each = plane[:, :, None] * plane[:, None, :] * area[:, :, None]
    total = np.zeros((len(points), 4, 4))
    for i in range(3):
        np.add.at(total, triangles[:, i], each)
    return total


def _candidates(points: Array, triangles: Index, quadrics: Array) -> tuple[Index, Array, Array]:
    """Edges (E, 2), the best place for each edge's one point (E, 3), and the cost of collapsing it (E,)."""
    edges = _distinct_pairs(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2))
    q = quadrics[edges].sum(axis=1)
    middle = points[edges].mean(axis=1)
    weight = np.trace(q[:, :3, :3], axis1=1, axis2=2)[:, None, None] * 0.02
    matrix = q[:, :3, :3] + weight * np.eye(3)
    right = -q[:, :3, 3] + weight[:, 0] * middle
    places = snapped(_solved(matrix, right))
    homogeneous = np.column_stack([places, np.ones(len(places))])
    error = ((q * homogeneous[:, :, None]).sum(axis=1) * homogeneous).sum(axis=1)
    length2 = ((points[edges[:, 0]] - points[edges[:, 1]]) ** 2).sum(axis=1)
    costs = np.abs(error) + _EVENNESS * length2 * length2
    return edges, places, costs.astype(np.float32).astype(np.float64)  # ties of mirrored edges stay ties


def _solved(matrix: Array, right: Array) -> Array:
    """Cramer's rule for systems (E, 3, 3), (E, 3), in plain arithmetic that no library reorders."""
    a, b, c = (matrix[:, :, i] for i in range(3))
    bc, ca, ab = np.cross(b, c), np.cross(c, a), np.cross(a, b)
    determinant = (a * bc).sum(axis=1, keepdims=True)
    return np.asarray(np.column_stack([(right * v).sum(axis=1) for v in (bc, ca, ab)]) / determinant)


def _distinct_pairs(pairs: Index) -> Index:
    """Unordered pairs of point numbers, each once, the smaller number first."""
    low, high = pairs.min(axis=1), pairs.max(axis=1)
    base = int(high.max()) + 1
    keys = np.unique(low * base + high)
    return np.column_stack([keys // base, keys % base])


def _independent(edges: Index, costs: Array, count: int, most: int) -> Index:
    """The cheapest edges none of which has another in its neighbourhood, at most `most`."""
    order = np.argsort(costs, kind="stable")
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    best = np.full(count, len(order), np.int64)
    reach = rank
    for _ in range(2):
        np.minimum.at(best, edges[:, 0], reach)
        np.minimum.at(best, edges[:, 1], reach)
        reach = best[edges].min(axis=1)
    chosen = np.flatnonzero(rank == best[edges].min(axis=1))
    chosen = chosen[np.argsort(rank[chosen])]
    return chosen[rank[chosen] < max(len(order) // 4, 1)][:most]


def _safe(points: Array, triangles: Index, edges: Index, places: Array) -> NDArray[np.bool_]:
    """Which collapses keep the surface a surface: two shared neighbours, and no triangle turned over."""
    of_point = np.full(len(points), -1, np.int64)
    of_point[edges] = np.arange(len(edges))[:, None]
    owner = of_point[triangles]
    touched = owner.max(axis=1)
    near = np.flatnonzero(touched >= 0)
    own, corners = touched[near], triangles[near]
    inside = owner[near] >= 0
    before = points[corners]
    after = np.where(inside[:, :, None], places[own][:, None, :], before)
    n0, n1 = (np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]) for t in (before, after))
    size = np.linalg.norm(n0, axis=1) * np.linalg.norm(n1, axis=1)
    stays = inside.sum(axis=1) == 1
    turned = stays & ((n0 * n1).sum(axis=1) < 0.35 * size)
    bad = np.zeros(len(edges), bool)
    bad[own[turned]] = True
    return np.asarray(~bad & (_shared_neighbours(corners, inside, own, edges) == 2))


def _shared_neighbours(corners: Index, inside: NDArray[np.bool_], own: Index, edges: Index) -> Index:
    """How many points neighbour both ends of each edge."""
    first = corners == edges[own][:, :1]
    second = corners == edges[own][:, 1:]
    base = int(corners.max()) + 1
    keys = []
    for end in (first, second):
        has = end.any(axis=1)
        outside = ~inside[has]
        rows = np.broadcast_to(own[has][:, None], outside.shape)
        keys.append(np.unique(rows[outside] * base + corners[has][outside]))
    both, times = np.unique(np.concatenate(keys), return_counts=True)
    return np.bincount(both[times == 2] // base, minlength=len(edges)).astype(np.int64)


def _collapsed(
    points: Array, quadrics: Array, triangles: Index, edges: Index, places: Array
) -> tuple[Array, Array, Index]:
    keep, drop = edges[:, 0], edges[:, 1]
    points, quadrics = points.copy(), quadrics.copy()
    points[keep] = places
    quadrics[keep] += quadrics[drop]
    index = np.arange(len(points))
    index[drop] = keep
    triangles = index[triangles]
    a, b, c = triangles.T
    return points, quadrics, triangles[(a != b) & (b != c) & (c != a)]
