"""How far a root path is free for legs and pelvis: at dense samples of its motion and of a stop from each key frame."""

import math
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.planning.root.legs.hull import states_to_check, to_check
from elbowroom.planning.root.legs.leg_cache import KnownLegs
from elbowroom.planning.root.legs.lower_body import LowerBody, Neighbours
from elbowroom.planning.root.legs.moving_legs import MovingAround
from elbowroom.planning.root.motion import MotionBounds, dense_states, stopping_states

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

_STRIDE = 0.1  # metres that a knee or a heel comes out of where it stands
_SWING = 4.0  # times as fast as the root goes no part of a leg moves
_GRAZE = 0.002  # metres that who goes along something may come nearer


class LegCheck:
    """How legs are checked, of one body: what does not change from plan to plan, and what is known by now."""

    def __init__(self, body: LowerBody, bounds: MotionBounds, skin: float, spacing: float) -> None:
        """`skin` is the clearance to ask for in metres, `spacing` the seconds between samples."""
        self.body, self.bounds, self.skin, self.spacing = body, bounds, skin, spacing
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

    def _rooms_along(self, states: Floats, numbers: Indices, owner: Indices) -> Floats32:
        """The clearance (N,) in states (N, 7) of motions: every second one is posed, and those between where it counts.

        States with following `numbers` (N,) and the same `owner` (N,) follow each other. From one to the next no foot
        comes as far as those that are left out are free at both sides; these are infinite.
        """
        check = self._check
        fastest = np.abs(states[:, 3:6]).max(axis=0, initial=0.0)
        far = check.skin + check.spacing * (_SWING * (fastest[0] + fastest[1]) + check.body.reach * fastest[2])
        clear = np.full(len(states), np.inf, np.float32)
        clear[::2] = self.rooms(states[::2], far)
        between = np.arange(1, len(states), 2)
        roomy = (clear[between - 1] >= far) & (numbers[between - 1] == numbers[between] - 1)
        roomy &= owner[between - 1] == owner[between]
        inner = between + 1 < len(states)
        after = np.where(inner, between + 1, between - 1)
        roomy &= inner & (clear[after] >= far) & (numbers[after] == numbers[between] + 1)
        doubt = between[~(roomy & (owner[after] == owner[between]))]
        clear[doubt] = self.rooms(states[doubt], check.skin)
        return clear

    def _to_check(self, states: Floats, skin: float) -> tuple[Bools, Bools]:
        """Which key intervals, and which stops from their ends, may come within `skin` of what stands."""
        bounds = self._check.bounds
        return to_check(
            states, self._interval, bounds.braking, bounds.turn_acceleration, skin, self._check.body.hull,
            self._near.ground,
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
        """The number of leading key intervals that no standing box is in, with a free stop from the end of each."""
        kept = len(states) - 1
        if self._near.empty:
            return kept
        moving, stopping = self._to_check(states, self._check.skin)
        if moving.any():
            kept = self._before_contact(states, moving, stops=False)
        if stopping[:kept].any():
            kept = self._before_contact(states[: kept + 1], stopping[:kept], stops=True)
        return kept

    def _before_contact(self, states: Floats, wanted: Bools, *, stops: bool) -> int:
        """The number of key intervals before the first of those `wanted` (n,) that touches, or whose stop does."""
        rows = [row.tobytes() for row in states]
        ends = rows[1:] if stops else [a + b for a, b in pairwise(rows)]
        names = [(self._interval, bits) for bits in ends]
        found, fresh = self._check.known.recalled(names, wanted, self._skin)
        if fresh.any():
            spacing, bounds = self._check.spacing, self._check.bounds
            if stops:
                shown, owner = stopping_states(states, self._interval, bounds, spacing, fresh)
            else:
                shown, owner = dense_states(states, self._interval, spacing, fresh)
            near = np.flatnonzero(states_to_check(shown, self._check.skin, self._check.body.hull, self._near.ground))
            np.minimum.at(found, owner[near] - 1, self._rooms_along(shown[near], near, owner[near]))
            self._check.known.learn(names, fresh, found)
        touching = np.flatnonzero(found < self._skin)
        return int(touching[0]) if len(touching) else len(wanted)
