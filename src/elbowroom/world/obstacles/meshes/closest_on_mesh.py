"""Where a segment and a mesh are closest, in double precision: every triangle and every edge is looked at."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.layout import EDGE, LINE, PER_METRE

Floats = NDArray[np.float64]
Pair = tuple[Floats, Floats]  # points (3,) of the segment and of the mesh

_SLACK = 1e-5  # units of a tile
_TINY = 1e-30


def closest_on_mesh(begin: Floats, step: Floats, packed: NDArray[np.float32], line: int) -> Pair:
    """The nearest points of a segment and of the mesh that is packed from a line on: in its axes, metres."""
    faces, edges = _unpacked(packed[line * LINE :])
    pairs = [_from_ends(begin * PER_METRE, step * PER_METRE, faces), _from_edges(begin, step, edges)]
    gaps = [float(np.linalg.norm(on_axis - on_mesh)) for on_axis, on_mesh in pairs]
    on_axis, on_mesh = pairs[int(np.argmin(gaps))]
    return on_axis / PER_METRE, on_mesh / PER_METRE


def _unpacked(lines: NDArray[np.float32]) -> tuple[Floats, Floats]:
    """Planes (T, 4, 4) of all triangles and all edges (E, EDGE) of the first mesh."""
    faces, edges, at = [np.zeros((0, 4, 4))], [np.zeros((0, EDGE))], LINE
    for _ in range(int(lines[0])):
        triangles, rims = int(lines[at]), int(lines[at + 1])
        middle = at + LINE * (1 + triangles)
        faces.append(lines[at + LINE : middle].reshape(-1, 4, 4).astype(np.float64))
        edges.append(lines[middle : middle + EDGE * rims].reshape(-1, EDGE).astype(np.float64))
        at = middle + LINE * ((rims + 1) // 2)
    return np.concatenate(faces), np.concatenate(edges)


def _from_ends(begin: Floats, step: Floats, faces: Floats) -> Pair:
    """The segment's ends over triangles, and where it pierces one."""
    heights = [np.einsum("tki,i->tk", faces[:, :, :3], end) - faces[:, :, 3] for end in (begin, begin + step)]
    pairs = [(begin, np.full(3, np.inf))]
    for end, height in zip((begin, begin + step), heights, strict=True):
        over = np.where((height[:, 1:] <= _SLACK).all(axis=1), np.abs(height[:, 0]), np.inf)
        if np.isfinite(over).any():
            k = int(np.argmin(over))
            pairs.append((end, end - height[k, 0] * faces[k, 0, :3]))
    first, second = (height[:, 0] for height in heights)
    share = first / np.where(np.abs(first - second) > _TINY, first - second, np.inf)
    meets = (first * second <= 0.0) & (share >= 0.0) & (share <= 1.0)
    sides = heights[0][:, 1:] + share[:, None] * (heights[1] - heights[0])[:, 1:]
    pierced = np.flatnonzero(meets & (sides <= _SLACK).all(axis=1))
    if len(pierced):
        point = begin + share[pierced[0]] * step
        return point, point
    return min(pairs, key=lambda pair: float(np.linalg.norm(pair[0] - pair[1])))


def _from_edges(begin: Floats, step: Floats, edges: Floats) -> Pair:
    """The segment beside an edge: the nearest points of two lines, each brought back between its ends."""
    begin, step = begin * PER_METRE, step * PER_METRE
    if not len(edges):
        return begin, np.full(3, np.inf)
    off, along = begin - edges[:, :3], edges[:, 3:6]
    dd, de, dr = float(step @ step) + _TINY, along @ step, off @ step
    ee, er = np.maximum(edges[:, 6], _TINY), np.einsum("ei,ei->e", along, off)
    s = np.clip((de * er - dr * ee) / np.maximum(dd * ee - de * de, _TINY), 0.0, 1.0)
    for _ in range(2):
        t = np.clip((de * s + er) / ee, 0.0, 1.0)
        s = np.clip((de * t - dr) / dd, 0.0, 1.0)
    on_axis, on_edge = begin + s[:, None] * step, edges[:, :3] + t[:, None] * along
    k = int(np.argmin(np.linalg.norm(on_axis - on_edge, axis=1)))
    return on_axis[k], on_edge[k]
