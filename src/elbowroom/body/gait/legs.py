"""Two-bone inverse kinematics: from foot poses to the rotations of thigh, shin, foot and toes."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import carried_hip, hips_turn
from elbowroom.body.root import WITH_FEET
from elbowroom.body.skeleton import Skeleton
from elbowroom.jit import brief_kernel, helper, inner_kernel

Floats = NDArray[np.float64]

_SPLAY = 1.2  # radians for each leg length that the hips go back: the knees of a crouch open, or thighs would touch
_SOFT = 0.004  # of the leg: from here on a straightening knee slows down

LEG_ROTATIONS = 4  # thigh, shin, foot, toes


def leg_rest(skeleton: Skeleton) -> Floats:
    """T-pose of the legs for the kernel, (2, 9): hip joint, hip to knee, knee to ankle."""
    at = dict(zip(skeleton.names, skeleton.positions, strict=True))
    rows = []
    for side in ("left", "right"):
        hip, knee, ankle = at[f"{side}UpperLeg"], at[f"{side}LowerLeg"], at[f"{side}Foot"]
        rows.append([*hip, *(knee - hip), *(ankle - knee)])
    return np.array(rows)


@helper
def _soft_reach(distance: float, length: float) -> float:
    """`distance`, approaching `length` exponentially: the knee does not snap when the leg straightens."""
    soft = _SOFT * length
    beyond = distance - (length - soft)
    return distance if beyond <= 0.0 else length - soft * np.exp(-beyond / soft)


@inner_kernel
def _bone_basis(x: float, y: float, z: float, nx: float, ny: float, nz: float, out: Floats) -> None:
    """Columns: the bone's direction, the knee axis made perpendicular to it, and their cross product."""
    length = np.sqrt(x * x + y * y + z * z)
    x, y, z = x / length, y / length, z / length
    dot = x * nx + y * ny + z * nz
    nx, ny, nz = nx - dot * x, ny - dot * y, nz - dot * z
    length = np.sqrt(nx * nx + ny * ny + nz * nz)
    nx, ny, nz = nx / length, ny / length, nz / length
    out[0, 0], out[1, 0], out[2, 0] = x, y, z
    out[0, 1], out[1, 1], out[2, 1] = nx, ny, nz
    out[0, 2], out[1, 2], out[2, 2] = y * nz - z * ny, z * nx - x * nz, x * ny - y * nx


@inner_kernel
def _turn_between(rest: Floats, posed: Floats, m: Floats, out: Floats) -> None:
    """The quaternion of `posed rest^T`; rotations of a leg stay well below a half turn. `m` (3, 3) is scratch."""
    for i in range(3):
        for j in range(3):
            m[i, j] = posed[i, 0] * rest[j, 0] + posed[i, 1] * rest[j, 1] + posed[i, 2] * rest[j, 2]
    w = 0.5 * np.sqrt(max(1.0 + m[0, 0] + m[1, 1] + m[2, 2], 1e-6))
    out[0] = (m[2, 1] - m[1, 2]) / (4.0 * w)
    out[1] = (m[0, 2] - m[2, 0]) / (4.0 * w)
    out[2] = (m[1, 0] - m[0, 1]) / (4.0 * w)
    out[3] = w


@inner_kernel
def _relative(a: Floats, b: Floats, out: Floats) -> None:
    """The quaternion `a^-1 b`."""
    out[0] = a[3] * b[0] - a[0] * b[3] - a[1] * b[2] + a[2] * b[1]
    out[1] = a[3] * b[1] + a[0] * b[2] - a[1] * b[3] - a[2] * b[0]
    out[2] = a[3] * b[2] - a[0] * b[1] + a[1] * b[0] - a[2] * b[3]
    out[3] = a[3] * b[3] + a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@brief_kernel
def leg_rotations(rest: Floats, feet: Floats, sinks: Floats, rows: Floats) -> Floats:
    """Normalised local rotations (N, 2, 4, 4) of thigh, shin, foot and toes; left leg first.

    `rest` (2, 9) from `leg_rest`; `feet` (N, 2, 6) from `gait.foot_poses`; `sinks` (N, 3) from `gait.hips_sinks`. The
    knee bends forward, in the plane through hip and ankle that turns by half the foot's yaw, and outward as the hips
    go back in a crouch. A target out of reach is approached straight. Legs hang on hips as `rows` (N, 7 or more) carry
    them (`carriage`).
    """
    out = np.empty((len(feet), 2, LEG_ROTATIONS, 4))
    at_rest, posed, scratch = np.empty((2, 2, 3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for side in range(2):
        for bone in range(2):
            x, y, z = rest[side, 3 + 3 * bone], rest[side, 4 + 3 * bone], rest[side, 5 + 3 * bone]
            _bone_basis(x, y, z, 1.0, 0.0, 0.0, at_rest[side, bone])
    thigh, shin, foot, hips, carried = np.empty(4), np.empty(4), np.empty(4), np.empty(4), rows.shape[1] > WITH_FEET
    for n in range(len(feet)):
        lean = sinks[n, 2]
        turned = carried or lean > 0.0
        if turned:
            hips[0], hips[1], hips[2], hips[3] = hips_turn(rows[n], lean)
        for side in range(2):
            r, f = rest[side], feet[n, side]
            upper = np.sqrt(r[3] * r[3] + r[4] * r[4] + r[5] * r[5])
            lower = np.sqrt(r[6] * r[6] + r[7] * r[7] + r[8] * r[8])
            x, y, z = carried_hip(rest, rows[n], lean, side)
            dx, dy, dz = f[0] - x, f[1] - y + sinks[n, 0], f[2] - z + sinks[n, 1]
            distance = np.sqrt(dx * dx + dy * dy + dz * dz)
            dx, dy, dz = dx / distance, dy / distance, dz / distance
            reach = _soft_reach(max(distance, abs(upper - lower) + 0.05 * upper), upper + lower)
            cosine = (upper * upper + reach * reach - lower * lower) / (2.0 * upper * reach)
            sine = np.sqrt(max(1.0 - cosine * cosine, 0.0))
            outward = _SPLAY * sinks[n, 1] / (upper + lower)
            plane = 0.5 * f[3] + (outward if side == 0 else -outward)
            nx, ny, nz = np.cos(plane), 0.0, -np.sin(plane)
            _bone_basis(dx, dy, dz, nx, ny, nz, posed)
            ax, ay, az = posed[0, 2], posed[1, 2], posed[2, 2]
            nx, ny, nz = posed[0, 1], posed[1, 1], posed[2, 1]
            # direction x knee axis points forward for a hanging leg: (0,-1,0) x (1,0,0) = (0,0,1)
            kx, ky, kz = cosine * dx + sine * ax, cosine * dy + sine * ay, cosine * dz + sine * az
            _bone_basis(kx, ky, kz, nx, ny, nz, posed)
            _turn_between(at_rest[side, 0], posed, scratch, thigh)
            _bone_basis(reach * dx - upper * kx, reach * dy - upper * ky, reach * dz - upper * kz, nx, ny, nz, posed)
            _turn_between(at_rest[side, 1], posed, scratch, shin)
            cy, sy, cp, sp = np.cos(0.5 * f[3]), np.sin(0.5 * f[3]), np.cos(0.5 * f[4]), np.sin(0.5 * f[4])
            foot[0], foot[1], foot[2], foot[3] = cy * sp, sy * cp, -sy * sp, cy * cp
            if turned:
                _relative(hips, thigh, out[n, side, 0])
            else:
                for i in range(4):
                    out[n, side, 0, i] = thigh[i]
            _relative(thigh, shin, out[n, side, 1])
            _relative(shin, foot, out[n, side, 2])
            out[n, side, 3, 0], out[n, side, 3, 1] = np.sin(0.5 * f[5]), 0.0
            out[n, side, 3, 2], out[n, side, 3, 3] = 0.0, np.cos(0.5 * f[5])
    return out
