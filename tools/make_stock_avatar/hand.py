"""The left arm and hand as clay: from inside the sleeve to five finger tips."""

import numpy as np

from make_stock_avatar.fields import Array, chain, common, ellipsoid, round_cone, union
from make_stock_avatar.loft import Row, loft
from make_stock_avatar.polygonise import Mesh, lattice, polygonise
from make_stock_avatar.rest import WRIST, finger_joints
from make_stock_avatar.simplify import simplified

# x, half-widths in y and z, centre in y and z
_ARM: tuple[Row, ...] = (
    (0.180, 0.0470, 0.0480, 1.400, -0.015),
    (0.250, 0.0440, 0.0460, 1.399, -0.014),
    (0.330, 0.0425, 0.0430, 1.399, -0.013),
    (0.400, 0.0375, 0.0385, 1.400, -0.014),
    (0.445, 0.0360, 0.0375, 1.400, -0.016),
    (0.500, 0.0375, 0.0410, 1.399, -0.013),
    (0.550, 0.0345, 0.0390, 1.399, -0.012),
    (0.620, 0.0275, 0.0325, 1.399, -0.012),
    (0.665, 0.0230, 0.0295, 1.400, -0.012),
    (0.695, 0.0215, 0.0295, 1.400, -0.012),
    (0.720, 0.0205, 0.0345, 1.400, -0.012),
    (0.750, 0.0180, 0.0415, 1.400, -0.013),
    (0.775, 0.0155, 0.0440, 1.400, -0.013),
    (0.800, 0.0130, 0.0420, 1.399, -0.013),
)

_FINGER_RADII = {
    "Index": (0.0105, 0.0098, 0.0088, 0.0076),
    "Middle": (0.0108, 0.0100, 0.0090, 0.0078),
    "Ring": (0.0105, 0.0098, 0.0088, 0.0076),
    "Little": (0.0095, 0.0088, 0.0080, 0.0068),
}


def arm(p: Array) -> Array:
    """The bare left arm with its hand."""
    limb = loft(p, 0, _ARM, power=2.0)
    limb = common(limb, np.maximum(0.245 - p[:, 0], p[:, 0] - 0.786), 0.018)
    thumb = finger_joints("Thumb")
    ball = round_cone(p, thumb[0] + [0.004, 0.0, 0.002], thumb[1], 0.0180, 0.0140)
    limb = union(limb, ball, 0.016)
    limb = union(limb, chain(p, thumb[1:], (0.0132, 0.0118, 0.0088), 0.001), 0.008)
    heel = ellipsoid(p, (0.735, 1.392, -0.036), (0.032, 0.014, 0.016))
    limb = union(limb, heel, 0.012)
    fingers = np.full(len(p), np.inf)
    for finger, radii in _FINGER_RADII.items():
        fingers = np.minimum(fingers, chain(p, finger_joints(finger), radii, 0.001))
    return union(limb, fingers, 0.009)


def _funnel(points: Array) -> Array:
    """Bends the lattice: its lines fan out along the fingers, and its cells grow towards the shoulder."""
    x = points[:, 0]
    fan = 1.0 + 0.39 * np.clip((x - 0.775) / 0.105, -0.3, 1.0)
    scale = 1.0 + 0.35 * np.clip((WRIST + 0.03 - x) / 0.12, 0.0, 1.0) + 0.25 * np.clip((0.6 - x) / 0.3, 0.0, 1.0)
    x = np.where(x < _WIDENING, _WIDENING + (x - _WIDENING) * 2.4, x)
    y = 1.395 + (points[:, 1] - 1.395) * scale
    return np.column_stack([x, y, -0.003 + (points[:, 2] + 0.003) * scale * fan])


_WIDENING = WRIST - 0.01  # x below which the cells grow longer, metres


def left_arm_mesh(points: int) -> Mesh:
    """The left arm from inside the sleeve to the finger tips, with some `points`."""
    low_x = _WIDENING - (_WIDENING - 0.235) / 2.4
    corners = lattice((low_x, 1.350, -0.070), (0.902, 1.436, 0.082), (0.0046, 0.0036, 0.0030))
    return simplified(polygonise(arm, corners, relax=3, warp=_funnel), arm, points)
