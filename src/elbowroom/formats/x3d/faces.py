"""IndexedFaceSet and its relatives: faces written as lists of indices."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.polygons import ears, fans, split_polygons
from elbowroom.formats.x3d.mesh import Corners, Mesh, assembled, creased_normals
from elbowroom.formats.x3d.model import Node

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def indexed_face_set(node: Node) -> Mesh | None:
    """An IndexedFaceSet; None if it has no faces."""
    index = node.integers("coordIndex")
    points = coordinates(node)
    starts, sizes = split_polygons(index)
    if not len(starts):
        return None
    _check(node, "coordIndex", index[index >= 0], len(points))
    convex = node.flag("convex", True)
    places, polygon = fans(starts, sizes) if convex else ears(points, index, starts, sizes)
    return _mesh(node, points, index, places.reshape(-1), np.repeat(polygon, 3))


def triangle_set(node: Node) -> Mesh | None:
    """TriangleSet, TriangleFanSet, TriangleStripSet, QuadSet and those with an index; None if there are no faces."""
    points = coordinates(node)
    index = node.integers("index") if node.kind.startswith("Indexed") else np.arange(len(points))
    places = _SETS[node.kind](node, index)
    if not len(places):
        return None
    _check(node, "index", index[places], len(points))
    return _mesh(node, points, index, places, np.arange(len(places)) // 3)


def coordinates(node: Node) -> Floats:
    """The points (P, 3) of a geometry node."""
    coord = node.node("coord")
    return np.zeros((0, 3)) if coord is None else coord.vectors("point", 3)


def _mesh(node: Node, points: Floats, index: Ints, places: Ints, polygon: Ints) -> Mesh:
    """The mesh of triangle corners given as places in the index list."""
    if not node.flag("ccw", True):
        places = places.reshape(-1, 3)[:, ::-1].reshape(-1)
        polygon = polygon.reshape(-1, 3)[:, ::-1].reshape(-1)
    at = index[places]
    normals = _attribute(node, "normal", "vector", 3, index, places, polygon)
    if normals is None:
        normals = creased_normals(points, at, node.number("creaseAngle", 0.0))
    uvs = _uvs(node, index, places, polygon)
    return assembled(
        Corners(
            points=points,
            at=at,
            normals=normals,
            colours=_colours(node, index, places, polygon),
            uvs=uvs if uvs is not None else _default_uvs(points, at),
            two_sided=not node.flag("solid", True),
        )
    )


def _attribute(
    node: Node, field: str, values: str, size: int, index: Ints, places: Ints, polygon: Ints
) -> tuple[Floats, Ints] | None:
    """What a node in `field` says about corners or, where the file wants it so, about whole faces."""
    holder = node.node(field)
    if holder is None or not holder.has(values):
        return None
    vectors = holder.vectors(values, size)
    own = node.integers(f"{field}Index")
    if node.flag(f"{field}PerVertex", True):
        if len(own) and len(own) < int(places.max(initial=-1)) + 1:
            raise node.wrong(f"{field}Index", f"as long as coordIndex ({len(index)}), not {len(own)}")
        at = own[places] if len(own) else index[places]
    else:
        if len(own) and len(own) <= int(polygon.max(initial=-1)):
            raise node.wrong(f"{field}Index", f"at least as many as the faces ({int(polygon.max()) + 1})")
        at = own[polygon] if len(own) else polygon
    _check(node, f"{field}Index", at, len(vectors))
    return vectors, at


def _colours(node: Node, index: Ints, places: Ints, polygon: Ints) -> tuple[Floats, Ints] | None:
    holder = node.node("color")
    size = 4 if holder is not None and holder.kind == "ColorRGBA" else 3
    found = _attribute(node, "color", "color", size, index, places, polygon)
    if found is None:
        return None
    colours, at = found
    colours = np.clip(colours, 0.0, 1.0)
    return (colours if size == 4 else np.column_stack([colours, np.ones(len(colours))])), at


def _uvs(node: Node, index: Ints, places: Ints, polygon: Ints) -> tuple[Floats, Ints] | None:
    """Texture coordinates; those that do not fit their faces are left aside, for they only colour."""
    holder = node.node("texCoord")
    if holder is None or holder.kind != "TextureCoordinate":
        return None
    try:
        return _attribute(node, "texCoord", "point", 2, index, places, polygon)
    except InputError:
        return None


def _default_uvs(points: Floats, at: Ints) -> tuple[Floats, Ints]:
    """Texture coordinates along the two longest sides of the bounding box (ISO/IEC 19775-1, 13.3.6)."""
    used = points[at]
    low, extent = used.min(axis=0), np.ptp(used, axis=0)
    s, t = np.argsort(-extent, kind="stable")[:2]
    length = max(float(extent[s]), 1e-12)
    return (points[:, [s, t]] - low[[s, t]]) / length, at


def _check(node: Node, field: str, index: Ints, count: int) -> None:
    if len(index) and (int(index.min()) < 0 or int(index.max()) >= count):
        wrong = int(index.max()) if int(index.max()) >= count else int(index.min())
        raise InputError(f"{node.place}.{field} points to number {wrong} of {count}")


def _triangles(_: Node, index: Ints) -> Ints:
    return np.arange(len(index) // 3 * 3)


def _quads(_: Node, index: Ints) -> Ints:
    quads = np.arange(len(index) // 4 * 4).reshape(-1, 4)
    return quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1)


def _runs(node: Node, index: Ints, counts: str) -> tuple[Ints, Ints]:
    """Where the fans or strips begin and how long they are: parted by -1, or counted in a field."""
    if node.kind.startswith("Indexed"):
        return split_polygons(index)
    sizes = node.integers(counts)
    if len(sizes) and (int(sizes.min()) < 3 or int(sizes.sum()) > len(index)):
        raise node.wrong(counts, f"3 or more each and {len(index)} in all, the number of points")
    return np.cumsum(sizes) - sizes, sizes


def _fan_sets(node: Node, index: Ints) -> Ints:
    return fans(*_runs(node, index, "fanCount"))[0].reshape(-1)


def _strip_sets(node: Node, index: Ints) -> Ints:
    starts, sizes = _runs(node, index, "stripCount")
    fan, strip = fans(starts, sizes)
    step = fan[:, 1] - starts[strip] - 1
    first = starts[strip] + step
    odd = step % 2
    return np.stack([first, first + 1 + odd, first + 2 - odd], axis=1).reshape(-1)


_SETS = {
    "TriangleSet": _triangles,
    "IndexedTriangleSet": _triangles,
    "QuadSet": _quads,
    "IndexedQuadSet": _quads,
    "TriangleFanSet": _fan_sets,
    "IndexedTriangleFanSet": _fan_sets,
    "TriangleStripSet": _strip_sets,
    "IndexedTriangleStripSet": _strip_sets,
}
FACE_SETS = frozenset(_SETS)
