"""Shirt, trousers and shoes as clay, and the bare trunk that they cover."""

import numpy as np

from make_stock_avatar.fields import Array, chain, common, ellipsoid, mirrored, normals, round_cone, union
from make_stock_avatar.loft import Row, between, loft
from make_stock_avatar.polygonise import Mesh, drawn_to

# y, half-widths in x and z, centre in x and z
_TRUNK: tuple[Row, ...] = (
    (0.840, 0.1560, 0.1040, 0.0, -0.010),
    (0.900, 0.1640, 0.1100, 0.0, -0.012),
    (0.960, 0.1560, 0.1060, 0.0, -0.008),
    (1.020, 0.1420, 0.0960, 0.0, 0.000),
    (1.090, 0.1320, 0.0890, 0.0, 0.003),
    (1.160, 0.1370, 0.0930, 0.0, 0.002),
    (1.240, 0.1500, 0.1030, 0.0, 0.000),
    (1.310, 0.1580, 0.1060, 0.0, -0.003),
    (1.370, 0.1500, 0.0960, 0.0, -0.009),
    (1.415, 0.1230, 0.0800, 0.0, -0.014),
    (1.450, 0.0820, 0.0640, 0.0, -0.018),
    (1.480, 0.0560, 0.0540, 0.0, -0.016),
)

_SLEEVE: tuple[Row, ...] = (
    (0.060, 0.0480, 0.0600, 1.386, -0.018),
    (0.110, 0.0520, 0.0610, 1.390, -0.017),
    (0.165, 0.0540, 0.0590, 1.395, -0.015),
    (0.220, 0.0520, 0.0560, 1.397, -0.014),
    (0.320, 0.0545, 0.0570, 1.398, -0.014),
)

_LEG: tuple[Row, ...] = (
    (0.060, 0.0540, 0.0620, 0.0970, -0.008),
    (0.100, 0.0505, 0.0590, 0.0965, -0.012),
    (0.180, 0.0480, 0.0535, 0.0955, -0.017),
    (0.260, 0.0525, 0.0590, 0.0950, -0.019),
    (0.350, 0.0580, 0.0660, 0.0945, -0.017),
    (0.420, 0.0600, 0.0650, 0.0935, -0.008),
    (0.495, 0.0575, 0.0625, 0.0925, 0.003),
    (0.560, 0.0660, 0.0690, 0.0920, 0.005),
    (0.650, 0.0745, 0.0780, 0.0905, 0.003),
    (0.740, 0.0825, 0.0880, 0.0895, -0.001),
    (0.830, 0.0860, 0.0980, 0.0880, -0.006),
    (0.900, 0.0860, 0.1000, 0.0850, -0.008),
)

HEM = 0.935  # y of the shirt's lower edge, metres
SLEEVE_END = 0.298  # x of the left sleeve's edge, metres
CUFF = 0.088  # y of the trousers' lower edge, metres
TURN_UP = 0.124  # y of the upper edge of the trousers' turn-ups, metres
SLEEVE_BAND = 0.276  # x at which the left sleeve's band begins, metres


def trunk(p: Array, grow: float = 0.0) -> Array:
    return loft(p, 1, _TRUNK, grow, power=2.3)


def shirt(p: Array) -> Array:
    q = mirrored(p)
    sleeve = common(loft(q, 0, _SLEEVE), between(q[:, 0], -0.05, SLEEVE_END), 0.012)
    flare = 0.010 + 0.012 * np.clip((1.02 - q[:, 1]) / 0.12, 0.0, 1.0)
    body = loft(q, 1, _TRUNK, 0.0, power=2.3) - flare
    body = union(body, sleeve, 0.055)
    body = common(body, q[:, 1] - _neckline(p), 0.012)
    return common(body, HEM - q[:, 1], 0.014)


def _neckline(p: Array) -> Array:
    """Height of the collar's middle, lower in front."""
    return np.asarray(1.4510 - 0.26 * (p[:, 2] + 0.02))


def collar(p: Array) -> Array:
    """The ribbed band around the neck."""
    height = p[:, 1] - _neckline(p)
    ring = np.sqrt((p[:, 0] / 1.05) ** 2 + (p[:, 2] + 0.019) ** 2) - 0.0550 + 0.45 * height
    return np.asarray((np.abs(ring / 0.0055) ** 2.4 + np.abs(height / 0.0110) ** 2.4) ** (1 / 2.4) - 1.0) * 0.0055


def collar_mesh(around: int = 44, across: int = 9) -> Mesh:
    """The collar as a closed ring of `around` by `across` points."""
    turn = np.repeat(np.arange(around) * 2.0 * np.pi / around, across)
    tilt = np.tile(np.arange(across) * 2.0 * np.pi / across, around)
    radius = 0.0550 + 0.006 * np.cos(tilt)
    points = np.column_stack([1.05 * radius * np.sin(turn), np.zeros(len(turn)), radius * np.cos(turn) - 0.019])
    points[:, 1] = _neckline(points) + 0.011 * np.sin(tilt)
    points = drawn_to(collar, points, 0.01, steps=6)
    i = np.arange(around * across).reshape(around, across)
    right, up = np.roll(i, -1, axis=0), np.roll(i, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    quads = np.stack([i, right, both, up], axis=-1).reshape(-1, 4)
    return Mesh(points, normals(collar, points), np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))


def trousers(p: Array) -> Array:
    q = mirrored(p)
    turn_up = 0.0035 * np.clip((TURN_UP + 0.006 - q[:, 1]) / 0.008, 0.0, 1.0)
    leg = loft(q, 1, _LEG) - turn_up
    leg = common(leg, q[:, 1] - 0.90, 0.06)
    pelvis = common(trunk(q, 0.004), between(q[:, 1], 0.825, 1.04), 0.05)
    seat = ellipsoid(q, (0.062, 0.875, -0.058), (0.080, 0.085, 0.066))
    body = union(union(leg, pelvis, 0.05), seat, 0.04)
    return common(body, CUFF - q[:, 1], 0.014)


_SHOE: tuple[Row, ...] = (
    (-0.085, 0.0300, 0.0450, 0.0960, 0.040),
    (-0.060, 0.0370, 0.0500, 0.0960, 0.044),
    (-0.010, 0.0400, 0.0500, 0.0965, 0.044),
    (0.040, 0.0430, 0.0440, 0.0990, 0.038),
    (0.090, 0.0480, 0.0380, 0.1020, 0.030),
    (0.130, 0.0490, 0.0350, 0.1030, 0.026),
    (0.165, 0.0430, 0.0330, 0.1010, 0.024),
    (0.200, 0.0300, 0.0300, 0.0980, 0.022),
)


def _last(q: Array, grow: float) -> Array:
    """The shoe's outline, rounded at heel and toe."""
    body = loft(q, 2, _SHOE, grow, power=2.4)
    heel = np.sqrt(((q[:, 0] - 0.096) * 0.9) ** 2 + (q[:, 2] + 0.036) ** 2) - 0.042 - grow
    toe = np.sqrt(((q[:, 0] - 0.100) * 0.95) ** 2 + (q[:, 2] - 0.132) ** 2) - 0.049 - grow
    middle = between(q[:, 2], -0.036, 0.132)
    return common(body, np.minimum(np.minimum(heel, toe), middle), 0.010)


def shoe(p: Array) -> Array:
    q = mirrored(p)
    ankle = round_cone(q, (0.096, 0.060, -0.022), (0.096, 0.125, -0.016), 0.044, 0.040)
    tongue = chain(q, [(0.097, 0.088, 0.012), (0.099, 0.066, 0.062)], (0.026, 0.024))
    upper = union(union(_last(q, 0.0), ankle, 0.03), tongue, 0.03)
    upper = common(upper, q[:, 1] - 0.130, 0.015)
    return common(upper, 0.004 - q[:, 1], 0.006)


def sole(p: Array) -> Array:
    q = mirrored(p)
    rise = 0.008 * np.clip((q[:, 2] - 0.12) / 0.06, 0.0, 1.0) ** 2
    return common(_last(q, 0.0045), between(q[:, 1], rise * 0.6, 0.027 + rise), 0.010)
