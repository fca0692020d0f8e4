"""How a Transform moves what is in it (ISO/IEC 19775-1, 10.4.4)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.x3d.model import Node
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

TRANSFORMS = frozenset({"Transform", "HAnimHumanoid", "HAnimJoint", "HAnimSite"})
_UNIFORM = 1e-6


@dataclass(frozen=True, eq=False)
class Placing:
    """P' = T C R SR S SR^-1 C^-1 P, with T and C translations by `translation` and `center`."""

    translation: Floats  # (3,)
    center: Floats  # (3,)
    rotation: Floats  # (4,) xyzw
    scale: Floats  # (3,)
    stretch: Floats  # (4,) xyzw: the axes along which the scale acts


def placing_of(node: Node, radian: float = 1.0) -> Placing:
    """The fields of a Transform, an HAnimHumanoid, HAnimJoint or HAnimSite; angles are in units of `radian`."""
    scale = node.vector("scale", (1.0, 1.0, 1.0))
    uniform = float(np.ptp(scale)) <= _UNIFORM * float(np.abs(scale).max())
    return Placing(
        translation=node.vector("translation", (0.0, 0.0, 0.0)),
        center=node.vector("center", (0.0, 0.0, 0.0)),
        rotation=rotation_of(node, "rotation", radian),
        scale=scale,
        stretch=quaternion.IDENTITY if uniform else rotation_of(node, "scaleOrientation", radian),
    )


def rotation_of(node: Node, name: str, radian: float = 1.0) -> Floats:
    """An SFRotation (axis and angle) as a quaternion; an axis without direction turns nothing."""
    if not node.has(name):
        return quaternion.IDENTITY
    x, y, z, angle = node.vector(name, (0.0, 0.0, 1.0, 0.0))
    length = float(np.sqrt(x * x + y * y + z * z))
    if length < 1e-12:
        return quaternion.IDENTITY
    return quaternion.from_rotation_vector(np.array([x, y, z]) / length * angle * radian)
