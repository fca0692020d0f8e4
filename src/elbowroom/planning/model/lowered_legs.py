"""The legs of a body that crouches: knees that come forward and aside, hips that go down and back, among the boxes.

The root's path is planned for upright legs. How deep the body crouches on it is chosen with the waist, so legs and
pelvis have to be looked at again where it does. That depends on the lowering and on the root's state alone.
"""

from copy import copy

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup, limits
from elbowroom.body.kinematics import BodyModel, leg_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.jit import exact_kernel
from elbowroom.planning.root.path import RootPath, ground_covered, interpolate_between, rates_at, sample_states
from elbowroom.world.boxes import BOX_ROW, Boxes
from elbowroom.world.clearance import clearance
from elbowroom.world.moving import MovingBoxes

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

_LEAST = 1e-3  # of a lowering that is looked at: less than a millimetre
_SPEED = 2.2  # m/s: a run, in which legs reach farthest
_DEEP = float(limits(DofGroup.WAIST)[2, 1])
_SPARE = 0.1  # metres beyond the reach of the legs
_AROUND = 5  # moments that are looked at around a key time
_SHOWN = 12  # shown moments of a key interval


class LoweredLegs:
    """Legs and pelvis of one humanoid in one scene; frozen once made."""

    def __init__(self, model: BodyModel, boxes: Boxes) -> None:
        self._model = model
        self._reach, height = _extent(model)
        corners = boxes.corners
        low = corners[:, :, 1].min(axis=1, initial=np.inf) < height
        ground = np.ascontiguousarray(corners[low][:, :, [0, 2]])
        self._table = np.ascontiguousarray(boxes.table[low])
        self._least, self._most = ground.min(axis=1), ground.max(axis=1)
        self._sweeps, self._interval = np.empty((1, 0, BOX_ROW)), 1.0

    def among(self, moving: MovingBoxes, path: RootPath) -> "LoweredLegs":
        """The same legs where something moves besides, along a path."""
        if not moving.tracks:
            return self
        made = copy(self)
        made._sweeps, made._interval = moving.swept(path.times), path.interval
        return made

    def clearances(self, roots: Floats, lowerings: Floats, after: Floats | None = None) -> Floats32:
        """Clearance (N,) at root states (N, 7) and lowerings (N,), `after` (N,) seconds on the path, or at its start.

        Infinite where upright or far from every box.
        """
        out = np.full(len(roots), np.inf, np.float32)
        lowered = np.flatnonzero(lowerings > _LEAST)
        if len(lowered):
            times = np.zeros(len(lowered)) if after is None else after[lowered]
            out[lowered] = self._crouching(roots[lowered], lowerings[lowered], times)
        return out

    def _crouching(self, roots: Floats, lowerings: Floats, after: Floats) -> Floats32:
        """`clearances` (N,) where all are lowered, N at least 1."""
        out = self._clear(_near(self._table, self._least, self._most, roots, self._reach), roots, lowerings)
        if self._sweeps.shape[1]:
            spans = np.clip((after / self._interval).astype(np.int64), 0, len(self._sweeps) - 1)
            for span in np.unique(spans):
                at = spans == span
                out[at] = np.minimum(out[at], self._clear(self._sweeps[span], roots[at], lowerings[at]))
        return out

    def _clear(self, rows: Floats, roots: Floats, lowerings: Floats) -> Floats32:
        """Clearance (N,) from boxes, rows (B, 15)."""
        if not len(rows):
            return np.full(len(roots), np.inf, np.float32)
        table, states = _about_first(rows, roots)
        return clearance(leg_capsules(self._model, states, lowerings), self._model.roots.radii, table)

    def blocked_nodes(self, path: RootPath, lowerings: Floats, margin: float) -> Bools:
        """Which of the lowerings (n+1, V) bring the legs within `margin` of a box around their key time: (n+1, V)."""
        around = np.linspace(-0.5, 0.5, _AROUND) * path.interval
        times = np.arange(len(path.states))[:, None] * path.interval + around
        times = np.clip(times, 0.0, path.horizon * path.interval)
        roots = sample_states(path.states, path.interval, times.ravel())
        states = np.repeat(roots, lowerings.shape[1], axis=0)
        each = np.repeat(lowerings[:, None], _AROUND, axis=1).ravel()
        after = np.repeat(times.ravel(), lowerings.shape[1])
        found = self.clearances(states, each, after).reshape(len(times), _AROUND, -1)
        blocked: Bools = found.min(axis=1) < margin
        return blocked

    def blocked_intervals(self, path: RootPath, keys: Floats, velocities: Floats, margin: float) -> Bools:
        """In which key intervals (n,) the curve of lowerings brings the legs within `margin` of a box.

        It leads through `keys` (n+1,) with `velocities` (n+1,), as playback shows it.
        """
        curve = np.ascontiguousarray(keys), np.ascontiguousarray(velocities)
        roots, lowerings, after, owner = _shown(path.states, path.interval, *curve)
        blocked = np.zeros(path.horizon, np.bool_)
        if len(owner):
            blocked[owner[self._crouching(roots, lowerings, after) < margin]] = True
        return blocked


@exact_kernel
def _near(table: Floats, least: Floats, most: Floats, roots: Floats, reach: float) -> Floats:
    """The rows (B, 15) of the boxes, bounds (S, 2) on the ground, that legs within `reach` of the roots may touch."""
    low_x, high_x, low_z, high_z = ground_covered(roots)
    out, count = np.empty(table.shape), 0
    for b in range(table.shape[0]):
        across = least[b, 0] <= high_x + reach and most[b, 0] >= low_x - reach
        if across and least[b, 1] <= high_z + reach and most[b, 1] >= low_z - reach:
            for c in range(table.shape[1]):
                out[count, c] = table[b, c]
            count += 1
    return out[:count]


@exact_kernel
def _about_first(rows: Floats, roots: Floats) -> tuple[Floats32, Floats]:
    """Boxes (B, 15) and root states (N, 7) about the first root's place, so that single precision holds anywhere."""
    x, z = roots[0, 0], roots[0, 1]
    table, states = rows.copy(), roots.copy()
    for b in range(table.shape[0]):
        table[b, 0] -= x
        table[b, 2] -= z
    for n in range(states.shape[0]):
        states[n, 0] -= x
        states[n, 1] -= z
    return table.astype(np.float32), states


@exact_kernel
def _shown(states: Floats, interval: float, keys: Floats, velocities: Floats) -> tuple[Floats, Floats, Floats, Indices]:
    """The shown moments of a path (n+1, 7) that are lowered by the cubic Hermite curve through keys (n+1,).

    Root states (N, 7), lowerings (N,), seconds on the path (N,) and key intervals (N,).
    """
    count = (states.shape[0] - 1) * _SHOWN
    roots, lowerings, after = np.empty((count, ROOT_STATE)), np.empty(count), np.empty(count)
    owner, used = np.empty(count, np.int64), 0
    for k in range(states.shape[0] - 1):
        a, b, m, n = keys[k], keys[k + 1], interval * velocities[k], interval * velocities[k + 1]
        rates = rates_at(states[k], states[k + 1])
        for i in range(_SHOWN):
            u = i / _SHOWN
            lowering = a + u * (m + u * (3.0 * (b - a) - 2.0 * m - n + u * (2.0 * (a - b) + m + n)))
            if lowering > _LEAST:
                interpolate_between(states[k], states[k + 1], rates, u, interval, roots[used])
                lowerings[used], after[used], owner[used] = lowering, (k + u) * interval, k
                used += 1
    return roots[:used], lowerings[:used], after[:used], owner[:used]


def _extent(model: BodyModel) -> tuple[float, float]:
    """How far lowered legs may reach from the root on the ground, and how high they come, with a little to spare."""
    roots = np.zeros((64, 7))
    roots[:, 3], roots[:, 6] = _SPEED, np.arange(64) / 32.0
    segments = leg_capsules(model, roots, np.repeat([0.0, _DEEP], 32)).reshape(-1, 2, 3, 64)
    radii = model.roots.radii[:, None, None]
    aside = np.linalg.norm(segments[:, :, [0, 2]], axis=2) + radii
    return float(aside.max()) + _SPARE, float((segments[:, :, 1] + radii).max()) + _SPARE
