"""Cells of a grid that lie within a closed surface, and boxes made of them."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_SHRUNK = 2e-5  # metres: by which a cell is taken to be smaller, so that a face in its side does not touch it
_OFF = (0.5137, 0.4871)  # where in a column the line is along which it is crossed: not where edges use to lie


@exact_kernel
def filled_cells(corners: Floats, x: Floats, y: Floats, z: Floats) -> Bools:
    """Which cells between the planes `x` (X+1,), `y`, `z` lie within a closed surface (T, 3, 3) and are not touched."""
    shape = (x.shape[0] - 1, y.shape[0] - 1, z.shape[0] - 1)
    touched, winds = np.zeros(shape, np.bool_), np.zeros((shape[0], shape[1], shape[2] + 1), np.int64)
    for t in range(corners.shape[0]):
        _touch(corners[t], x, y, z, touched)
        _cross(corners[t], x, y, z, winds)
    inside = np.zeros(shape, np.bool_)
    for i in range(shape[0]):
        for j in range(shape[1]):
            wound = 0
            for k in range(shape[2]):
                wound += winds[i, j, k]
                inside[i, j, k] = wound > 0 and not touched[i, j, k]
            if wound + winds[i, j, shape[2]] != 0:  # the surface is not closed there
                inside[i, j, :] = False
    return inside


@inner_exact_kernel
def _first_cell(planes: Floats, value: float) -> int:
    """The cell in which a coordinate is; the first or the last where it is in none."""
    found = np.searchsorted(planes, value, "right") - 1
    return int(min(max(found, 0), planes.shape[0] - 2))


@helper
def _touch(corner: Floats, x: Floats, y: Floats, z: Floats, touched: Bools) -> None:
    """Note the cells that a triangle (3, 3) may touch: by the box round it and by its plane."""
    low, high = np.empty(3), np.empty(3)
    for i in range(3):
        low[i] = min(corner[0, i], corner[1, i], corner[2, i])
        high[i] = max(corner[0, i], corner[1, i], corner[2, i])
    normal = np.cross(corner[1] - corner[0], corner[2] - corner[0])
    normal /= max(np.sqrt((normal * normal).sum()), 1e-30)
    offset = (normal * corner[0]).sum()
    for i in range(_first_cell(x, low[0]), _first_cell(x, high[0]) + 1):
        for j in range(_first_cell(y, low[1]), _first_cell(y, high[1]) + 1):
            for k in range(_first_cell(z, low[2]), _first_cell(z, high[2]) + 1):
                hx, hy, hz = 0.5 * (x[i + 1] - x[i]), 0.5 * (y[j + 1] - y[j]), 0.5 * (z[k + 1] - z[k])
                cx, cy, cz = x[i] + hx, y[j] + hy, z[k] + hz
                hx, hy, hz = hx - _SHRUNK, hy - _SHRUNK, hz - _SHRUNK
                if (
                    low[0] < cx + hx and high[0] > cx - hx
                    and low[1] < cy + hy and high[1] > cy - hy
                    and low[2] < cz + hz and high[2] > cz - hz
                ):  # fmt: skip
                    reach = abs(normal[0]) * hx + abs(normal[1]) * hy + abs(normal[2]) * hz
                    if abs(normal[0] * cx + normal[1] * cy + normal[2] * cz - offset) < reach:
                        touched[i, j, k] = True


@inner_exact_kernel
def _side(px: float, py: float, qx: float, qy: float, x: float, y: float) -> bool:
    """On which side of a line from p to q a point is: the opposite one for the line from q to p, also on the line."""
    if px < qx or (px == qx and py < qy):
        return (qx - px) * (y - py) - (qy - py) * (x - px) >= 0.0
    return not (px - qx) * (y - qy) - (py - qy) * (x - qx) >= 0.0


@helper
def _cross(corner: Floats, x: Floats, y: Floats, z: Floats, winds: Longs) -> None:
    """Note where the lines in the columns of cells cross a triangle, and which way."""
    a, b, c = corner[0], corner[1], corner[2]
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    if area == 0.0:
        return
    for i in range(_first_cell(x, min(a[0], b[0], c[0])), _first_cell(x, max(a[0], b[0], c[0])) + 1):
        u = x[i] + _OFF[0] * (x[i + 1] - x[i])
        for j in range(_first_cell(y, min(a[1], b[1], c[1])), _first_cell(y, max(a[1], b[1], c[1])) + 1):
            v = y[j] + _OFF[1] * (y[j + 1] - y[j])
            one = _side(a[0], a[1], b[0], b[1], u, v)
            if one != _side(b[0], b[1], c[0], c[1], u, v) or one != _side(c[0], c[1], a[0], a[1], u, v):
                continue
            s = ((u - a[0]) * (c[1] - a[1]) - (v - a[1]) * (c[0] - a[0])) / area
            t = ((b[0] - a[0]) * (v - a[1]) - (b[1] - a[1]) * (u - a[0])) / area
            height = a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2])
            k = 0  # the first cell whose middle is higher
            while k < z.shape[0] - 1 and 0.5 * (z[k] + z[k + 1]) <= height:
                k += 1
            winds[i, j, k] += -1 if one else 1


@exact_kernel
def boxes_in(inside: Bools) -> Longs:
    """The cells as boxes (N, 6): the first cell along each axis, and the one after the last. `inside` is used up."""
    found, count = np.empty((64, 6), np.int64), 0
    for i in range(inside.shape[0]):
        for j in range(inside.shape[1]):
            for k in range(inside.shape[2]):
                if not inside[i, j, k]:
                    continue
                if count == found.shape[0]:
                    found = np.concatenate((found, np.empty_like(found)))
                own = found[count]
                own[0], own[1], own[2], own[3], own[4], own[5] = i, j, k, i + 1, j + 1, k + 1
                while own[5] < inside.shape[2] and inside[i, j, own[5]]:
                    own[5] += 1
                while own[4] < inside.shape[1] and inside[i, own[4], k : own[5]].all():
                    own[4] += 1
                while own[3] < inside.shape[0] and inside[own[3], j : own[4], k : own[5]].all():
                    own[3] += 1
                inside[i : own[3], j : own[4], k : own[5]] = False
                count += 1
    return found[:count].copy()
