"""The legs of a body that crouches: knees that come forward and aside, hips that go down and back, among the obstacles.

The root's path is planned for upright legs. How deep the body crouches on it is chosen with the waist, so legs and
pelvis have to be looked at again where it does; not feet, which go as they go upright. That depends on the lowering and
on the root's state alone.
"""

import math
from copy import copy
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup, limits
from elbowroom.body.pose.kinematics import BodyModel, leg_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.jit import exact_kernel
from elbowroom.planning.model.footing import Footing
from elbowroom.planning.root.path import RootPath, ground_covered, interpolate_between, rates_at, sample_states
from elbowroom.world.ground.ground import PLAIN, Ground
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.layout import Nearby, Spans
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import about, is_empty, span_count, span_of
from elbowroom.world.obstacles.tracks.moving import Moving

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]

_LEAST = 1e-3  # of a lowering that is looked at: less than a millimetre
_SPEED = 2.2  # m/s: a run, in which legs reach farthest
_DEEP = float(limits(DofGroup.WAIST)[2, 1])
_SPARE = 0.1  # metres beyond the reach of the legs
_AROUND = 5  # moments that are looked at around a key time
_SHOWN = 12  # shown moments of a key interval


class LoweredLegs:
    """Legs and pelvis of one humanoid in one scene; frozen once made."""

    def __init__(self, model: BodyModel, obstacles: Obstacles, ground: Ground = PLAIN) -> None:
        self._model, self._obstacles, self.footing = model, obstacles, Footing(model, ground)
        self._bending = np.flatnonzero(~np.isin(np.arange(len(model.roots.radii)), self.footing.feet))
        self._reach, height = _extent(model)
        self._low = obstacles.corners[:, :, 1].min(axis=1, initial=np.inf) < (height if ground.plain else np.inf)
        self._sweeps: Spans | None = None
        self._interval = 1.0

    def among(self, others: Moving | None, path: RootPath) -> "LoweredLegs":
        """The same legs along a path, among what moves: the scene's own and others."""
        moving = self._obstacles.moving + others if others else self._obstacles.moving
        if not len(moving):
            return self
        made = copy(self)
        made._sweeps, made._interval = moving.swept(path.times), path.interval
        return made

    def stood(self, path: RootPath) -> RootPath:
        """The path with what the feet stand on at its key times; itself on plain ground."""
        return path if self.footing.plain else replace(path, states=self.footing.stood(path.states)[0])

    def clearances(
        self, roots: Floats, lowerings: Floats, after: Floats | None = None, farthest: float = math.inf
    ) -> Floats32:
        """Clearance (N,) at root states (N, 7) and lowerings (N,), `after` (N,) seconds on the path, or at its start.

        Infinite where upright. More than `farthest` metres are not told apart.
        """
        times = np.zeros(len(roots)) if after is None else after
        return self._standing(self.footing.stood(roots)[0], lowerings, times, farthest)

    def _standing(self, roots: Floats, lowerings: Floats, after: Floats, farthest: float) -> Floats32:
        """`clearances` (N,) where the feet stand in the root states (N, 7)."""
        out = np.full(len(roots), np.inf, np.float32)
        lowered = np.flatnonzero(lowerings > _LEAST)
        if len(lowered):
            out[lowered] = self._crouching(roots[lowered], lowerings[lowered], after[lowered], farthest)
        return out

    def _crouching(self, roots: Floats, lowerings: Floats, after: Floats, farthest: float) -> Floats32:
        """`clearances` (N,) where all are lowered and the feet stand, N at least 1."""
        out = self._clear(self._near(roots), roots, lowerings, farthest)
        if self._sweeps is not None:
            spans = np.clip((after / self._interval).astype(np.int64), 0, span_count(self._sweeps) - 1)
            for span in np.unique(spans):
                at = spans == span
                near = span_of(self._sweeps, span)
                out[at] = np.minimum(out[at], self._clear(near, roots[at], lowerings[at], farthest))
        return out

    def _near(self, roots: Floats) -> Nearby:
        """The obstacles that legs may touch at root states (N, 7) whose feet stand."""
        low_x, high_x, low_z, high_z = ground_covered(roots)
        reach = self._reach
        heights = self.footing.over_soles(roots)
        numbers = self._obstacles.numbers_near(
            (low_x - reach, low_z - reach), (high_x + reach, high_z + reach), heights
        )
        return self._obstacles.picked(numbers[self._low[numbers]])

    def _clear(self, near: Nearby, roots: Floats, lowerings: Floats, farthest: float) -> Floats32:
        """Clearance (N,) from obstacles; all is reckoned from the first root, so that single precision holds.

        Feet stand in the root states (N, 7).
        """
        if is_empty(near):
            return np.full(len(roots), np.inf, np.float32)
        states = roots.copy()
        states[:, :2] -= roots[0, :2]
        segments, radii = leg_capsules(self._model, states, lowerings), self._model.roots.radii
        near, bending = about(near, roots[0, 0], roots[0, 1]), self._bending
        return clearance(segments[bending], radii[bending], near, farthest)

    def blocked_nodes(self, path: RootPath, lowerings: Floats, margin: float) -> Bools:
        """Which of the lowerings (n+1, V) bring legs within `margin` of anything about their key time: (n+1, V)."""
        around = np.linspace(-0.5, 0.5, _AROUND) * path.interval
        times = np.arange(len(path.states))[:, None] * path.interval + around
        times = np.clip(times, 0.0, path.horizon * path.interval)
        roots = self.footing.stood(sample_states(path.states, path.interval, times.ravel()))[0]
        states = np.repeat(roots, lowerings.shape[1], axis=0)
        each = np.repeat(lowerings[:, None], _AROUND, axis=1).ravel()
        after = np.repeat(times.ravel(), lowerings.shape[1])
        found = self._standing(states, each, after, margin).reshape(len(times), _AROUND, -1)
        blocked: Bools = found.min(axis=1) < margin
        return blocked

    def shown(self, path: RootPath) -> Floats:
        """The root states at all moments of a path that are looked at as it is shown, with what feet stand on then.

        On treads that is dear, and the same however deep one crouches.
        """
        return self.footing.stood(_moments(path.states, path.interval))[0]

    def blocked_intervals(
        self, path: RootPath, keys: Floats, velocities: Floats, margin: float, shown: Floats | None = None
    ) -> Bools:
        """In which key intervals (n,) the curve of lowerings brings the legs within `margin` of anything.

        It leads through `keys` (n+1,) with `velocities` (n+1,), as playback shows it; `shown` are those of the path.
        """
        lowerings = _lowerings(path.interval, np.ascontiguousarray(keys), np.ascontiguousarray(velocities))
        lowered, blocked = np.flatnonzero(lowerings > _LEAST), np.zeros(path.horizon, np.bool_)
        if len(lowered):
            roots = (self.shown(path) if shown is None else shown)[lowered]
            owner, after = lowered // _SHOWN, (lowered // _SHOWN + lowered % _SHOWN / _SHOWN) * path.interval
            clear = self._crouching(roots, lowerings[lowered], after, margin)
            blocked[owner[clear < margin]] = True
        return blocked


@exact_kernel
def _moments(states: Floats, interval: float) -> Floats:
    """The root states (n _SHOWN, ROOT_STATE) at the shown moments of a path (n+1, 7)."""
    roots = np.empty(((states.shape[0] - 1) * _SHOWN, ROOT_STATE))
    for k in range(states.shape[0] - 1):
        rates = rates_at(states[k], states[k + 1])
        for i in range(_SHOWN):
            interpolate_between(states[k], states[k + 1], rates, i / _SHOWN, interval, roots[k * _SHOWN + i])
    return roots


@exact_kernel
def _lowerings(interval: float, keys: Floats, velocities: Floats) -> Floats:
    """Those at the shown moments (n _SHOWN,) on the cubic Hermite curve through keys (n+1,) with velocities (n+1,)."""
    found = np.empty((keys.shape[0] - 1) * _SHOWN)
    for k in range(keys.shape[0] - 1):
        a, b, m, n = keys[k], keys[k + 1], interval * velocities[k], interval * velocities[k + 1]
        for i in range(_SHOWN):
            u = i / _SHOWN
            found[k * _SHOWN + i] = a + u * (m + u * (3.0 * (b - a) - 2.0 * m - n + u * (2.0 * (a - b) + m + n)))
    return found


def _extent(model: BodyModel) -> tuple[float, float]:
    """How far lowered legs may reach from the root on the ground, and how high they come, with a little to spare."""
    roots = np.zeros((64, ROOT_STATE))
    roots[:, 3], roots[:, 6] = _SPEED, np.arange(64) / 32.0
    segments = leg_capsules(model, roots, np.repeat([0.0, _DEEP], 32)).reshape(-1, 2, 3, 64)
    radii = model.roots.radii[:, None, None]
    aside = np.linalg.norm(segments[:, :, [0, 2]], axis=2) + radii
    return float(aside.max()) + _SPARE, float((segments[:, :, 1] + radii).max()) + _SPARE
