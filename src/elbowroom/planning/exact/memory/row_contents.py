"""Key times known again by what the body does there, to the last bit, wherever it stands: rows for `RowIndex`."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE
from elbowroom.jit import inner_exact_kernel

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_FIRST = 3  # of a root state: before it are the place and the heading
_STRIDE = HEIGHT - _FIRST  # numbers from there to the phase
_NATURAL = 1e-6  # radians from the natural walk
CONTENT = _STRIDE + ROOT_STATE - RISES  # numbers of a row beside those of the upper body


@inner_exact_kernel
def set_contents(states: Floats, uppers: Floats, out: Longs) -> None:
    """The bits of root states (n+1, 7 or more) without place, heading, height and climb, and beside them of `uppers`.

    These are (n+1, K) and begin the rows `out` (n+1, CONTENT + K or more).
    """
    for t in range(out.shape[0]):
        set_bits(states[t, _FIRST:HEIGHT], out[t])
        out[t, _STRIDE:CONTENT] = 0
        if states.shape[1] > RISES:
            set_bits(states[t, RISES:], out[t, _STRIDE:])
        set_bits(uppers[t], out[t, CONTENT:])


@inner_exact_kernel
def set_bits(values: Floats, out: Longs) -> None:
    """The bits of values (K,), to `out` (K or more,)."""
    bits = values.view(np.int64)
    for j in range(bits.shape[0]):
        out[j] = bits[j]


@inner_exact_kernel
def is_natural(upper: Floats, walk: Floats) -> bool:
    """Whether groups side by side (K,) do as in the natural walk, the first of `walk` (K or more,).

    It is known that this does not touch, on the plane. Where ground raises the knees arms make way for them as they are
    shown (`control.feet.arms_beside_legs`).
    """
    farthest = 0.0
    for j in range(upper.shape[0]):
        farthest = max(farthest, abs(upper[j] - walk[j]))
    return farthest < _NATURAL
