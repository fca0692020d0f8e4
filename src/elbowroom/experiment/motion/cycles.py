"""The strides of a steady walk: where they begin, and what happens at each part of one."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

PARTS = 51  # moments of a stride, its beginning and its end among them


def stride_starts(phase: Floats) -> Floats:
    """The moments, in frames, at which whole strides of a walk with the gait phase (N,) begin and end."""
    whole = np.arange(np.ceil(phase[0]), np.floor(phase[-1]) + 0.5)
    starts: Floats = np.interp(whole, phase, np.arange(len(phase)))
    return starts


def in_strides(track: Floats, phase: Floats) -> Floats:
    """A track (N,) at even parts of each whole stride, (S, PARTS)."""
    starts = stride_starts(phase)
    parts = np.linspace(0.0, 1.0, PARTS)
    moments = starts[:-1, None] + parts * np.diff(starts)[:, None]
    strides: Floats = np.interp(moments, np.arange(len(track)), track)
    return strides


def mean_range(track: Floats, phase: Floats) -> float:
    """How far a track (N,) goes in a stride, in the mean over the strides; what it drifts by is taken off."""
    strides = in_strides(track, phase)
    drift = (strides[:, -1:] - strides[:, :1]) * np.linspace(0.0, 1.0, PARTS)
    return float(np.ptp(strides - drift, axis=1).mean())
