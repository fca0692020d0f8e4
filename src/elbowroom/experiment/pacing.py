"""Whether frames came in time, judged from what computing each of them really took."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def shown_times(costs: Floats, dt: float) -> Floats:
    """When each frame would have been shown live, seconds (n,).

    Frame i is due at `i * dt`; its computing takes `costs[i]` seconds and begins when it is due and the one before is
    done. So one slow frame delays those behind it until the delay is worked off.
    """
    shown, now = np.empty(len(costs)), 0.0
    for i, cost in enumerate(costs.tolist()):
        now = max(now, i * dt) + cost
        shown[i] = now
    return shown


def is_realtime(costs: Floats, dt: float) -> bool:
    """The paper's criterion: no second showed only one frame."""
    shown = shown_times(costs, dt)
    whole_seconds = int(shown[-1]) if len(shown) else 0
    counts = np.bincount(shown.astype(np.int64), minlength=whole_seconds)[:whole_seconds]
    return bool((counts > 1).all())


def late_frames(costs: Floats, dt: float) -> int:
    """Our criterion counts the frames shown later than one frame time after they were due."""
    return int(np.count_nonzero(shown_times(costs, dt) > np.arange(1, len(costs) + 1) * dt))
