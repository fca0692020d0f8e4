"""What arms and shoulders would like where it is narrow.

Arms hang closer, and who has less room than that turns the shoulders, from some 1.3 shoulder widths on and the more the
narrower it is (W. H. Warren & S. Whang, J. Exp. Psychol. Hum. Percept. Perform. 13, 1987), so that some centimetres are
left on either side. The hips stay as they go: turned strides are broader than straight ones. Hands stay near the hips,
one before and one behind: beside the thighs there would be no room for them.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, DofGroup, columns_of
from elbowroom.body.gait.smoothstep import smoothstep
from elbowroom.body.root import HEIGHT
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel
from elbowroom.planning.gaze import keeping_gaze
from elbowroom.planning.narrow.build import TWIST, Build
from elbowroom.planning.narrow.places import EVERY, MARGIN, NarrowPlaces
from elbowroom.planning.root.path import RootPath, interpolate_root

Floats = NDArray[np.float64]

_HERE = 0.3  # metres to a narrow place: so near one is as it asks for
_BEFORE, _AFTER = 0.9, 0.5  # metres before it from which on one begins, and behind it until which one is done
_MOVES = 0.1  # m/s: who is slower goes where he faces
_USE = 0.02  # metres by which shoulders or arms get slimmer, at least: with less they do it only in part
_CALM = 0.9  # of the arms' hanging and swing that a narrow place takes away
# Radians that arms which are drawn in keep: one back and the other ahead, aside, turned in, bent.
_ALONG, _ASIDE, _IN, _BENT = 0.35, 0.04, 0.02, 0.09
_CLOSE = 6  # the power of that share by which arms come close: hands have left the thighs by then
_PASSING = 0.25  # radians that arms are spread, for each that shoulders turn, until they are drawn in
_SAME = 1e-6  # radians
_WAIST, _HEAD = columns_of(DofGroup.WAIST), columns_of(DofGroup.HEAD)
_TWIST, (_LEFT, _RIGHT) = _WAIST.start + 1, (columns_of(arm).start for arm in ARMS)


def goals_where_narrow(narrow: NarrowPlaces, path: RootPath, goals: Floats) -> Floats:
    """What somebody would like who walks along a path and has `goals` (n+1, LOCAL) where there is room; those there."""
    height = float(path.states[0, HEIGHT]) if path.states.shape[1] > HEIGHT else 0.0
    places = narrow.on(_ways_of(path.states, path.interval), height)
    if not len(places):
        return goals
    wanted = _wanted(goals, path.states, places, narrow.build)
    wanted[:, _HEAD] = keeping_gaze(goals, np.ascontiguousarray(wanted[:, _WAIST]))[:, _HEAD]
    return wanted


@inner_exact_kernel
def _direction(state: Floats) -> tuple[float, float]:
    """Where a root state (7,) goes, x and z of a unit vector; where it faces if it stands."""
    sine, cosine = np.sin(state[2]), np.cos(state[2])
    speed = np.hypot(state[3], state[4])
    if speed < _MOVES:
        return sine, cosine
    return (state[3] * sine + state[4] * cosine) / speed, (state[3] * cosine - state[4] * sine) / speed


@exact_kernel
def _ways_of(states: Floats, interval: float) -> Floats:
    """Places and directions (N, 4) along a root path (n+1, 7), straight back from its start and on from its end."""
    back, on = int(np.ceil(_AFTER / EVERY)), int(np.ceil(_BEFORE / EVERY))
    pieces, count = np.empty(states.shape[0] - 1, np.int64), back + on + 1
    for k in range(states.shape[0] - 1):
        gone = np.hypot(states[k + 1, 0] - states[k, 0], states[k + 1, 1] - states[k, 1])
        pieces[k] = int(np.ceil(gone / EVERY))
        count += pieces[k]
    out, used = np.empty((count, 4)), 0
    for k in range(-1, states.shape[0] - 1):
        for n in range(1 if k < 0 else pieces[k]):
            own = states[0] if k < 0 else interpolate_root(states[k], states[k + 1], (n + 1.0) / pieces[k], interval)
            out[used, 2], out[used, 3] = _direction(own)
            out[used, 0], out[used, 1] = own[0], own[1]
            used += 1
    stands = np.hypot(states[-1, 3], states[-1, 4]) < _MOVES
    for n in range(back if stands else back + on):
        own, away = (states[0], -EVERY * (n + 1)) if n < back else (states[-1], EVERY * (n - back + 1))
        out[used, 2], out[used, 3] = _direction(own)
        out[used, 0], out[used, 1] = own[0] + away * out[used, 2], own[1] + away * out[used, 3]
        used += 1
    return out[:used].copy()


@helper
def _asked(places: Floats, build: Build, state: Floats) -> tuple[float, float]:
    """How far shoulders are turned, of `TWIST`, and how far arms are drawn in, both 0 to 1, at a root state (7,)."""
    turned, drawn, (x, z) = 0.0, 0.0, _direction(state)
    for k in range(places.shape[0]):
        dx, dz, half = places[k, 0] - state[0], places[k, 1] - state[1], places[k, 2]
        over = (_BEFORE if dx * x + dz * z >= 0.0 else _AFTER) - _HERE
        share = smoothstep(1.0 - (np.hypot(dx, dz) - _HERE) / over)
        turn = (build.broad + MARGIN - half) / max(build.broad - build.slim, _USE)
        draw = (build.swinging + MARGIN - half) / max(build.swinging - build.broad, _USE)
        turned = max(turned, share * min(max(turn, 0.0), 1.0))
        drawn = max(drawn, share * min(max(draw, 0.0), 1.0))
    return turned, drawn


@exact_kernel
def _wanted(goals: Floats, states: Floats, places: Floats, build: Build) -> Floats:
    """Goals (n+1, LOCAL) with arms drawn in and shoulders turned, to the side to which the hips are turned already."""
    out = goals.copy()
    for t in range(goals.shape[0]):
        turned, drawn = _asked(places, build, states[t])
        x, z = _direction(states[t])
        sine, cosine = np.sin(states[t, 2]), np.cos(states[t, 2])
        hips = np.arctan2(sine * z - cosine * x, abs(sine * x + cosine * z))  # turned from the line of the way
        side = 1.0 if hips > -_SAME else -1.0
        twist = side * max(TWIST * turned - abs(hips), 0.0)
        drawn *= 1.0 - min(abs(hips) / TWIST, 1.0)  # who goes sideways has the arms before and behind
        out[t, _TWIST] += twist
        along, close = _ALONG * drawn * (1.6 - 0.6 * drawn), drawn**_CLOSE
        for arm, ahead in ((_LEFT, -side), (_RIGHT, side)):
            out[t, arm] = (1.0 - _CALM * drawn) * out[t, arm] + ahead * along
            out[t, arm + 1] = (1.0 - _CALM * close) * out[t, arm + 1] + _ASIDE * close
            out[t, arm + 1] += _PASSING * abs(twist) * (1.0 - drawn)
            out[t, arm + 2] = (1.0 - _CALM * drawn) * out[t, arm + 2] + _IN * drawn
            out[t, arm + 3] = (1.0 - _CALM * drawn) * out[t, arm + 3] + _BENT * drawn
    return out
