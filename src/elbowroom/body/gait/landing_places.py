"""Where feet land: under the root in the middle of their stance, each on its own side of the other."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.foot_state import SWING, VELOCITY, YAW, X, Z, rests
from elbowroom.body.gait.own_steps import OwnSteps, own_detour, own_home, own_stride_at
from elbowroom.body.gait.roll import straight_part
from elbowroom.body.gait.stride import Stride
from elbowroom.body.root import ROOT_STATE
from elbowroom.by_reference import by_reference
from elbowroom.jit import inner_exact_kernel, plain

Floats = NDArray[np.float64]

TWISTED = 0.9  # radians: a standing foot that is turned farther has to follow soon
_ALMOST = 0.999  # of a swing is all of it
_CLOSED, _TURNED = 0.012, 0.05  # metres of a standard leg, radians: feet so near their place need no step
_APART, _LONG = 0.13, 0.35  # metres of a standard leg: so far a foot keeps beside the other, if no farther ahead of it
_TOES_IN = 0.4  # radians: toes of one foot point no farther across the other
_DOWN = 0.14  # of a swing aside or round: so long it is over its place, and only comes down
_SINKS, _FALL = 0.3, 0.1  # of a swing in which a foot only comes down, where it lands so many metres lower, or more
_BOUND, _BINDING = 0.75, 0.1  # of a swing: from then on a foot goes on to where it goes, more and more
_MORE = 0.15  # m/s by which a stance may be longer than that of an even walk
# Of each foot, how it lands where ground is not a plane: so many metres farther ahead, and so many below the other
# foot, but for what falls evenly from there; and whether there, or where it stands, its heel and its ball hang in the
# air: 0 or 1.
FARTHER, LOWER, HEEL_HANGS, BALL_HANGS = map(plain, range(4))
LANDS = 4


@by_reference
class Stepper(NamedTuple):
    """Whose feet step."""

    legs: Floats  # as in `GaitShape`
    scale: float
    own: OwnSteps


@inner_exact_kernel
def worth_a_step(x: float, z: float, yaw: float, scale: float) -> float:
    """How far apart two places of a foot are: above 1 it is worth a step."""
    return float(max(np.hypot(x, z) / (_CLOSED * scale), abs(yaw) / _TURNED))


@inner_exact_kernel
def _root_later(root: Floats, coming: Floats, after: float, out: Floats) -> None:
    """Where the root will be `after` seconds from now, to `out` (7,).

    Straight from `root` (7,) through the `coming` (m, 8), seconds from now and root states; beyond, it keeps its
    velocities.
    """
    since, last = 0.0, coming.shape[0]
    for i in range(ROOT_STATE):
        out[i] = root[i]
    for n in range(last):
        if since >= after:
            break
        share = min((after - since) / max(coming[n, 0] - since, 1e-9), 1.0)
        for i in range(ROOT_STATE):
            out[i] += share * (coming[n, 1 + i] - out[i])
        since = min(coming[n, 0], after)
    left = after - since
    c, s = np.cos(out[2] + 0.5 * out[5] * left), np.sin(out[2] + 0.5 * out[5] * left)
    out[0] += left * (out[4] * c + out[3] * s)
    out[1] += left * (out[3] * c - out[4] * s)
    out[2] += left * out[5]


@inner_exact_kernel
def place_under(
    who: Stepper, side: int, root: Floats, coming: Floats, left: float, later: Floats
) -> tuple[float, float, float]:
    """Where a foot has to land in `left` seconds, or had to if that is negative: x, z and yaw seen from the root.

    Under the root in the middle of its stance, and no farther from the root than in an even walk. `coming` (m, 8) is as
    in `footholds.step_feet`; `later` (7,) is scratch.
    """
    legs, scale, own = who.legs, who.scale, who.own
    _root_later(root, coming, left, later)
    stride = own_stride_at(own, scale, later)
    half = 0.0 if rests(later) else 0.5 * stride.duty * stride.period
    x, z, heading, most = later[0], later[1], later[2], half * (stride.speed + _MORE * scale)
    _root_later(root, coming, left + half, later)
    far = np.hypot(later[0] - x, later[1] - z)
    part = min(1.0, most / max(far, 1e-9))
    later[0], later[1] = x + part * (later[0] - x), z + part * (later[1] - z)
    later[2] = heading + min(max(later[2] - heading, -TWISTED), TWISTED)
    c, s, dx, dz = np.cos(root[2]), np.sin(root[2]), later[0] - root[0], later[1] - root[1]
    left, ahead, turned = dx * c - dz * s, dx * s + dz * c, later[2] - root[2]
    x, z, yaw = own_home(own, legs, stride, side)
    c, s = np.cos(turned), np.sin(turned)
    return left + x * c + z * s, ahead - x * s + z * c, turned + yaw


@inner_exact_kernel
def beside_twin(side: int, x: float, z: float, turned: float, scale: float) -> tuple[float, float]:
    """A place (x, z) from the standing twin, moved to the own side if need be, in axes `turned` to the left."""
    c, s, outward = np.cos(turned), np.sin(turned), 1.0 if side == 0 else -1.0
    aside, along = outward * (x * c - z * s), x * s + z * c
    aside = max(aside, _APART * scale * (1.0 - min((along / (_LONG * scale)) ** 2, 1.0)))
    aside *= outward
    return aside * c + along * s, -aside * s + along * c


@inner_exact_kernel
def landing_place(
    who: Stepper, side: int, root: Floats, twin: Floats, coming: Floats, left: float, ahead: float, later: Floats
) -> tuple[float, float, float]:
    """That place so many metres farther `ahead`, moved to the own side of the twin and turned away from it, if need be.

    Arguments are those of `place_under`.
    """
    x, z, yaw = place_under(who, side, root, coming, left, later)
    x, z, outward = x + ahead * np.sin(yaw), z + ahead * np.cos(yaw), 1.0 if side == 0 else -1.0
    x, z = beside_twin(side, x - twin[X], z - twin[Z], yaw, who.scale)
    yaw = twin[YAW] + outward * max(outward * (yaw - twin[YAW]), -_TOES_IN)
    return x + twin[X], z + twin[Z], yaw


@inner_exact_kernel
def way_over(stride: Stride, lower: float) -> float:
    """The part of a swing in which a foot goes over the ground; then it only comes down.

    In steps aside and round, and where it lands so many metres lower, behind an edge.
    """
    aside = _DOWN * (1.0 - straight_part(stride))
    return 1.0 - max(aside, _SINKS * min(max(lower, 0.0) / (_FALL * stride.scale), 1.0))


@inner_exact_kernel
def borne_pitch(lands: Floats, pitch: float) -> float:
    """How far a foot is pitched that is by so much on the plane: not about what hangs in the air (LANDS,)."""
    return float(pitch * (1.0 - lands[BALL_HANGS if pitch > 0.0 else HEEL_HANGS]))


@inner_exact_kernel
def time_over(foot: Floats, way: float, left: float) -> float:
    """Seconds until a swinging foot that lands in `left` is over its place, after the part `way` of its swing."""
    return float(left * max(way - foot[SWING], 0.0) / max(1.0 - foot[SWING], 1.0 - _ALMOST))


@inner_exact_kernel
def bound_for(
    own: OwnSteps, stride: Stride, side: int, foot: Floats, goal: tuple[float, float, float], left: float, way: float
) -> tuple[float, float, float]:
    """Where a swinging foot lands in `left` seconds that should at a place (x, z, yaw).

    One that nearly has, where it was going to, but for hardly a step's worth. `way` is as in `way_over`.
    """
    share = min(max((foot[SWING] - _BOUND) / _BINDING, 0.0), 1.0)
    if share <= 0.0:
        return goal
    part, left = min(foot[SWING] / way, 1.0), time_over(foot, way, left)
    ahead = left * (1.0 + 2.0 * part) / (6.0 * part)  # what is left of an even swing, at the speed that it has by then
    aside = own_detour(own, stride, side, part)
    x, z, yaw = (
        foot[X] - aside[0] + ahead * foot[VELOCITY] - goal[0],
        foot[Z] - aside[1] + ahead * foot[VELOCITY + 1] - goal[1],
        foot[YAW] - aside[2] + ahead * foot[VELOCITY + 2] - goal[2],
    )
    share *= min(max(worth_a_step(x, z, yaw, stride.scale) - 1.0, 0.0), 1.0) if part < 1.0 else 1.0
    return goal[0] + share * x, goal[1] + share * z, goal[2] + share * yaw
