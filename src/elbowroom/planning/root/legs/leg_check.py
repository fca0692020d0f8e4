"""How far a root path is free for legs and pelvis: at dense samples of its motion and of a stop from each key frame."""

import math
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.planning.root.legs.along_path import PathLooks, free_part
from elbowroom.planning.root.legs.hull import to_check
from elbowroom.planning.root.legs.leg_cache import KnownLegs
from elbowroom.planning.root.legs.lower_body import LowerBody
from elbowroom.planning.root.legs.moving_legs import MovingAround
from elbowroom.planning.root.legs.neighbours import Neighbours
from elbowroom.planning.root.motion import MotionBounds, dense_states

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]

_STRIDE = 0.1  # metres that a knee or a heel comes out of where it stands
_GRAZE = 0.002  # metres that who goes along something may come nearer


class LegCheck:
    """How legs are checked, of one body: what does not change from plan to plan, and what is known by now."""

    def __init__(self, body: LowerBody, bounds: MotionBounds, skin: float, spacing: float) -> None:
        """`skin` is the clearance to ask for in metres, `spacing` the seconds between samples."""
        self.body, self.bounds, self.skin, self.spacing = body, bounds, skin, spacing
        self.looks = PathLooks(body.legs, body.hull, bounds, skin, spacing)
        self.known = KnownLegs()

    def reset(self) -> None:
        """Forget what is known."""
        self.known = KnownLegs()


class FreeLegs:
    """Tells of paths from one start how much of each is free, among what stands and what moves."""

    def __init__(
        self, check: LegCheck, near: Neighbours, around: MovingAround, start: RootState, interval: float
    ) -> None:
        """`near` are all that stand within reach of the paths, `interval` is the seconds between key frames."""
        self._check, self._near, self._around = check, near, around
        self._start, self._interval = start, interval
        self.checks = 0  # postures whose clearance was computed

    def kept(self, states: Floats) -> int:
        """The number of leading key intervals of a path (n+1, 7) that are free, with a free stop from each end."""
        kept = self._kept_in_motion(states) if self._around else len(states) - 1
        return min(kept, self._kept_at_rest(states))

    def touches(self, states: Floats) -> bool:
        """Whether a path overlaps with what stands, stops aside."""
        if self._near.empty:
            return False
        shown, _ = dense_states(states, self._interval, self._check.spacing, np.ones(len(states) - 1, np.bool_))
        return bool(np.any(self.rooms(shown, self._check.skin) < 0.0))

    @property
    def close(self) -> bool:
        """Whether something stands so close by that a stride may have no room."""
        standing = np.array([self._start, self._start])
        return not self._near.empty and bool(self._to_check(standing, _STRIDE)[0].any())

    def leaves(self, states: Floats) -> bool:
        """Whether a path ends no nearer to what stands than it begins."""
        first, last = self.rooms(states[[0, -1]])
        return bool(last > first - _GRAZE)

    @cached_property
    def _skin(self) -> float:
        """The clearance to ask for: less where the start has little."""
        full, standing = self._check.skin, np.array([self._start, self._start])
        if self._near.empty or not self._to_check(standing, 2.0 * full)[0].any():
            return full
        return min(full, max(0.5 * float(self.rooms(standing[:1])[0]), 0.0))

    def rooms(self, states: Floats, farthest: float = math.inf) -> Floats32:
        """The clearance (N,) of legs and pelvis from what stands, in states (N, 7); no more than `farthest` metres."""
        if not len(states):
            return np.empty(0, np.float32)
        self.checks += len(states)
        return self._check.body.clearance(self._near, states, self._check.skin, farthest)

    def _to_check(self, states: Floats, skin: float) -> tuple[Bools, Bools]:
        """Which key intervals, and which stops from their ends, may come within `skin` of what stands."""
        bounds = self._check.bounds
        return to_check(
            states, self._interval, bounds.braking, bounds.turn_acceleration, skin, self._check.body.hull,
            self._near.boxes,
        )  # fmt: skip

    def _kept_in_motion(self, states: Floats) -> int:
        """The number of leading key intervals that nothing that moves comes into."""
        horizon = len(states) - 1
        shown, owner = dense_states(states, self._interval, self._check.spacing, np.ones(horizon, np.bool_))
        after = self._interval * horizon / len(shown) * np.arange(1.0, len(shown) + 1.0)
        self.checks += len(shown)
        clear = self._around.clearance(shown, after)
        touching = owner[clear < min(self._skin, max(0.5 * float(clear[0]), 0.0))]
        return int(touching[0]) - 1 if len(touching) else horizon

    def _kept_at_rest(self, states: Floats) -> int:
        """The number of leading key intervals that nothing stands in, with a free stop from the end of each."""
        if self._near.empty:
            return len(states) - 1
        check = self._check
        known, names = check.known.recalled(self._interval, states)
        kept, posed = free_part(check.looks, self._along(states), states, self._interval, self._skin, known)
        check.known.learn(names, known)
        self.checks += posed
        return kept

    def _along(self, states: Floats) -> Neighbours:
        """Those that legs may come to on a path (n+1, 7), and in a stop from anywhere on it."""
        body, speed = self._check.body, float(np.hypot(states[:, 3], states[:, 4]).max())
        stop = 0.5 * speed * speed / self._check.bounds.braking + speed * self._interval
        low, high = body.footing.heights(states)
        return self._near.around(states[:, :2], body.reach + self._check.skin + stop, (low - stop, high + stop))
