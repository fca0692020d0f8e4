"""How hips are carried that come lower than the walk has them: back as they go down, and leaning forward."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.smoothstep import smoothstep
from elbowroom.jit import inner_kernel, kernel

Floats = NDArray[np.float64]

# How far lowered hips lean forward, radians, and half leg lengths from which on they lean no more: hardly while knees
# will do. With thighs that rise in a stride this stays within what hips flex (120 degrees, the book named in `dof`).
_LEAN, _LEANING = 0.6, 0.45
STEEPEST = 1.5 * _LEAN / _LEANING  # radians that they lean more for a unit of lowering, at most
_SETBACK = 0.5  # how far lowered hips go back, against how far they go down; less, and the shins lean too far


@inner_kernel
def hips_lean(lowering: float) -> float:
    """How far lowered hips lean forward, radians."""
    return _LEAN * smoothstep(lowering / _LEANING)


@inner_kernel
def hips_sink(half_leg: float, drop: float, lowering: float) -> tuple[float, float, float]:
    """One row of `hips_sinks`."""
    lowered = half_leg * lowering
    return drop + lowered, _SETBACK * lowered, hips_lean(lowering)


@kernel
def hips_sinks(half_leg: float, drops: Floats, lowerings: Floats) -> Floats:
    """How far the hips are below and behind their place in T-pose, metres, and lean forward, radians (N, 3).

    `drops` (N,) are those of `foot_poses`, `lowerings` (N,) the part of a configuration. Hips go back as they go down,
    as in every squat: the body's weight stays over the feet, and the shins within the reach of the ankles. They lean
    about the middle between the joints of the legs.
    """
    sinks = np.empty((len(drops), 3))
    for n in range(len(drops)):
        sinks[n, 0], sinks[n, 1], sinks[n, 2] = hips_sink(half_leg, drops[n], lowerings[n])
    return sinks
