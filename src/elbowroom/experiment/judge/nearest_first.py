"""What is asked first: places whose lower bounds are least, as long as they can change what is kept."""

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def nearest_first(bounds: Floats, limit: Callable[[], float], at_once: int) -> Iterator[tuple[Ints, ...]]:
    """Where in an array of lower bounds those up to a limit are, the least first, at most so many at a time.

    The limit sinks while they are looked at, and is asked again each time. Where it is infinite, the least comes by
    itself first, and later once more.
    """
    if not bounds.size:
        return
    if np.isinf(limit()):
        yield tuple(np.array([place]) for place in np.unravel_index(bounds.argmin(), bounds.shape))
    near = np.flatnonzero(bounds <= limit())
    near = near[np.argsort(bounds.ravel()[near], kind="stable")]
    for start in range(0, len(near), at_once):
        some = near[start : start + at_once]
        some = some[bounds.ravel()[some] <= limit()]
        if not len(some):
            return
        yield np.unravel_index(some, bounds.shape)
