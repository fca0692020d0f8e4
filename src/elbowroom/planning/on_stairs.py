"""What somebody would like who climbs or goes down, on a stair or a ramp: lower hips on the way down, arms farther out.

Ground that falls lies lower where the leg ahead comes down than under the body, by what it falls until the body is over
that foot. People have lowered themselves by then: the knee that stands bends through the whole swing of the other leg.
Hips of who goes down are lower by half of that, under a trunk that stays upright, and knees are bent as they land. Both
ways thighs come up to where hands hang, so arms are spread a little. Who is as low already for what hangs there, or has
no room for it, does as he must: it is what is liked, no more.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, DofGroup, columns_of, limits
from elbowroom.body.gait.lowered_hips import hips_lean
from elbowroom.body.gait.smoothstep import smoothstep
from elbowroom.body.gait.stride import CLIMB, stride_at
from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]

_DEEP = 0.5  # of what the ground falls until the body is over the foot ahead
_SPREAD, _SPREADS = 0.1, 0.08  # radians that arms are spread, where it climbs so many metres until then
_LEVEL = 1e-6  # m/s: who goes up or down no faster is on the level
_BEND = columns_of(DofGroup.WAIST).start
_LOWERING = _BEND + 2
_LEFT, _RIGHT = (columns_of(arm).start + 1 for arm in ARMS)  # their abduction
_LEAST, _LOWEST = float(limits(DofGroup.WAIST)[0, 0]), float(limits(DofGroup.WAIST)[2, 1])
_WIDEST = float(limits(ARMS[0])[1, 1])


@exact_kernel
def goals_on_stairs(goals: Floats, states: Floats, scale: float, half_leg: float) -> Floats:
    """The goals (n+1, LOCAL) of who walks on the level as one likes them who climbs as root states (n+1, 7) tell.

    Of a body with legs of this `scale`, half as long as `half_leg`, metres; the same goals on the level.
    """
    if states.shape[1] <= CLIMB or np.abs(states[:, CLIMB]).max() < _LEVEL:
        return goals
    out = goals.copy()
    for n in range(goals.shape[0]):
        stride = stride_at(scale, states[n])
        climbs = 0.5 * stride.duty * stride.period * states[n, CLIMB]
        lowering = min(out[n, _LOWERING] + _DEEP * max(-climbs, 0.0) / half_leg, _LOWEST)
        lean = hips_lean(lowering) - hips_lean(out[n, _LOWERING])
        out[n, _LOWERING], out[n, _BEND] = lowering, max(out[n, _BEND] - lean, _LEAST)
        for arm in (_LEFT, _RIGHT):
            out[n, arm] = min(out[n, arm] + _SPREAD * smoothstep(abs(climbs) / _SPREADS), _WIDEST)
    return out
