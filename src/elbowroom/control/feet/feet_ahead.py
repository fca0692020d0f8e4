"""Where feet will be that step or glide on as the root goes on: the rows of `following`, one after the other."""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import GaitShape
from elbowroom.body.gait.foot_state import YAW, X, Z
from elbowroom.body.gait.gliding import glide_feet
from elbowroom.body.gait.landing_places import Stepper
from elbowroom.body.gait.own_steps import CYCLE, OwnSteps
from elbowroom.body.root import FOOT, HEIGHT, RISES, ROOT_STATE, WITH_FEET
from elbowroom.control.feet.treading import step_on
from elbowroom.jit import brief_exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.model.footing import ON_PLANE, Underfoot, stood_at

Floats = NDArray[np.float64]

_PIECE = 0.05  # seconds between two rows, nearly
_STEP, _GLIDE = plain(True), plain(False)  # whether feet step
_HELD = plain(False)  # whether feet that stand stay, where they glide


def steps_ahead(
    gait: GaitShape, row: Floats, ahead: Floats, until: float, own: OwnSteps = CYCLE, under: Underfoot = ON_PLANE
) -> Floats:
    """Root states with feet (N, WITH_FEET) from `row` (WITH_FEET,) on, as feet step under a root that goes on.

    The root goes straight from one of the states that it is to come to, `ahead` (m, 8) with the seconds from now, to
    the next, past the first that is `until` seconds away.
    """
    return _feet_ahead(Stepper(gait.legs, gait.scale, own), under, row, ahead, until, _STEP)


def glides_ahead(gait: GaitShape, row: Floats, ahead: Floats, until: float, under: Underfoot = ON_PLANE) -> Floats:
    """The same of feet that glide from where they are in `row` into the walking cycle, over what is under them."""
    return _feet_ahead(Stepper(gait.legs, gait.scale, CYCLE), under, row, ahead, until, _GLIDE)


@inner_exact_kernel
def _pieces(span: float) -> int:
    return max(int(np.rint(span / _PIECE)), 1)


@helper
def _lay(under: Underfoot, row: Floats) -> None:
    """Put both feet of a row on the ground where they are."""
    for side in range(2):
        foot, at = row[ROOT_STATE + FOOT * side :], RISES + 2 * side
        height, slope = stood_at(under.ground, under.sole, row, foot[X], foot[Z], foot[YAW])
        if height > -math.inf:
            row[at], row[at + 1] = height - row[HEIGHT], slope


@brief_exact_kernel
def _feet_ahead(who: Stepper, under: Underfoot, row: Floats, ahead: Floats, until: float, steps: bool) -> Floats:
    first, last, since, count = 0, 0, 0.0, 1
    while first < len(ahead) and ahead[first, 0] <= 0.0:
        first += 1
    last = first
    while last < len(ahead) and since < until:
        count, since = count + _pieces(ahead[last, 0] - since), ahead[last, 0]
        last += 1
    rows, root, coming = np.empty((count, WITH_FEET)), np.empty(ROOT_STATE), ahead.copy()
    rows[0], since, at = row, 0.0, 0
    for n in range(first, last):
        span, begin, pieces = ahead[n, 0] - since, rows[at, :ROOT_STATE].copy(), _pieces(ahead[n, 0] - since)
        for piece in range(1, pieces + 1):
            share = piece / pieces
            for i in range(ROOT_STATE):
                root[i] = begin[i] + share * (ahead[n, 1 + i] - begin[i])
            for k in range(n, len(ahead)):
                coming[k, 0] = ahead[k, 0] - since - share * span
            if steps:
                step_on(under, who, rows[at], root, span / pieces, coming[n:], rows[at + 1])
            else:
                glide_feet(who.legs, who.scale, rows[at], root, span / pieces, _HELD, rows[at + 1])
                if not under.ground.plain:
                    _lay(under, rows[at + 1])
            at += 1
        since = ahead[n, 0]
    return rows
