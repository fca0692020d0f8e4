"""Walking along a line with a given distance to its side and a given turn of the body at every metre."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, plain
from elbowroom.planning.root.motion import MotionBounds, limited_step, wrapped

Floats = NDArray[np.float64]

_ASIDE, _TURN = plain(0), plain(1)  # columns of a profile
_STILL = 1e-9  # lengths and speeds that are divided by are at least this
_EASY = 1.4  # m/s^2: the slowing down for what comes
_COMFORT = 2.2  # rad/s: a turn that is faster is walked more slowly
_SEEN = 0.6  # metres ahead
_LEAST = 0.05  # m/s: slower than this nobody walks
_AWRY, _WRY = 0.25, 0.6  # radians: who is turned so far from what the place asks for walks slower, or waits
_EAGER = 0.9  # the part of being off the path that is mended within a key interval


class Profile(NamedTuple):
    """A path along a line of travel: rows at equal steps ahead."""

    first: float  # metres ahead of the line's first point, of the first row
    step: float  # metres between rows
    rows: Floats  # (n, 2) metres to the left of the line; radians that the body is turned from the line's facing


class PacedLine(NamedTuple):
    """The line that a profile belongs to, and the pace on it, for kernels."""

    x: float
    z: float
    heading: float
    facing: float
    forward: float  # m/s, walking straight ahead
    sideways: float  # m/s
    stops: bool  # whether to stand at the profile's end


@exact_kernel
def turned_speed(forward: float, sideways: float, angle: float) -> float:
    """The speed of a walk that leads `angle` away from where the body faces: on the ellipse through both speeds."""
    along, across = math.cos(angle) / forward, math.sin(angle) / sideways
    speed: float = 1.0 / math.sqrt(along * along + across * across)
    return speed


@exact_kernel
def _at(rows: Floats, place: float, column: int) -> float:
    """A column of the profile at a place in steps, interpolated; the ends hold outside."""
    inside = min(max(place, 0.0), rows.shape[0] - 1.0)
    i = min(int(inside), max(rows.shape[0] - 2, 0))
    j = min(i + 1, rows.shape[0] - 1)
    value: float = rows[i, column] + (inside - i) * (rows[j, column] - rows[i, column])
    return value


@helper
def _allowed(rows: Floats, step: float, place: float, paced: PacedLine) -> float:
    """The speed here from which one can still slow down for every turn of the body that comes."""
    speed = np.inf
    for i in range(max(int(place), 0), rows.shape[0]):
        distance = max(i - place, 0.0) * step
        if distance > _SEEN:
            break
        own = turned_speed(paced.forward, paced.sideways, paced.heading - paced.facing - rows[i, 1])
        swing = abs(rows[min(i + 1, rows.shape[0] - 1), 1] - rows[i, 1])
        own = min(own, _COMFORT * step / max(swing, _STILL))
        speed = min(speed, np.sqrt(own * own + 2.0 * _EASY * distance))
    if paced.stops:
        left = max(rows.shape[0] - 1 - place, 0.0) * step
        return float(min(speed, np.sqrt(_EASY * left)))
    return float(max(speed, _LEAST))


@exact_kernel
def follow_profile(
    states: Floats, rows: Floats, first: float, step: float, paced: PacedLine, interval: float, bounds: MotionBounds
) -> None:
    """Fill the states by walking along a profile; beyond its end the line itself is walked, facing ahead."""
    sine, cosine = np.sin(paced.heading), np.cos(paced.heading)
    for k in range(states.shape[0] - 1):
        dx, dz = states[k, 0] - paced.x, states[k, 1] - paced.z
        ahead, left = dx * sine + dz * cosine, dx * cosine - dz * sine
        place = (ahead - first) / step
        facing = paced.facing + _at(rows, place, _TURN)
        awry = abs(wrapped(states[k, 2] - facing))
        speed = min(_allowed(rows, step, place, paced), paced.forward)
        speed *= min(max((_WRY - awry) / (_WRY - _AWRY), 0.0), 1.0)
        along, across = _along(states[k], paced.heading)
        gone = place + 0.5 * interval * (along + speed) / step
        slope = (_at(rows, gone + 0.5, _ASIDE) - _at(rows, gone - 0.5, _ASIDE)) / step
        swing = (_at(rows, gone + 0.5, _TURN) - _at(rows, gone - 0.5, _TURN)) / step * speed
        aside = speed * slope
        aside += _EAGER / interval * (_at(rows, gone, _ASIDE) - left - 0.5 * interval * (across + aside))
        aside = min(max(aside, -paced.sideways), paced.sideways)
        turned = wrapped(states[k, 2] - paced.facing)
        turn = swing + _EAGER / interval * (_at(rows, gone, _TURN) - turned - 0.5 * interval * (states[k, 5] + swing))
        turn = min(max(turn, -bounds.turn_rate), bounds.turn_rate)
        vx, vz = speed * sine + aside * cosine, speed * cosine - aside * sine
        limited_step(states, k, vx, vz, turn, interval, bounds)


@helper
def _along(state: Floats, heading: float) -> tuple[float, float]:
    """The velocity of a root state (7,) along a heading and to its left."""
    angle = state[2] - heading
    sine, cosine = np.sin(angle), np.cos(angle)
    return state[3] * cosine - state[4] * sine, state[3] * sine + state[4] * cosine
