"""What playback will show if key frames are handed to it: the same curves, sampled densely."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.interpolation import hermite, monotone_tangents
from elbowroom.planning.motion import Lead
from elbowroom.planning.root_path import RootPath, sample_states

Floats = NDArray[np.float64]

_SAME_TIME = 1e-9  # seconds


class Moments(NamedTuple):
    """The moments at which a plan's motion is looked at: L in the lead, then S to a key interval."""

    lead: int  # L
    samples: int  # S
    knots: Floats  # (m,) key times of the curve in seconds from now; the plan's first key frame is the last but n
    times: Floats  # (L + n S + 1,) seconds from now
    roots: Floats  # (L + n S + 1, 7)


def moments_of(path: RootPath, lead: Lead, samples: int) -> Moments:
    """The moments of `path` after `lead`."""
    count = len(lead.roots)
    own = path.interval / samples * np.arange(path.horizon * samples + 1.0)
    keys = lead.duration + path.interval * np.arange(path.horizon + 1.0)
    knots = keys if lead.duration <= _SAME_TIME else np.concatenate([[0.0], keys])
    before = lead.duration / max(count, 1) * np.arange(count)
    roots = np.concatenate([lead.roots, sample_states(path.states, path.interval, own)])
    return Moments(count, samples, knots, np.concatenate([before, lead.duration + own]), roots)


def shown_motion(moments: Moments, now: Floats, velocity: Floats, keys: Floats) -> Floats:
    """The configurations (M, d) shown at the moments for key frames `keys` (n+1, d), from `now` (d,) at `velocity`."""
    after = keys if len(moments.knots) > len(keys) else keys[1:]
    return _sampled(moments.knots, np.concatenate([now[None], after]), velocity, moments.times)


@exact_kernel
def _sampled(knots: Floats, values: Floats, velocity: Floats, times: Floats) -> Floats:
    tangents = monotone_tangents(knots, values, velocity)
    out = np.empty((times.shape[0], values.shape[1]))
    for i in range(times.shape[0]):
        out[i] = hermite(knots, values, tangents, times[i])[0]
    return out
