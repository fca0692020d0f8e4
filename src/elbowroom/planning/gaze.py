"""Where the head looks: where the root goes, a little before the body turns there, and level whatever the trunk does.

Who turns while walking turns the head first: by some 0.2 s on a circle (R. Grasso, S. Glasauer, Y. Takei & A. Berthoz,
NeuroReport 7, 1996), by up to a second at a corner (R. Grasso, P. Prévost, Y. P. Ivanenko & A. Berthoz, Neurosci. Lett.
253, 1998). Who walks sideways looks there too.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup, columns_of, limits
from elbowroom.body.gait.lowered_hips import hips_lean
from elbowroom.jit import exact_kernel, helper

Floats = NDArray[np.float64]

LEAD = 0.45  # seconds by which the head is ahead of the root's way; it is some 0.15 less ahead of the body's heading
_SLOW = 0.3  # m/s ahead that are added: below, and backward, the head stays with the body
_SAME = 1e-9  # radians
_HEAD, _WAIST = columns_of(DofGroup.HEAD).start, columns_of(DofGroup.WAIST).start
(_NOD_BACK, _NOD), (_TURN_RIGHT, _TURN) = (tuple(ends) for ends in limits(DofGroup.HEAD).tolist())


@helper
def _course(state: Floats) -> float:
    """The heading in which a root state (7,) goes, radians; its own where it stands or goes backward."""
    return float(state[2] + np.arctan2(state[4], max(state[3], 0.0) + _SLOW))


@exact_kernel
def look(states: Floats, interval: float, n: int) -> float:
    """The head's turn to the left at key state `n` of states (n+1, 7) that are `interval` seconds apart, radians.

    It is towards the way `LEAD` seconds later; after the last state the root turns on as it does there.
    """
    last, ahead = states.shape[0] - 1, LEAD / interval
    k = int(ahead)
    first, second = min(n + k, last), min(n + k + 1, last)
    course = _course(states[first])
    course += (ahead - k) * (_course(states[second]) - course)
    course += states[last, 5] * interval * max(n + ahead - last, 0.0)
    return float(min(max(course - states[n, 2], _TURN_RIGHT), _TURN))


@exact_kernel
def keeping_gaze(goals: Floats, waists: Floats) -> Floats:
    """Goals (n+1, LOCAL) under waists (n+1, 3): the head looks where it would under the goals' own waists.

    As far as the neck can. What it lacks to look level it looks down, and still to the same side.
    """
    out = goals.copy()
    for t in range(out.shape[0]):
        bend, twist = goals[t, _WAIST], goals[t, _WAIST + 1]
        lean = hips_lean(goals[t, _WAIST + 2]) - hips_lean(waists[t, 2])
        if max(abs(waists[t, 0] - bend), abs(waists[t, 1] - twist), abs(lean)) < _SAME:
            continue
        nod, turn = goals[t, _HEAD], goals[t, _HEAD + 1]
        x, y, z = np.sin(turn) * np.cos(nod), -np.sin(nod), np.cos(turn) * np.cos(nod)  # in the chest's frame
        y, z = y * np.cos(bend) - z * np.sin(bend), y * np.sin(bend) + z * np.cos(bend)
        x, z = x * np.cos(twist) + z * np.sin(twist), z * np.cos(twist) - x * np.sin(twist)  # in the pelvis's
        y, z = y * np.cos(lean) - z * np.sin(lean), y * np.sin(lean) + z * np.cos(lean)  # in that of the other pelvis
        twist, bend = -waists[t, 1], -waists[t, 0]
        x, z = x * np.cos(twist) + z * np.sin(twist), z * np.cos(twist) - x * np.sin(twist)
        y, z = y * np.cos(bend) - z * np.sin(bend), y * np.sin(bend) + z * np.cos(bend)
        nod, turn = np.arctan2(-y, np.hypot(x, z)), np.arctan2(x, max(z, abs(y)))
        out[t, _HEAD] = min(max(nod, _NOD_BACK), _NOD)
        out[t, _HEAD + 1] = min(max(turn, _TURN_RIGHT), _TURN)
    return out
