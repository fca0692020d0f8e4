"""Short, side-swept hair as clay: a cap over the skull and locks that leave a parting on the left."""

import numpy as np

from make_stock_avatar.fields import Array, carved, chain, common, ellipsoid, mirrored, union
from make_stock_avatar.head import skull

# start, bend and end of each lock (metres), radii at start and end
Lock = tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float], float, float]

_LOCKS: tuple[Lock, ...] = (
    # fringe, swept from the parting (+X) to the right side
    ((0.034, 1.706, 0.040), (0.010, 1.712, 0.092), (-0.038, 1.668, 0.092), 0.026, 0.012),
    ((0.030, 1.712, 0.020), (-0.020, 1.726, 0.078), (-0.066, 1.664, 0.066), 0.028, 0.011),
    ((0.038, 1.702, 0.050), (0.022, 1.698, 0.092), (-0.008, 1.668, 0.100), 0.020, 0.009),
    ((0.020, 1.718, -0.010), (-0.050, 1.722, 0.040), (-0.080, 1.640, 0.036), 0.030, 0.011),
    # left of the parting
    ((0.040, 1.704, 0.040), (0.062, 1.690, 0.066), (0.072, 1.648, 0.052), 0.020, 0.010),
    ((0.036, 1.712, 0.010), (0.074, 1.694, 0.034), (0.082, 1.628, 0.026), 0.024, 0.009),
    # crown, flowing back
    ((0.010, 1.722, 0.010), (0.000, 1.742, -0.050), (-0.010, 1.690, -0.108), 0.030, 0.014),
    ((-0.030, 1.716, 0.000), (-0.050, 1.724, -0.050), (-0.050, 1.668, -0.100), 0.030, 0.014),
    ((0.036, 1.712, -0.010), (0.056, 1.716, -0.056), (0.052, 1.664, -0.100), 0.028, 0.014),
    # sides and nape
    ((-0.066, 1.672, -0.020), (-0.090, 1.640, -0.026), (-0.079, 1.588, -0.046), 0.026, 0.009),
    ((0.066, 1.672, -0.020), (0.090, 1.640, -0.026), (0.079, 1.588, -0.046), 0.026, 0.009),
    ((-0.052, 1.660, -0.078), (-0.074, 1.606, -0.078), (-0.056, 1.548, -0.062), 0.028, 0.008),
    ((0.052, 1.660, -0.078), (0.074, 1.606, -0.078), (0.056, 1.548, -0.062), 0.028, 0.008),
    ((0.004, 1.660, -0.098), (0.004, 1.590, -0.116), (0.002, 1.516, -0.076), 0.030, 0.008),
    ((-0.030, 1.655, -0.094), (-0.044, 1.590, -0.106), (-0.026, 1.520, -0.072), 0.028, 0.008),
    ((0.030, 1.655, -0.094), (0.044, 1.590, -0.106), (0.028, 1.524, -0.072), 0.028, 0.008),
)


def _lock(p: Array, lock: Lock) -> Array:
    """A tapered strand along a quadratic Bezier curve."""
    start, bend, end, thick, thin = (np.asarray(v, float) for v in lock)
    u = np.linspace(0.0, 1.0, 5)[:, None]
    curve = start * (1 - u) ** 2 + 2 * bend * u * (1 - u) + end * u * u
    radii = [float(thick * (1 - t) + thin * t) for t in np.linspace(0.0, 1.0, 5) ** 1.4]
    return chain(p, curve, radii, 0.004)


def hair(p: Array) -> Array:
    q = mirrored(p)
    cap = skull(q) - 0.0125
    cap = union(cap, ellipsoid(p, (0.0, 1.640, -0.022), (0.084, 0.096, 0.098)), 0.02)
    front = (p[:, 2] - 0.012) + 0.9 * (1.640 - p[:, 1])
    low = (1.552 - p[:, 1]) + 0.8 * (p[:, 2] + 0.060)
    cap = common(common(cap, front, 0.02), low, 0.02)
    ear = ellipsoid(q, (0.090, 1.582, -0.002), (0.034, 0.036, 0.026))
    cap = carved(cap, ear, 0.012)
    for lock in _LOCKS:
        cap = union(cap, _lock(p, lock), 0.013)
    return cap
