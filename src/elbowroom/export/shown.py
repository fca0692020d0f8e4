"""The frames of a recording, and which of them are shown at even steps of time."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF
from elbowroom.control.recordings.recording import RESTART, Recording, roots_of
from elbowroom.errors import InputError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MAX_STEP = 3600.0  # seconds between two frames
_ON_FRAME = 1e-6  # part of a step that is taken for rounding: such a moment is the frame itself


@dataclass(frozen=True, eq=False)
class ShownFrames:
    """Configurations and root states in the order in which they were shown."""

    times: Floats  # (N,) seconds, not decreasing
    q: Floats  # (N, DOF) see `body.dof`
    roots: Floats  # (N, SHOWN) see `body.root`; (N, ROOT_STATE) of old recordings
    jumps: NDArray[np.bool_]  # (N,) the frame does not follow from the one before it
    clock: Floats  # (N,) the scene's own time

    @classmethod
    def of(cls, recording: Recording) -> "ShownFrames":
        """What a recording shows, up to its last whole chunk; raises `InputError` where it shows nothing."""
        steps = recording.steps()
        if len(steps) == 0:
            why = "" if recording.note is None else f" ({recording.note})"
            raise InputError(f"{recording.path}: holds no frames{why}")
        dt = np.asarray(steps["dt"], np.float64)
        q = np.asarray(steps["q"], np.float64).reshape(-1, DOF)
        roots = roots_of(steps)
        good = np.isfinite(q).all(axis=1) & np.isfinite(roots).all(axis=1) & (dt >= 0.0) & (dt <= _MAX_STEP)
        if not good.all():
            frame = int(np.argmin(good))
            raise InputError(f"{recording.path}: frame {frame} is damaged: a pose or a time step is out of range")
        return cls(np.cumsum(dt), q, roots, (steps["flags"] & RESTART) != 0, recording.clock(steps).ends)

    @property
    def duration(self) -> float:
        """Seconds from the first frame to the last."""
        return float(self.times[-1] - self.times[0])

    def at_rate(self, fps: float) -> tuple[Ints, Ints, Floats]:
        """`even_moments` of these frames."""
        return even_moments(self.times, self.jumps, fps)


def even_moments(times: Floats, jumps: NDArray[np.bool_], fps: float) -> tuple[Ints, Ints, Floats]:
    """At `fps` moments a second: the frame before (F,), the frame after (F,), the share (F,) of the way.

    Frames are at `times` (N,), not decreasing. Over a jump nothing is mixed: the frame before stays until the next.
    """
    count = int((times[-1] - times[0]) * fps + _ON_FRAME) + 1
    moments = times[0] + np.arange(count) / fps
    before = np.searchsorted(times, moments + _ON_FRAME / fps, side="right") - 1
    after = np.minimum(before + 1, len(times) - 1)
    width = times[after] - times[before]
    share = np.clip((moments - times[before]) / np.maximum(width, 1e-9), 0.0, 1.0)
    share[(width <= 0.0) | jumps[after] | (share < _ON_FRAME)] = 0.0
    return before, after, share
