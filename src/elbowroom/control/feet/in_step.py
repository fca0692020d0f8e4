"""The phase at which a walk begins: one that is in step with the feet as they are.

Who rests has any phase, that of when he stopped, while his feet go on to stand beside each other. If he walks again
before they do, the walking cycle may want the foot to swing that has just landed ahead, and leave the other one behind.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.foot_state import SWING, X, Z
from elbowroom.body.root import FOOT, ROOT_STATE, RootState

Floats = NDArray[np.float64]

_SLOW = 0.06  # m/s of a standard leg: hips and arms do not show their phase yet
_EVEN = 0.002  # metres, of ground on which legs at rest are the same at every phase
_APART = 0.08  # metres of a standard leg, along the way, from which on one foot is behind the other
_WANTED = 0.5  # of a way, whose length is 1, or 0 where one wants to go nowhere
_SWINGS, _WAITS = 0.62, 0.5  # of its cycle: from where on a foot swings, and where one is that does so first


def in_step(root: RootState, shown: Floats, way: Floats, scale: float) -> RootState:
    """The root state from which to set out along a way (x, z) of the world, where feet are as `shown` (WITH_FEET, ...).

    It is the same for who walks, or wants to go nowhere, or has his feet beside each other, or on uneven ground.
    """
    walks = math.hypot(root.forward, root.lateral) > _SLOW * math.sqrt(scale)
    if walks or math.hypot(*way) < _WANTED or max(abs(root.left_rise), abs(root.right_rise)) > _EVEN:
        return root
    feet = shown[ROOT_STATE : ROOT_STATE + 2 * FOOT].reshape(2, FOOT)
    swings = int(feet[:, SWING].argmax())
    if feet[swings, SWING] > 0.0:
        return _at(root, swings, _SWINGS + (1.0 - _SWINGS) * float(feet[swings, SWING]))
    sine, cosine = math.sin(root.heading), math.cos(root.heading)
    aside, ahead = way[0] * cosine - way[1] * sine, way[0] * sine + way[1] * cosine
    along = feet[:, X] * aside + feet[:, Z] * ahead
    if abs(along[0] - along[1]) < _APART * scale:
        return root
    return _at(root, int(along.argmin()), _WAITS)


def _at(root: RootState, side: int, place: float) -> RootState:
    """The same at the next phase at which a foot is at that place of its cycle."""
    return root._replace(phase=root.phase + (place - 0.5 * side - root.phase) % 1.0)
