"""Turned and tapered solids: elliptic cross-sections along an axis, as a sculptor lists them."""

from collections.abc import Sequence

import numpy as np

from make_stock_avatar.fields import Array

Row = tuple[float, float, float, float, float]  # position on the axis, two half-widths, two centre coordinates (metres)


def smooth_table(at: Array, rows: Sequence[Row]) -> Array:
    """Cubic Hermite (Catmull-Rom slopes) through the rows, constant beyond both ends, (N, 4)."""
    table = np.array(rows, float)
    keys, values = table[:, 0], table[:, 1:]
    slopes = np.gradient(values, keys, axis=0)
    slopes[[0, -1]] = 0.0
    t = np.clip(at, keys[0], keys[-1])
    i = np.clip(np.searchsorted(keys, t, side="right") - 1, 0, len(keys) - 2)
    width = keys[i + 1] - keys[i]
    u = ((t - keys[i]) / width)[:, None]
    h = width[:, None]
    return np.asarray(
        values[i] * (1 + 2 * u) * (1 - u) ** 2
        + h * slopes[i] * u * (1 - u) ** 2
        + values[i + 1] * u * u * (3 - 2 * u)
        + h * slopes[i + 1] * u * u * (u - 1)
    )


def loft(p: Array, axis: int, rows: Sequence[Row], grow: float = 0.0, power: float = 2.0) -> Array:
    """An endless tube along `axis` whose section is a (super-)ellipse in the two other axes, in x, y, z order.

    `grow` widens it by metres; `power` above 2 squares the section. Cut its ends with `between`.
    """
    first, second = (i for i in range(3) if i != axis)
    section = smooth_table(p[:, axis], rows)
    half = section[:, :2] + grow
    q = np.abs(p[:, [first, second]] - section[:, 2:]) / half
    if power == 2.0:
        k = np.sqrt((q * q).sum(axis=1))
    else:
        k = (q**power).sum(axis=1) ** (1.0 / power)
    slope = np.sqrt(((q / half) ** 2).sum(axis=1)) / np.maximum(np.sqrt((q * q).sum(axis=1)), 1e-9)
    return np.asarray((k - 1.0) / np.maximum(slope, 1e-9))


def between(at: Array, low: float | Array, high: float | Array) -> Array:
    """The slab low < at < high."""
    return np.maximum(low - at, at - high)
