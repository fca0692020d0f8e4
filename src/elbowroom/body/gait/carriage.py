"""How a body that is shown carries its hips, chest and head: a little off the planned pose, as people do who walk.

Behind the feet of a row stand CARRIAGE numbers. Ten of them pose the body: how far the hips are to the left, above and
ahead of where they were planned, how far they are turned and their left side is raised; how far the chest is turned,
its left side raised, and bent; how far the head is turned and nods. The hips turn about the middle between the joints
of the legs; chest and head are told from where they were planned, so neither follows the hips, nor the head the chest.
The other three are what `living` remembers. Legs reach from the carried hips to the same feet.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import WITH_FEET
from elbowroom.jit import inner_kernel, kernel

Floats = NDArray[np.float64]
Quaternion = tuple[float, float, float, float]

# Places in a row: metres in the root's axes, and radians.
ASIDE, UP, AHEAD, TURN, LIST = WITH_FEET, WITH_FEET + 1, WITH_FEET + 2, WITH_FEET + 3, WITH_FEET + 4
CHEST_TURN, CHEST_LIST, CHEST_BEND = WITH_FEET + 5, WITH_FEET + 6, WITH_FEET + 7
HEAD_TURN, HEAD_NOD = WITH_FEET + 8, WITH_FEET + 9
OF_HIPS, POSING = 5, 10  # so many of the numbers move the hips, and so many pose anything


@inner_kernel
def _turned(turn: float, raised: float) -> Quaternion:
    """Ry(turn) Rz(raised)."""
    cy, sy, cz, sz = math.cos(0.5 * turn), math.sin(0.5 * turn), math.cos(0.5 * raised), math.sin(0.5 * raised)
    return sy * sz, sy * cz, cy * sz, cy * cz


@kernel
def _times(a: Quaternion, b: Quaternion) -> Quaternion:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


@inner_kernel
def about_left(angle: float) -> Quaternion:
    """A rotation about the axis to the left."""
    return math.sin(0.5 * angle), 0.0, 0.0, math.cos(0.5 * angle)


@inner_kernel
def hips_turn(row: Floats, lean: float) -> Quaternion:
    """What hips that lean forward by `lean` are turned by in the root's axes, `xyzw`, carried as a row says or not."""
    leaning = about_left(lean)
    return leaning if row.shape[0] <= WITH_FEET else _times(_turned(row[TURN], row[LIST]), leaning)


@inner_kernel
def carried_turns(row: Floats, lean: float) -> tuple[Quaternion, Quaternion]:
    """What a row (SHOWN,) turns the lowest joint of the spine and the lowest joint of the neck by, `xyzw`.

    Each is a rotation in the axes of the joint above, and goes before what the posture turns the joint by. The hips
    lean forward by `lean` radians, which takes the spine along.
    """
    hips, leaning = hips_turn(row, lean), about_left(lean)
    chest = _times(_turned(row[CHEST_TURN], row[CHEST_LIST]), about_left(row[CHEST_BEND]))
    head = _times(_turned(row[HEAD_TURN], 0.0), about_left(row[HEAD_NOD]))
    back = (-hips[0], -hips[1], -hips[2], hips[3])
    level = (-chest[0], -chest[1], -chest[2], chest[3])
    return _times(back, _times(chest, leaning)), _times(head, level)


@inner_kernel
def leant_by(lean: float, up: float, ahead: float) -> tuple[float, float]:
    """How far up and ahead a point moves, metres, as hips lean: it is `up`, `ahead` of the middle of the hip joints."""
    sine, cosine = math.sin(lean), math.cos(lean)
    return cosine * up - sine * ahead - up, sine * up + cosine * ahead - ahead


@inner_kernel
def shifted_by(row: Floats, lean: float, x: float, up: float, ahead: float) -> tuple[float, float, float]:
    """How far a row (SHOWN,) moves a point of the hips that is `x`, `up`, `ahead` of the middle of the hip joints.

    Metres in the root's axes, with hips that lean forward by `lean` radians. A row without carriage does nothing more.
    """
    rises, goes = leant_by(lean, up, ahead)
    if row.shape[0] <= WITH_FEET:
        return 0.0, rises, goes
    y, z = up + rises, ahead + goes
    a, b, c, w = _turned(row[TURN], row[LIST])
    tx, ty, tz = 2.0 * (b * z - c * y), 2.0 * (c * x - a * z), 2.0 * (a * y - b * x)
    return (
        row[ASIDE] + w * tx + b * tz - c * ty,
        row[UP] + rises + w * ty + c * tx - a * tz,
        row[AHEAD] + goes + w * tz + a * ty - b * tx,
    )


@inner_kernel
def carried_hip(legs: Floats, row: Floats, lean: float, side: int) -> tuple[float, float, float]:
    """Where a leg's joint at the hip is in the root's frame; `legs` (2, 3 or more) tell first where it is upright."""
    hip, twin = legs[side], legs[1 - side]
    x, y, z = shifted_by(row, lean, 0.5 * (hip[0] - twin[0]), 0.5 * (hip[1] - twin[1]), 0.5 * (hip[2] - twin[2]))
    return hip[0] + x, hip[1] + y, hip[2] + z
