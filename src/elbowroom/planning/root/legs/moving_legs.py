"""Legs and pelvis among what moves: each moment of a path is held against what is swept around it."""

import math
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.pose.kinematics import leg_capsules
from elbowroom.jit import kernel
from elbowroom.planning.root.legs.hull import boxes_below
from elbowroom.planning.root.legs.lower_body import LowerBody
from elbowroom.planning.root.legs.neighbours import Neighbours
from elbowroom.world.obstacles.clearance import clearance_into
from elbowroom.world.obstacles.from_above import ball_radii, gaps_from_above, places_of
from elbowroom.world.obstacles.layout import Spans
from elbowroom.world.obstacles.rows import at_span, corners_of, grown_aside, some_of, span_count, span_of, spans_of
from elbowroom.world.obstacles.tracks.moving import Moving

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_AFTER = 6  # key intervals beyond a path's end in which a stop may last
_STAYS = 0.25  # metres: what moves less during a plan stands
_POLITE = 0.08  # metres that are kept from what may move
_LATE = 1e-6  # of a key interval


@kernel
def _clearances(segments: Floats32, radii: Floats32, swept: Spans, spans: Longs) -> Floats32:
    """The clearance (N,) of capsules (C, 6, N), each posture from what is there in its span (N,); spans ascend."""
    count, first = spans.shape[0], 0
    out = np.empty(count, np.float32)
    while first < count:
        last = first + 1
        while last < count and spans[last] == spans[first]:
            last += 1
        own = segments[:, :, first:last].copy()
        clearance_into(own, radii, at_span(swept, spans[first]), out[first:last])
        first = last
    return out


class MovingAround:
    """What moves during one plan, in spans of a key interval.

    They begin at multiples of it whenever a plan begins: so what was free in one plan is free in the next.
    """

    def __init__(self, body: LowerBody, moving: Moving, begin: float, horizon: int, interval: float) -> None:
        self._body, self._moving, self._horizon, self._interval = body, moving, horizon, interval
        self._first = math.floor(begin / interval + _LATE)  # the number of the first span
        self._ahead = begin - self._first * interval  # seconds since that began

    def __bool__(self) -> bool:
        return len(self._moving) > 0

    @cached_property
    def _swept(self) -> Spans:
        """What each obstacle sweeps in each span: boxes."""
        return self._moving.swept(self._interval * (self._first + np.arange(self._horizon + _AFTER + 2.0)))

    @cached_property
    def _reach(self) -> Floats:
        """How far from an obstacle's middle legs may be that touch it, (spans, B) metres."""
        reach: Floats = ball_radii(self._swept) + self._body.reach
        return reach

    def clearance(self, states: Floats, after: Floats) -> Floats32:
        """Clearance (N,) of legs and pelvis at root states (N, 7), `after` (N,) seconds from the plan's beginning."""
        out = np.full(len(states), np.inf, np.float32)
        if not len(states) or not self:
            return out
        spans = self._spans(after)
        away = np.hypot(*np.moveaxis(places_of(self._swept)[spans] - states[:, None, :2], -1, 0))  # (N, B)
        near = np.flatnonzero((away < self._reach[spans]).any(axis=1))
        if not len(near):
            return out
        segments = leg_capsules(self._body.model, states[near])
        out[near] = _clearances(segments, self._body.radii, self._swept, spans[near])
        return out

    def _spans(self, after: Floats) -> Longs:
        """The spans (N,) in which times (N,) after the plan's beginning are; the earlier one where two meet."""
        spans: Longs = np.ceil((self._ahead + after) / self._interval - _LATE).astype(np.int64) - 1
        return np.clip(spans, 0, span_count(self._swept) - 1)

    @cached_property
    def standing(self) -> Neighbours:
        """What could move but stays where it is for now, a little larger: there are detours it as round walls."""
        stays = np.all(np.ptp(places_of(self._swept), axis=0) < _STAYS, axis=1)
        staying = some_of(span_of(grown_aside(self._swept, _POLITE), 0), stays)
        corners = corners_of(staying)
        low = corners[:, :, 1].min(axis=1) < self._body.height
        return Neighbours(some_of(staying, low), boxes_below(corners[low], self._body.height))

    def gap(self, states: Floats, radius: float, height: float) -> float:
        """The least distance, metres, of an upright cylinder from what moves, at the key states (n+1, 7) of a path.

        It is checked from above; what passes overhead is left out. Infinite where nothing moves.
        """
        spans = self._spans(self._interval * np.arange(1.0, len(states)))
        gaps = gaps_from_above(spans_of(self._swept, spans), states[1:, :2], height)
        return float(gaps.min(initial=np.inf)) - radius
