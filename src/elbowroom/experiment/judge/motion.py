"""The shown motion: frames as they were recorded, and the poses that a page shows between them."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF
from elbowroom.control.recordings.recording import ASSIST, RESTART, Recording, roots_of
from elbowroom.errors import InputError

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MAX_POSES = 5_000_000
_MAX_STEP = 3600.0  # seconds between two frames
_SAME = 1e-6  # part of a sub-step by which the length of a frame may be rounded


class Moments(NamedTuple):
    """Moments of a shown motion, each between two neighbouring frames or on one."""

    first: Ints  # (N,) frame before, or the frame itself
    second: Ints  # (N,) frame after
    share: Floats  # (N,) in [0, 1): how far from the first to the second
    times: Floats  # (N,) seconds

    def part(self, rows: slice) -> "Moments":
        """Some of the moments."""
        return Moments(self.first[rows], self.second[rows], self.share[rows], self.times[rows])


@dataclass(frozen=True, eq=False)
class ShownMotion:
    """Frames in the order in which they were shown."""

    times: Floats  # (F,) seconds; not decreasing
    q: Floats  # (F, DOF) see `body.dof`
    roots: Floats  # (F, SHOWN) see `body.root`, or (F, 7) without feet
    jumps: NDArray[np.bool_]  # (F,) the frame does not follow from the one before it: nothing is shown between them
    assisted: NDArray[np.bool_]  # (F,) the planner was at work
    clock: Floats | None = None  # (F,) the scene's own time, by which things move; None: the frames' times

    def __len__(self) -> int:
        return len(self.times)

    @classmethod
    def at_rate(cls, q: Floats, roots: Floats, rate: float = 60.0) -> "ShownMotion":
        """Frames (F, DOF), (F, 7) at an even rate, without a jump."""
        frames = len(q)
        return cls(np.arange(frames) / rate, q, roots, np.arange(frames) == 0, np.ones(frames, bool))

    @classmethod
    def of(cls, recording: Recording) -> "ShownMotion":
        """What a recording shows, up to its last whole chunk; raises `InputError` where it shows nothing."""
        steps = recording.steps()
        if len(steps) == 0:
            raise InputError(f"{recording.path}: holds no frames" + _because(recording.note))
        q, dt = (np.asarray(steps[name], np.float64) for name in ("q", "dt"))
        roots = roots_of(steps)
        _check(recording.path, q.reshape(-1, DOF), roots, dt)
        jumps = (steps["flags"] & RESTART) != 0
        jumps[0] = True
        assisted, clock = (steps["flags"] & ASSIST) != 0, recording.clock(steps).ends
        return cls(np.cumsum(dt), q, roots, jumps, assisted, clock)

    def moments(self, rate: float) -> Moments:
        """Every frame, and as many even steps between neighbours as make at least `rate` poses a second.

        Raises `InputError` where that would be more than `MAX_POSES`.
        """
        steps = np.maximum(np.ceil(np.diff(self.times) * rate - _SAME), 1.0)
        steps = np.append(np.where(self.jumps[1:], 1.0, steps), 1.0)
        if steps.sum() > MAX_POSES:
            raise InputError(f"rate: {rate:g} would make {steps.sum():.0f} poses, allowed are {MAX_POSES}")
        counts = steps.astype(np.int64)
        first = np.repeat(np.arange(len(self)), counts)
        share = (np.arange(len(first)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[first]
        second = np.minimum(first + 1, len(self) - 1)
        times = self.times[first] + share * (self.times[second] - self.times[first])
        return Moments(first, second, share, times)

    def scene_times(self, moments: Moments) -> Floats:
        """The scene's own time (N,) at some moments."""
        clock = self.times if self.clock is None else self.clock
        found: Floats = clock[moments.first] + moments.share * (clock[moments.second] - clock[moments.first])
        return found

    def runs(self) -> Iterator[slice]:
        """The frames between one jump and the next."""
        starts = np.flatnonzero(self.jumps)
        for start, end in zip(starts, [*starts[1:], len(self)], strict=True):
            yield slice(int(start), int(end))


def _because(note: str | None) -> str:
    return "" if note is None else f" ({note})"


def _check(path: Path, q: Floats, roots: Floats, dt: Floats) -> None:
    wrong = ~(np.isfinite(q).all(axis=1) & np.isfinite(roots).all(axis=1) & (dt >= 0.0) & (dt <= _MAX_STEP))
    if wrong.any():
        frame = int(np.argmax(wrong))
        what = f"dt = {dt[frame]:g} s (allowed are 0 to {_MAX_STEP:g})"
        if 0.0 <= dt[frame] <= _MAX_STEP:
            what = "a pose that is not finite"
        raise InputError(f"{path}: frame {frame} has {what}")
