"""Key times known again by what the body does there, wherever it stands: rows for `Known`."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import ROOT_STATE
from elbowroom.jit import exact_inner_kernel, exact_lean_kernel

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_FIRST = 3  # of a root state: before it are the place and the heading
_NATURAL = 1e-6  # radians from the goal
CONTENT = ROOT_STATE - _FIRST  # numbers of a row beside those of the upper body


@exact_inner_kernel
def contents_of(states: Floats, uppers: Floats, rates: Floats) -> Longs:
    """Rows of whole millionths (n+1, ...): root states (n+1, 7) without place and heading, and two arrays."""
    end = CONTENT + uppers.shape[1]
    out = np.empty((states.shape[0], end + rates.shape[1]), np.int64)
    for t in range(out.shape[0]):
        for j in range(CONTENT):
            out[t, j] = np.int64(np.rint(1e6 * states[t, _FIRST + j]))
        for j in range(uppers.shape[1]):
            out[t, CONTENT + j] = np.int64(np.rint(1e6 * uppers[t, j]))
        for j in range(rates.shape[1]):
            out[t, end + j] = np.int64(np.rint(1e6 * rates[t, j]))
    return out


@exact_lean_kernel
def is_natural(upper: Floats, goals: Floats) -> bool:
    """Whether groups side by side (K,) are as their goals have them, the first of `goals` (11,)."""
    farthest = 0.0
    for j in range(upper.shape[0]):
        farthest = max(farthest, abs(upper[j] - goals[j]))
    return farthest < _NATURAL
