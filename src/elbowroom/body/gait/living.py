"""How hips, chest and head of a walking body live: sway, turn, list and ripple of the stride, breath and rest.

What is planned keeps its hips in the middle. What is shown carries them (`carriage`) as people do at that speed, as far
as there is room: the share eases up where nothing is near, and down where something is. Amounts are those of published
gait, see docs/motion.md; with the speed they go to zero. Who rests breathes and shifts weight from leg to leg. The head
turns to where the way will lead.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import (
    AHEAD,
    ASIDE,
    CHEST_BEND,
    CHEST_LIST,
    CHEST_TURN,
    HEAD_NOD,
    HEAD_TURN,
    LIST,
    POSING,
    TURN,
    UP,
)
from elbowroom.body.gait.cycle import GaitShape
from elbowroom.body.gait.manner import PLAIN, Manner
from elbowroom.body.gait.own_stride import PUBLISHED, OwnStride, carry_as_recorded
from elbowroom.body.gait.smoothstep import smoothstep
from elbowroom.body.gait.stride import Stride, stride_at
from elbowroom.body.root import SHOWN, WITH_FEET
from elbowroom.jit import brief_exact_kernel, helper, inner_exact_kernel

Floats = NDArray[np.float64]

# What is remembered in a row: how much is shown of it, how long it has rested (both 0 to 1), seconds that it rested.
SHARE, REST, CLOCK = WITH_FEET + 10, WITH_FEET + 11, WITH_FEET + 12

_NEAR, _FREE = 0.04, 0.14  # metres to the nearest thing: nothing is shown nearer, and all of it farther off
_RISE, _FALL = 1.2, 6.0  # a second: how fast that share grows and shrinks
_STILL = 1e-3  # m/s: below, the root rests
_TO_REST, _FROM_REST = 0.6, 3.0  # a second
_SWAY = np.array([0.062, 0.030, 0.030, 0.060])  # metres side to side at 0.7 m/s, less per m/s, least, most
_SWAY_ELSE = 0.010  # metres each way in steps aside and turns in place
_PELVIS_TURN = np.array([3.0, 5.0])  # degrees from side to side, and more per m/s
_PELVIS_LIST = np.array([2.0, 4.0])
_CHEST_TURN = np.array([2.0, 4.0])
_FASTEST = 2.0  # m/s: these grow no more
_LIST_AT, _CHEST_AT = 0.14, 0.02  # of the stride, when the left side is highest, and the chest turned farthest left
_LIST_ELSE, _CHEST_LIST = 0.3, -0.25  # of the list, in steps aside, and of the chest
_TOGETHER, _AGAINST = 0.3, 0.9  # m/s from which on the chest turns against the hips, and does so fully
_RIPPLE, _RIPPLE_AT = 0.0205, 0.12  # metres each way at 1 m/s; of the stride, when the hips are fastest
_BEFORE = 0.0060  # metres at 1 m/s that hips are ahead of where they are planned: late in its stance a leg is straight
_BOB, _LOWEST = 0.0030, 0.365  # metres, of the hips up and down beside what is planned; when they are lowest by it
_LEAN, _NODS, _NODS_AT = 0.015, 0.008, 0.1  # radians of the chest at 1 m/s, and each way
_GAZE, _LOW = 0.012, 0.08  # radians at 1 m/s that the head nods as the body rises; of the stride, when it is lowest
_BREATHS, _BREATH = 0.22, 0.010  # a second; radians of the chest
_STATION, _SHIFT = 6.0, 1.8  # seconds from shift to shift of the weight, and that one takes
_SHIFTED = np.array([0.018, 0.028, -0.03, -0.012, 0.01])  # metres aside; radians: list, turn, chest's list and turn
_SWAYS = 0.003  # metres of a standing body's own sway
_LOOK, _MOST, _EASE, _QUICKEST = 0.62, 0.9, 0.08, 4.0  # seconds ahead, radians, seconds, rad/s that a head turns
_STRAIGHT = 1e-3  # radians: less is none


@inner_exact_kernel
def _wave(phase: float, at: float) -> float:
    return math.cos(2.0 * math.pi * (phase - at))


@inner_exact_kernel
def _radians(line: Floats, speed: float) -> float:
    """Half of a range in degrees that grows with speed."""
    return math.radians(0.5 * (line[0] + line[1] * min(speed, _FASTEST)))


@helper
def _walk(stride: Stride, phase: float, out: Floats) -> float:
    """Write how a walking body is carried; returns the part of its steps that leads ahead or back."""
    scale, forward = stride.scale, stride.forward
    speed, way = abs(forward) / math.sqrt(scale), 1.0 if forward >= 0.0 else -1.0
    part = forward * forward / (forward * forward + stride.lateral**2 + (0.3 * scale * stride.turn) ** 2 + 1e-9)
    much, rest = stride.effort * part, stride.effort * (1.0 - part)
    side = min(max(_SWAY[0] - _SWAY[1] * (speed - 0.7), _SWAY[2]), _SWAY[3])
    out[ASIDE] = scale * (0.5 * much * side + rest * _SWAY_ELSE) * _wave(phase, 0.5 * stride.duty)
    out[UP] = -scale * much * min(speed, 1.0) * _BOB * _wave(2.0 * phase, 2.0 * _LOWEST)
    out[AHEAD] = way * _RIPPLE * _wave(2.0 * phase, 2.0 * _RIPPLE_AT + 0.25) + max(way, 0.0) * _BEFORE
    out[AHEAD] *= scale * much * min(speed, 1.5)
    out[TURN] = -way * much * _radians(_PELVIS_TURN, speed) * _wave(phase, 0.0)
    out[LIST] = (much + _LIST_ELSE * rest) * _radians(_PELVIS_LIST, speed) * _wave(phase, _LIST_AT)
    against = smoothstep((speed - _TOGETHER) / (_AGAINST - _TOGETHER))
    out[CHEST_TURN] = way * much * against * _radians(_CHEST_TURN, speed) * _wave(phase, _CHEST_AT)
    out[CHEST_LIST] = _CHEST_LIST * out[LIST]
    out[CHEST_BEND] = much * min(speed, _FASTEST) * (way * _LEAN + _NODS * _wave(2.0 * phase, 2.0 * _NODS_AT))
    out[HEAD_NOD] = -much * min(speed, _FASTEST) * _GAZE * _wave(2.0 * phase, 2.0 * _LOW)
    return part


@helper
def _on_leg(time: float) -> float:
    """Which leg carries who rests: 1 the left one, -1 the right one; it changes by minimum jerk."""
    number = math.floor(time / _STATION)
    before, after = math.sin(2.4 * number), math.sin(2.4 * (number + 1.0))
    t = min((time - number * _STATION) / _SHIFT, 1.0)
    return before + (after - before) * t * t * t * (10.0 + t * (6.0 * t - 15.0))


@helper
def _idle(scale: float, much: float, time: float, out: Floats) -> None:
    """Add how a body is carried that rests."""
    leg = much * _on_leg(time)
    out[ASIDE] += scale * (_SHIFTED[0] * leg + much * _SWAYS * math.sin(2.0 * math.pi * 0.17 * time))
    out[AHEAD] += scale * much * _SWAYS * math.sin(2.0 * math.pi * 0.13 * time)
    out[LIST] += _SHIFTED[1] * leg
    out[TURN] += _SHIFTED[2] * leg
    out[CHEST_LIST] += _SHIFTED[3] * leg
    out[CHEST_TURN] += _SHIFTED[4] * leg
    out[CHEST_BEND] -= much * _BREATH * math.sin(2.0 * math.pi * _BREATHS * time)


@helper
def _looks_to(root: Floats, coming: Floats) -> float:
    """How far to the left of the heading the root will face soon: as planned, then on with its turning rate."""
    heading, since = root[2], 0.0
    for n in range(coming.shape[0]):
        if since >= _LOOK:
            break
        share = min((_LOOK - since) / max(coming[n, 0] - since, 1e-9), 1.0)
        heading += share * (coming[n, 3] - heading)
        since = min(coming[n, 0], _LOOK)
    if since <= 0.0:
        heading += root[5] * _LOOK
    return float(min(max(heading - root[2], -_MOST), _MOST))


@helper
def _eased(turned: float, goal: float, dt: float) -> float:
    """How far the head is turned `dt` seconds later."""
    turn = (goal - turned) * (1.0 - math.exp(-dt / _EASE))
    after = turned + min(max(turn, -_QUICKEST * dt), _QUICKEST * dt)
    return 0.0 if max(abs(goal), abs(after)) < _STRAIGHT else after


@inner_exact_kernel
def _approached(value: float, goal: float, up: float, down: float) -> float:
    return value + min(max(goal - value, -down), up)


class Body(NamedTuple):
    """Who lives: what `living` needs to know of it."""

    scale: float  # of its legs, see `GaitShape`
    amounts: Floats  # (POSING + 1,) of its manner
    own: OwnStride  # of a walk that was recorded, in place of published gait


@brief_exact_kernel
def live(body: Body, before: Floats, dt: float, room: float, coming: Floats, faces: float, out: Floats) -> None:
    """Write to a row (SHOWN,) with root and feet how it is carried `dt` seconds after the row `before` (SHOWN,).

    `room` metres are about the body; below 0 it is carried as planned at once. `coming` (m, 8) is as in `step_feet`.
    The head is planned to face so many radians to the left of the heading.
    """
    rests = abs(out[3]) + abs(out[4]) + abs(out[5]) < _STILL
    goal = smoothstep((min(room, 1.0) - _NEAR) / (_FREE - _NEAR))
    out[SHARE] = _approached(before[SHARE], goal, _RISE * dt, _FALL * dt) if room >= 0.0 else 0.0
    out[REST] = _approached(before[REST], 1.0 if rests else 0.0, _TO_REST * dt, _FROM_REST * dt)
    out[CLOCK] = before[CLOCK] + (dt if rests else 0.0)
    for i in range(POSING):
        out[WITH_FEET + i] = 0.0
    share = smoothstep(out[SHARE])
    if share > 0.0:
        part = _walk(stride_at(body.scale, out), out[6], out)
        if body.own.speed > 0.0:
            carry_as_recorded(body.own, part, out[3], body.scale, out[6], out)
        _idle(body.scale, smoothstep(out[REST]), out[CLOCK], out)
        for i in range(POSING):
            out[WITH_FEET + i] *= share * body.amounts[i]
        out[CHEST_BEND] += share * body.amounts[POSING]
    if room >= 0.0:
        out[HEAD_TURN] = _eased(before[HEAD_TURN], share * (_looks_to(out, coming) - faces), dt)


def body_of(gait: GaitShape, manner: Manner = PLAIN, own: OwnStride = PUBLISHED) -> Body:
    """A body that walks in a manner, or like somebody who was recorded."""
    return Body(gait.scale, manner.amounts(), own)


def living(
    body: Body, before: Floats, row: Floats, dt: float, room: float, coming: Floats, faces: float = 0.0
) -> Floats:
    """A row (WITH_FEET,) as it is carried (SHOWN,), see `live`."""
    out = np.empty(SHOWN)
    out[:WITH_FEET] = row
    live(body, before, dt, room, coming, faces, out)
    return out


def lively(row: Floats) -> bool:
    """Whether a row (SHOWN,) is carried otherwise than planned."""
    return bool(row[SHARE] > 0.0 or row[HEAD_TURN] != 0.0)
