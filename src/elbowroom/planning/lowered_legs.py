"""The legs of a body that crouches: knees that come forward and aside, hips that go down and back, among the boxes.

The root's path is planned for upright legs. How deep the body crouches on it is chosen with the waist, so legs and
pelvis have to be looked at again where it does. That depends on the lowering and on the root's state alone.
"""

from copy import copy

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup, limits
from elbowroom.body.kinematics import BodyModel, leg_capsules
from elbowroom.planning.root_path import RootPath, sample_states
from elbowroom.world.boxes import BOX_ROW, Boxes
from elbowroom.world.clearance import clearance
from elbowroom.world.moving import MovingBoxes

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]

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
        ground = corners[low][:, :, [0, 2]]
        self._table = np.ascontiguousarray(boxes.table[low])
        self._least, self._most = ground.min(axis=1), ground.max(axis=1)
        self._sweeps, self._interval = np.empty((1, 0, BOX_ROW)), 1.0

    def among(self, moving: MovingBoxes, path: RootPath) -> "LoweredLegs":
        """The same legs where something moves besides, along a path."""
        if not len(moving):
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
        if not len(lowered):
            return out
        self._lower_to_standing(out, roots, lowerings, lowered)
        if self._sweeps.shape[1]:
            times = np.zeros(len(lowered)) if after is None else after[lowered]
            spans = np.clip((times / self._interval).astype(np.int64), 0, len(self._sweeps) - 1)
            for span in np.unique(spans):
                self._lower_to(self._sweeps[span], out, roots, lowerings, lowered[spans == span])
        return out

    def _lower_to_standing(self, out: Floats32, roots: Floats, lowerings: Floats, lowered: Indices) -> None:
        """Lower `out` to the clearance of what stands near."""
        places = roots[lowered, :2]
        near = (self._least <= places.max(axis=0) + self._reach) & (self._most >= places.min(axis=0) - self._reach)
        self._lower_to(self._table[near.all(axis=1)], out, roots, lowerings, lowered)

    def _lower_to(self, rows: Floats, out: Floats32, roots: Floats, lowerings: Floats, lowered: Indices) -> None:
        """Lower `out` to the clearance of boxes, rows (B, 15), where the body is lowered."""
        if not len(rows):
            return
        # at the origin, so that single precision holds anywhere
        table, states, origin = rows.copy(), roots[lowered].copy(), roots[lowered[0], :2].copy()
        states[:, :2] -= origin
        table[:, [0, 2]] -= origin
        legs = leg_capsules(self._model, states, lowerings[lowered])
        found = clearance(legs, self._model.roots.radii, table.astype(np.float32))
        out[lowered] = np.minimum(out[lowered], found)

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
        share = np.arange(_SHOWN) / _SHOWN
        times = (np.arange(path.horizon)[:, None] + share) * path.interval
        roots = sample_states(path.states, path.interval, times.ravel())
        lowerings = np.clip(_curve(keys, path.interval * velocities, share), 0.0, None)
        found = self.clearances(roots, lowerings.ravel(), times.ravel()).reshape(path.horizon, _SHOWN)
        blocked: Bools = found.min(axis=1) < margin
        return blocked


def _curve(keys: Floats, slopes: Floats, u: Floats) -> Floats:
    """Cubic Hermite curves (n, S) through `keys` (n+1,) with `slopes` (n+1,) for each interval, at shares `u` (S,)."""
    a, b, m, n = keys[:-1, None], keys[1:, None], slopes[:-1, None], slopes[1:, None]
    curve: Floats = a + u * (m + u * (3.0 * (b - a) - 2.0 * m - n + u * (2.0 * (a - b) + m + n)))
    return curve


def _extent(model: BodyModel) -> tuple[float, float]:
    """How far lowered legs may reach from the root on the ground, and how high they come, with a little to spare."""
    roots = np.zeros((64, 7))
    roots[:, 3], roots[:, 6] = _SPEED, np.arange(64) / 32.0
    segments = leg_capsules(model, roots, np.repeat([0.0, _DEEP], 32)).reshape(-1, 2, 3, 64)
    radii = model.roots.radii[:, None, None]
    aside = np.linalg.norm(segments[:, :, [0, 2]], axis=2) + radii
    return float(aside.max()) + _SPARE, float((segments[:, :, 1] + radii).max()) + _SPARE
