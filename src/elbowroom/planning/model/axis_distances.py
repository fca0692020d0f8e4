"""Distances of capsules' axes from each other, in batches, float32: lanes are postures.

The closest points of two segments by one clamped alternation, without a branch: the best place on the first line for
the second, the best on the second for that, clamped, and the best on the first for that (after C. Ericson, "Real-Time
Collision Detection" (2005), section 5.1.9). For segments up to a metre apart the rounding stays below 1e-5 m.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import brief_kernel, helper, inner_kernel, kernel

Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

_ZERO: Any = np.float32(0.0)  # single precision on purpose: a bare 0.0 would widen the whole loop
_ONE: Any = np.float32(1.0)
_TINY: Any = np.float32(1e-12)
_INFINITE: Any = np.float32(np.inf)

Vector = tuple[float, float, float]


@helper
def _distance(a: Vector, u: Vector, b: Vector, v: Vector) -> Any:
    """Distance of the segments a + s u and b + t v, s and t in [0, 1]."""
    w = (a[0] - b[0], a[1] - b[1], a[2] - b[2])
    uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2] + _TINY
    vv = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + _TINY
    uv = u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
    uw = u[0] * w[0] + u[1] * w[1] + u[2] * w[2]
    vw = v[0] * w[0] + v[1] * w[1] + v[2] * w[2]
    s = min(max((uv * vw - vv * uw) / max(uu * vv - uv * uv, _TINY), _ZERO), _ONE)
    t = min(max((uv * s + vw) / vv, _ZERO), _ONE)
    s = min(max((uv * t - uw) / uu, _ZERO), _ONE)
    x, y, z = w[0] + s * u[0] - t * v[0], w[1] + s * u[1] - t * v[1], w[2] + s * u[2] - t * v[2]
    return math.sqrt(x * x + y * y + z * z)


@inner_kernel
def lower_to_axis(lanes: Floats32, other: Floats32, allowed: float, out: Floats32) -> None:
    """out[i] = min(out[i], distance of lane i from the one other axis (6,) - allowed); lanes (6, n)."""
    ax, ay, az, bx, by, bz = lanes[0], lanes[1], lanes[2], lanes[3], lanes[4], lanes[5]
    b = (other[0], other[1], other[2])
    v = (other[3] - other[0], other[4] - other[1], other[5] - other[2])
    for i in range(np.uint64(out.shape[0])):
        a, u = (ax[i], ay[i], az[i]), (bx[i] - ax[i], by[i] - ay[i], bz[i] - az[i])
        out[i] = min(out[i], _distance(a, u, b, v) - allowed)


@brief_kernel
def lower_to_body(segments: Floats32, body: Floats32, allowed: Floats32, chosen: Bools, out: Floats32) -> None:
    """Lower `out` (N,) to the least distance beyond what is allowed (C, K).

    Of postures (C, 6, N) from the `chosen` (K,) of the parts `body` (K, 6). Pairs with less than -1 m allowed are not
    looked at.
    """
    for c in range(segments.shape[0]):
        for k in range(body.shape[0]):
            if chosen[k] and allowed[c, k] > -_ONE:
                lower_to_axis(segments[c], body[k], allowed[c, k], out)


@kernel
def clear_pairs(first: Floats32, second: Floats32) -> Floats32:
    """Distances (N,) of N pairs of axes (6, N)."""
    out = np.empty(first.shape[1], np.float32)
    ax, ay, az, bx, by, bz = first[0], first[1], first[2], first[3], first[4], first[5]
    cx, cy, cz, dx, dy, dz = second[0], second[1], second[2], second[3], second[4], second[5]
    for i in range(np.uint64(out.shape[0])):
        a, u = (ax[i], ay[i], az[i]), (bx[i] - ax[i], by[i] - ay[i], bz[i] - az[i])
        b, v = (cx[i], cy[i], cz[i]), (dx[i] - cx[i], dy[i] - cy[i], dz[i] - cz[i])
        out[i] = _distance(a, u, b, v)
    return out


@kernel
def pair_clearances(
    capsules: Floats32, first: Indices, second: Indices, kinds: Indices, allowed: Floats32, count: int
) -> Floats32:
    """The least distance beyond what is allowed (count, N) of the pairs of each kind.

    Pair p are the axes `first[p]` and `second[p]` of `capsules` (C, 6, N), of kind `kinds[p]` below `count`; they may
    come as near as `allowed[p]`.
    """
    out = np.full((count, capsules.shape[2]), _INFINITE, np.float32)
    for p in range(first.shape[0]):
        gaps = clear_pairs(capsules[first[p]], capsules[second[p]])
        target, least = out[kinds[p]], allowed[p]
        for n in range(np.uint64(gaps.shape[0])):
            target[n] = min(target[n], gaps[n] - least)
    return out


@kernel
def arm_clearances(left: Floats32, right: Floats32, allowed: Floats32) -> Floats32:
    """The least distance beyond what is allowed (C, C) of each left (C, 6, L) from each right (C, 6, R): (L, R)."""
    out, body = np.empty((left.shape[2], right.shape[2]), np.float32), np.empty((left.shape[0], 6), np.float32)
    chosen = np.empty(left.shape[0], np.bool_)
    out[:], chosen[:] = _INFINITE, True
    turned = np.empty((allowed.shape[1], allowed.shape[0]), np.float32)
    for i in range(allowed.shape[0]):
        for j in range(allowed.shape[1]):
            turned[j, i] = allowed[i, j]
    for i in range(left.shape[2]):
        for c in range(left.shape[0]):
            for j in range(6):
                body[c, j] = left[c, j, i]
        lower_to_body(right, body, turned, chosen, out[i])
    return out
