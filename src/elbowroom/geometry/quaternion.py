"""Unit quaternions `xyzw` (glTF, three.js, VMC), broadcast over leading axes: shape (..., 4), float64."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

IDENTITY: Floats = np.array([0.0, 0.0, 0.0, 1.0])
IDENTITY.setflags(write=False)


def multiply(a: ArrayLike, b: ArrayLike) -> Floats:
    """Hamilton product `a b`: rotate by `b` first, then by `a`."""
    ax, ay, az, aw = np.moveaxis(np.asarray(a, np.float64), -1, 0)
    bx, by, bz, bw = np.moveaxis(np.asarray(b, np.float64), -1, 0)
    return np.stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ],
        axis=-1,
    )


def conjugate(q: ArrayLike) -> Floats:
    """The inverse of a unit quaternion."""
    array: Floats = np.asarray(q, np.float64) * np.array([-1.0, -1.0, -1.0, 1.0])
    return array


def normalize(q: ArrayLike) -> Floats:
    """`q` scaled to length 1; a zero quaternion becomes the identity."""
    array = np.asarray(q, np.float64)
    length = np.linalg.norm(array, axis=-1, keepdims=True)
    return np.where(length > 1e-12, array / np.maximum(length, 1e-12), IDENTITY)


def rotate(q: ArrayLike, v: ArrayLike) -> Floats:
    """Vectors `v` (..., 3) rotated by `q` (..., 4)."""
    rotation, vector = np.asarray(q, np.float64), np.asarray(v, np.float64)
    twice = 2.0 * np.cross(rotation[..., :3], vector)
    return vector + rotation[..., 3:] * twice + np.cross(rotation[..., :3], twice)


def from_rotation_vector(vector: ArrayLike) -> Floats:
    """Exponential map: rotation vectors (..., 3) in radians to quaternions."""
    array = np.asarray(vector, np.float64)
    angle = np.linalg.norm(array, axis=-1, keepdims=True)
    return np.concatenate([0.5 * np.sinc(angle / (2.0 * np.pi)) * array, np.cos(0.5 * angle)], axis=-1)


def to_rotation_vector(q: ArrayLike) -> Floats:
    """Logarithm: the rotation vector (..., 3) of length at most pi."""
    array = np.asarray(q, np.float64)
    near = np.where(array[..., 3:] < 0.0, -array, array)
    sine = np.linalg.norm(near[..., :3], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, near[..., 3:])
    return near[..., :3] * np.where(sine > 1e-12, angle / np.maximum(sine, 1e-12), 2.0)


def about_axis(axis: int, angle: ArrayLike) -> Floats:
    """Rotations by `angle` (...) radians about a coordinate axis: 0 = X, 1 = Y, 2 = Z."""
    half = 0.5 * np.asarray(angle, np.float64)
    q = np.zeros((*half.shape, 4))
    q[..., axis], q[..., 3] = np.sin(half), np.cos(half)
    return q


def between(a: ArrayLike, b: ArrayLike) -> Floats:
    """The shortest rotation that takes direction `a` (..., 3) to direction `b` (..., 3)."""
    source, target = _direction(a), _direction(b)
    cosine = np.sum(source * target, axis=-1, keepdims=True)
    helper = np.where(np.abs(source[..., :1]) < 0.9, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    opposite = np.concatenate([np.cross(source, helper), np.zeros_like(cosine)], axis=-1)
    shortest = np.concatenate([np.cross(source, target), 1.0 + cosine], axis=-1)
    return normalize(np.where(cosine < -1.0 + 1e-9, opposite, shortest))


def _direction(v: ArrayLike) -> Floats:
    array = np.asarray(v, np.float64)
    direction: Floats = array / np.linalg.norm(array, axis=-1, keepdims=True)
    return direction


def angle_between(a: ArrayLike, b: ArrayLike) -> Floats:
    """The angle (...) in radians of the rotation from `a` to `b`, at most pi."""
    angle: Floats = np.linalg.norm(to_rotation_vector(multiply(conjugate(a), b)), axis=-1)
    return angle


def slerp(a: ArrayLike, b: ArrayLike, t: ArrayLike) -> Floats:
    """Spherical interpolation along the shorter arc; `t` (...) in [0, 1]."""
    step = to_rotation_vector(multiply(conjugate(a), b))
    return multiply(a, from_rotation_vector(np.asarray(t, np.float64)[..., None] * step))


def to_matrix(q: ArrayLike) -> Floats:
    """Rotation matrices (..., 3, 3)."""
    return np.stack([rotate(q, axis) for axis in np.eye(3)], axis=-1)


def from_matrix(matrix: ArrayLike) -> Floats:
    """Quaternions of proper rotation matrices (..., 3, 3), by the largest of the four candidates (Shepperd 1978)."""
    m = np.asarray(matrix, np.float64)
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    zy, xz, yx = m[..., 2, 1] - m[..., 1, 2], m[..., 0, 2] - m[..., 2, 0], m[..., 1, 0] - m[..., 0, 1]
    yz, zx, xy = m[..., 2, 1] + m[..., 1, 2], m[..., 0, 2] + m[..., 2, 0], m[..., 1, 0] + m[..., 0, 1]
    candidates = np.stack(
        [
            np.stack([1.0 + xx - yy - zz, xy, zx, zy], axis=-1),
            np.stack([xy, 1.0 - xx + yy - zz, yz, xz], axis=-1),
            np.stack([zx, yz, 1.0 - xx - yy + zz, yx], axis=-1),
            np.stack([zy, xz, yx, 1.0 + xx + yy + zz], axis=-1),
        ],
        axis=-2,
    )
    best = np.argmax(np.stack([xx - yy - zz, yy - xx - zz, zz - xx - yy, xx + yy + zz], axis=-1), axis=-1)
    return normalize(np.take_along_axis(candidates, best[..., None, None], axis=-2)[..., 0, :])
