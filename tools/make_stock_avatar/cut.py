"""Cuts a mesh along a smooth line, so that two materials meet in a clean border."""

import numpy as np

from make_stock_avatar.fields import Array
from make_stock_avatar.polygonise import Mesh


def cut(mesh: Mesh, values: Array) -> tuple[Mesh, Mesh]:
    """The parts of a mesh where `values` (V,), linear over each triangle, are below and above zero."""
    inside = values[mesh.triangles] < 0
    crossed = inside.any(axis=1) & ~inside.all(axis=1)
    points, normals = list(mesh.points), list(mesh.normals)
    middle: dict[tuple[int, int], int] = {}

    def crossing(a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in middle:
            low, high = key
            u = values[low] / (values[low] - values[high])
            normal = mesh.normals[low] * (1 - u) + mesh.normals[high] * u
            middle[key] = len(points)
            points.append(mesh.points[low] * (1 - u) + mesh.points[high] * u)
            normals.append(normal / np.linalg.norm(normal))
        return middle[key]

    below, above = [*mesh.triangles[inside.all(axis=1)]], [*mesh.triangles[~inside.any(axis=1)]]
    for triangle, sides in zip(mesh.triangles[crossed], inside[crossed], strict=True):
        lone = int(np.argmax(sides if sides.sum() == 1 else ~sides))  # the corner alone on its side
        a, b, c = (int(v) for v in np.roll(triangle, -lone))
        ab, ac = crossing(a, b), crossing(a, c)
        tip, rest = (below, above) if sides[lone] else (above, below)
        tip.append(np.array([a, ab, ac]))
        rest += [np.array([ab, b, c]), np.array([ab, c, ac])]
    whole = [Mesh(np.array(points), np.array(normals), np.array(half)) for half in (below, above)]
    nothing = np.zeros(len(points), bool)
    return whole[0].without(nothing), whole[1].without(nothing)
