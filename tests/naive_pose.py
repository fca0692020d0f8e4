"""The obvious slow forward kinematics: one quaternion after the other, straight from the conventions."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bones import PARENTS, REQUIRED
from elbowroom.body.capsules import Capsules
from elbowroom.body.skeleton import Skeleton
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]


def joint_frames(skeleton: Skeleton, local: Floats, hips: Floats, root: Floats) -> tuple[Floats, Floats]:
    """World positions (..., J, 3) and rotations (..., J, 4); `hips` (..., 3) in the root frame, `root` (..., 7)."""
    positions, rotations = np.zeros((*local.shape[:-1], 3)), np.zeros(local.shape)
    heading = quaternion.about_axis(1, root[..., 2])
    origin = root[..., :2] @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    for j, parent in enumerate(skeleton.parents):
        if parent < 0:
            positions[..., j, :] = origin + quaternion.rotate(heading, hips)
            rotations[..., j, :] = quaternion.multiply(heading, local[..., j, :])
        else:
            offset = skeleton.positions[j] - skeleton.positions[parent]
            above = rotations[..., parent, :]
            positions[..., j, :] = positions[..., parent, :] + quaternion.rotate(above, offset)
            rotations[..., j, :] = quaternion.multiply(above, local[..., j, :])
    return positions, rotations


def capsule_ends(capsules: Capsules, positions: Floats, rotations: Floats) -> Floats:
    """Rows (C, 6) of capsule end points."""
    where, how = positions[capsules.joints], rotations[capsules.joints]
    starts = where + quaternion.rotate(how, capsules.starts)
    return np.concatenate([starts, where + quaternion.rotate(how, capsules.ends)], axis=1)


def chest_rotation(waist: Floats) -> Floats:
    return quaternion.multiply(quaternion.about_axis(1, waist[1]), quaternion.about_axis(0, waist[0]))


def arm_rotations(arm: Floats, left: bool) -> tuple[Floats, Floats]:
    """Upper arm and forearm."""
    flexion, abduction, internal, elbow = arm
    side = 1.0 if left else -1.0
    swing = quaternion.from_rotation_vector([-flexion, 0.0, side * abduction])
    twist = quaternion.about_axis(1, -side * internal)
    hang = quaternion.about_axis(2, -side * np.pi / 2)
    upper = quaternion.multiply(quaternion.multiply(swing, twist), hang)
    return upper, quaternion.about_axis(1, -side * elbow)


def same_rotation(a: Floats, b: Floats) -> float:
    """The largest angle between rotations (..., 4), radians."""
    vectors = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(a), b))
    return float(np.linalg.norm(vectors, axis=-1).max())


def segment_gap(a: Floats, b: Floats) -> float:
    """Distance of two segments (6,), by dense sampling: within a millimetre or two for a body's capsules."""
    steps = np.linspace(0.0, 1.0, 40)[:, None]
    p, q = a[:3] + steps * (a[3:] - a[:3]), b[:3] + steps * (b[3:] - b[:3])
    return float(np.linalg.norm(p[:, None] - q[None], axis=-1).min())


def required_only(skeleton: Skeleton) -> Skeleton:
    """The same body with nothing but the bones that VRM requires."""
    kept = [i for i, name in enumerate(skeleton.names) if name in REQUIRED]
    names = tuple(skeleton.names[i] for i in kept)
    parents = []
    for name in names:
        parent = PARENTS[name]
        while parent is not None and parent not in names:
            parent = PARENTS[parent]
        parents.append(-1 if parent is None else names.index(parent))
    return Skeleton(names, np.array(parents), skeleton.positions[kept])
