"""Polygons into triangles: fans where they are convex, ears cut off where they are not."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MOST_CORNERS = 200  # of a polygon whose ears are sought; a larger one is cut into a fan
_MOST_WORK = 400_000  # squares of corners, of the dented polygons of one mesh


def split_polygons(index: Ints) -> tuple[Ints, Ints]:
    """Where the polygons of an index list that is parted by -1 begin, and how many corners each has (at least 3)."""
    ends = np.flatnonzero(index < 0)
    if not len(ends) or ends[-1] != len(index) - 1:
        ends = np.append(ends, len(index))
    starts = np.append(0, ends[:-1] + 1)
    sizes = ends - starts
    return starts[sizes >= 3], sizes[sizes >= 3]


def fans(starts: Ints, sizes: Ints) -> tuple[Ints, Ints]:
    """Triangles (T, 3) as places in the index list, and the polygon (T,) of each."""
    polygon = np.repeat(np.arange(len(starts)), sizes - 2)
    step = np.arange(len(polygon)) - np.repeat(np.cumsum(sizes - 2) - (sizes - 2), sizes - 2)
    first = starts[polygon]
    return np.stack([first, first + step + 1, first + step + 2], axis=1), polygon


def ears(points: Floats, index: Ints, starts: Ints, sizes: Ints) -> tuple[Ints, Ints]:
    """As `fans`, for polygons that may have dents."""
    triangles, polygon = fans(starts, sizes)
    bent = dented(points, index, starts, sizes)
    kept = [triangles[~bent[polygon]]]
    owners = [polygon[~bent[polygon]]]
    work = 0
    for number in map(int, np.flatnonzero(bent)):
        size = int(sizes[number])
        places = np.arange(starts[number], starts[number] + size)
        work += size * size
        if size > _MOST_CORNERS or work > _MOST_WORK:
            cut = triangles[polygon == number]
        else:
            cut = places[_cut_ears(points[index[places]])]
        kept.append(cut)
        owners.append(np.full(len(cut), number))
    return np.concatenate(kept), np.concatenate(owners)


def dented(points: Floats, index: Ints, starts: Ints, sizes: Ints) -> NDArray[np.bool_]:
    """The polygons (P,) whose fan has a triangle that faces the other way."""
    triangles, polygon = fans(starts, sizes)
    corner = points[index[triangles]]
    normals = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    whole = np.stack([np.bincount(polygon, normals[:, k], len(starts)) for k in range(3)], axis=1)
    against = np.einsum("ti,ti->t", normals, whole[polygon]) < 0.0
    return np.bincount(polygon[against], minlength=len(starts)).astype(bool) & (sizes > 3)


def _cut_ears(ring: Floats) -> Ints:
    """Triangles (n - 2, 3) of a simple polygon (n, 3), seen along its mean normal (Meisters 1975)."""
    flat = _flattened(ring)
    left = list(range(len(flat)))
    found: list[tuple[int, int, int]] = []
    while len(left) > 3:
        at = next((i for i in range(len(left)) if _is_ear(flat, left, i)), 0)
        before, ear, after = left[at - 1], left[at], left[(at + 1) % len(left)]
        found.append((before, ear, after))
        del left[at]
    found.append((left[0], left[1], left[2]))
    return np.array(found, dtype=np.int64)


def _flattened(ring: Floats) -> Floats:
    """The polygon in its own plane (n, 2), counter-clockwise."""
    following = np.roll(ring, -1, axis=0)
    normal = np.cross(ring, following).sum(axis=0)
    drop = int(np.argmax(np.abs(normal)))
    axes = [(1, 2), (2, 0), (0, 1)][drop]
    flat: Floats = ring[:, axes]
    return flat if normal[drop] >= 0.0 else flat * np.array([-1.0, 1.0])


def _is_ear(flat: Floats, left: list[int], at: int) -> bool:
    before, ear, after = flat[left[at - 1]], flat[left[at]], flat[left[(at + 1) % len(left)]]
    if _turn(before, ear, after) <= 0.0:
        return False
    others = flat[[left[i] for i in range(len(left)) if i not in {at, (at - 1) % len(left), (at + 1) % len(left)}]]
    inside = (
        (_turn(before, ear, others) >= 0.0) & (_turn(ear, after, others) >= 0.0) & (_turn(after, before, others) >= 0.0)
    )
    return not bool(np.any(inside))


def _turn(a: Floats, b: Floats, c: Floats) -> Floats:
    """Twice the area of the triangles a, b, c; positive if they run counter-clockwise."""
    area: Floats = (b[0] - a[0]) * (c[..., 1] - a[1]) - (b[1] - a[1]) * (c[..., 0] - a[0])
    return area
