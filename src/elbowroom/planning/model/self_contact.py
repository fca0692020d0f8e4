"""Which postures of an arm run into the avatar's own trunk.

The paper does not look at the avatar's own body. A graph for any build of avatar needs a little of it, or a bulky one
would fold its arms through its chest: with the waist at rest, forearm and hand stay out of torso, neck and head. It
holds for the vertices of an activity graph and for the random new ones; the upper arm is rooted in the trunk, always
touches it, and is not looked at.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, inner_exact_kernel

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

FOREARM = 1  # the arm's capsules from here on are looked at
_SKIN = 0.02  # metres: capsules wrap the mesh generously, contact of their rims is no contact of bodies


def allowed_distances(
    hanging: Floats32, radii: NDArray[np.float32], trunk: Floats, trunk_radii: NDArray[np.float32]
) -> Floats:
    """How near an arm's axes may come to the trunk's, metres, shape (C, K).

    `hanging` (C, 6, 1) are the hanging arm's capsules, `trunk` (K, 6) the trunk's, all in the chest frame. A pair may
    overlap by 2 cm, or as much as it does when the arm hangs: some builds leave it no choice.
    """
    touching = (radii[:, None] + trunk_radii).astype(np.float64)
    at_rest = np.array([[axis_distance(arm, row) for row in trunk] for arm in hanging[:, :, 0].astype(np.float64)])
    allowed: Floats = np.minimum(at_rest.reshape(touching.shape), touching) - _SKIN
    return allowed


@exact_kernel
def clear_of_trunk(segments: Floats32, trunk: Floats, allowed: Floats) -> NDArray[np.bool_]:
    """Whether forearm and hand keep the allowed distances (C, K) from the trunk, for capsules (C, 6, N): shape (N,)."""
    clear, axis = np.empty(segments.shape[2], np.bool_), np.empty(6)
    for n in range(segments.shape[2]):
        clear[n] = is_clear_of_trunk(segments, n, trunk, allowed, axis)
    return clear


@inner_exact_kernel
def is_clear_of_trunk(segments: Floats32, n: int, trunk: Floats, allowed: Floats, axis: Floats) -> bool:
    """`clear_of_trunk` of capsules `n` alone; `axis` (6,) is scratch."""
    for c in range(FOREARM, segments.shape[0]):
        for i in range(6):
            axis[i] = segments[c, i, n]
        for k in range(trunk.shape[0]):
            if axis_distance(axis, trunk[k]) < allowed[c, k]:
                return False
    return True


@exact_kernel
def axis_distance(first: Floats, second: Floats) -> float:
    """Distance of two segments, rows ax, ay, az, bx, by, bz.

    The clamped closest points of C. Ericson, "Real-Time Collision Detection" (2005), section 5.1.9.
    """
    uu, uv, vv, uw, vw = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        u, v, w = first[3 + i] - first[i], second[3 + i] - second[i], first[i] - second[i]
        uu, uv, vv, uw, vw = uu + u * u, uv + u * v, vv + v * v, uw + u * w, vw + v * w
    determinant = uu * vv - uv * uv
    s = 0.0
    if determinant > 1e-12 * uu * vv:
        s = min(max((uv * vw - vv * uw) / determinant, 0.0), 1.0)
    t = (uv * s + vw) / max(vv, 1e-18)
    if t < 0.0 or t > 1.0 or vv < 1e-18:
        t = min(max(t, 0.0), 1.0)
        s = min(max((uv * t - uw) / max(uu, 1e-18), 0.0), 1.0)
    total = 0.0
    for i in range(3):
        u, v, w = first[3 + i] - first[i], second[3 + i] - second[i], first[i] - second[i]
        total += (w + s * u - t * v) ** 2
    return math.sqrt(total)
