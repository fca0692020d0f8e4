"""Key times known again by what the body does there, wherever it stands."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import ROOT_STATE
from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_FIRST = 3  # of a root state: before it are the place and the heading


@exact_kernel
def _millionths(states: Floats, uppers: Floats, rates: Floats) -> Longs:
    """Rows of whole millionths (n+1, ...): root states (n+1, 7) without place and heading, and two arrays."""
    start, end = ROOT_STATE - _FIRST, ROOT_STATE - _FIRST + uppers.shape[1]
    out = np.empty((states.shape[0], end + rates.shape[1]), np.int64)
    for t in range(out.shape[0]):
        for j in range(start):
            out[t, j] = np.int64(np.rint(1e6 * states[t, _FIRST + j]))
        for j in range(uppers.shape[1]):
            out[t, start + j] = np.int64(np.rint(1e6 * uppers[t, j]))
        for j in range(rates.shape[1]):
            out[t, end + j] = np.int64(np.rint(1e6 * rates[t, j]))
    return out


def names_of(states: Floats, uppers: Floats, rates: Floats | None, keys: list[int], rows: int) -> list[bytes]:
    """A name for each of some key times and the `rows` - 1 after it: equal where all is equal to a millionth.

    Of root states (n+1, 7), upper bodies (n+1, ...) and, if they matter, their rates (n+1, ...).
    """
    found = _millionths(states, uppers, uppers[:, :0] if rates is None else rates)
    content, size = found.tobytes(), found.strides[0]
    return [content[size * t : size * (t + rows)] for t in keys]
