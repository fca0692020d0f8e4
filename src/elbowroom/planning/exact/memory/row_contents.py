"""Key times known again by what the body does there, to the last bit, wherever it stands: rows for `RowIndex`."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import HEIGHT
from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_FIRST = 3  # of a root state: before it are the place and the heading; the height ends it
_NATURAL = 1e-6  # radians from the goal
CONTENT = HEIGHT - _FIRST  # numbers of a row beside those of the upper body


@exact_kernel
def set_contents(states: Floats, uppers: Floats, out: Longs) -> None:
    """The bits of root states (n+1, 7 or more) without place, heading and height, and beside them of `uppers` (n+1, K).

    They begin the rows `out` (n+1, CONTENT + K or more).
    """
    for t in range(out.shape[0]):
        set_bits(states[t, _FIRST:HEIGHT], out[t])
        set_bits(uppers[t], out[t, CONTENT:])


@exact_kernel
def set_bits(values: Floats, out: Longs) -> None:
    """The bits of values (K,), to `out` (K or more,)."""
    bits = values.view(np.int64)
    for j in range(bits.shape[0]):
        out[j] = bits[j]


@exact_kernel
def is_natural(upper: Floats, goals: Floats) -> bool:
    """Whether groups side by side (K,) are as their goals have them, the first of `goals` (LOCAL,)."""
    farthest = 0.0
    for j in range(upper.shape[0]):
        farthest = max(farthest, abs(upper[j] - goals[j]))
    return farthest < _NATURAL
