"""Whether a shown motion runs into the avatar's own body, at any moment.

Accelerations are bounded, so it is enough to look at a key interval now and then, as long as much room is left; where
there is less, it is looked at more often. An interval that was looked at for an earlier plan is known by its content.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.kinematics import BodyModel
from elbowroom.jit import exact_kernel
from elbowroom.planning.interpolation import hermite
from elbowroom.planning.root_path import RootPath, interpolate_root
from elbowroom.planning.self_pairs import SelfPairs, self_clearances

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

# Looks of a key interval at which the body is held against itself, and the room in metres that they have to leave.
# Where there is less it is looked at more often. Between two looks dt apart a gap bends by less than a dt^2 / 8: at
# a = 340 m/s^2, what waist and arm may do to a hand, and turning, 26 mm, 3 mm and 0.2 mm.
_LOOKS = ((6, 0.04), (18, 0.003), (72, 0.0))
_UNSEEN = 2e-4  # metres by which parts may come nearer between two of the last looks
_AFAR = 2.0  # times as much room is left far ahead: what was free from afar stays free when it is near
_SOON = 4  # key intervals ahead until which a motion is near
_REMEMBERED = 4096  # intervals


class OwnMotion:
    """One avatar's motion among its own parts."""

    def __init__(self, model: BodyModel, pairs: SelfPairs) -> None:
        self.model, self.pairs = model, pairs
        self._known: dict[bytes, tuple[int, float]] = {}  # the arm that comes nearest, and its gap

    def contacts(self, path: RootPath, keys: Floats, rates: Floats, chosen: Bools, ahead: int) -> Indices:
        """The arm, 0 or 1, that runs into the body in each chosen interval (n,) of a shown motion, or -1.

        `keys` (n+1, 11) and `rates` (n+1, 11) are the upper body and its velocity at the key times, the first of which
        is `ahead` key intervals from now. An interval that was looked at for an earlier plan is known by its content.
        It leaves room for what no look sees, and farther ahead as much again.
        """
        at = np.flatnonzero(chosen)
        ends = np.concatenate([path.states[:, 3:], keys, rates], axis=1).round(6) + 0.0
        names = [row.tobytes() for row in np.concatenate([ends[at], ends[at + 1]], axis=1)]
        if len(self._known) > _REMEMBERED:
            self._known.clear()
        missing = [n for n, name in enumerate(names) if name not in self._known]
        if missing:
            gaps = self._gaps(path, keys, rates, at[missing])
            arms, least = np.minimum(gaps.argmin(axis=0), 1).tolist(), gaps.min(axis=0).tolist()
            self._known.update(zip([names[n] for n in missing], zip(arms, least, strict=True), strict=True))
        found = np.full(path.horizon, -1)
        for k, name in zip(at.tolist(), names, strict=True):
            arm, gap = self._known[name]
            if gap < _UNSEEN * (1.0 if ahead + k < _SOON else _AFAR):
                found[k] = arm
        return found

    def _gaps(self, path: RootPath, keys: Floats, rates: Floats, chosen: Indices) -> Floats32:
        """The least `self_clearances` (3, K) in each of some intervals (K,), looked at as often as need be."""
        least, near = np.full((3, len(chosen)), np.inf, np.float32), np.arange(len(chosen))
        for looks, room in _LOOKS:
            shown, states = _looked_at(path.states, keys, rates, path.interval, chosen[near], looks)
            gaps = self_clearances(self.model, self.pairs, states, shown)
            least[:, near] = gaps.reshape(3, len(near), looks).min(axis=2)
            near = np.flatnonzero((least >= 0.0).all(axis=0) & (least < room).any(axis=0))
            if not len(near):
                break
        return least


@exact_kernel
def _looked_at(
    states: Floats, keys: Floats, rates: Floats, interval: float, chosen: Indices, looks: int
) -> tuple[Floats, Floats]:
    """Upper bodies and root states at `looks` within chosen intervals (K,), in order, (K looks, ...)."""
    shown = np.empty((chosen.shape[0] * looks, keys.shape[1]))
    roots = np.empty((chosen.shape[0] * looks, states.shape[1]))
    times = np.array([0.0, interval])
    for i in range(chosen.shape[0]):
        k = chosen[i]
        for look in range(looks):
            share = (look + 1.0) / looks
            at = i * looks + look
            upper, _ = hermite(times, keys[k : k + 2], rates[k : k + 2], share * interval)
            for j in range(upper.shape[0]):
                shown[at, j] = upper[j]
            root = interpolate_root(states[k], states[k + 1], share, interval)
            for j in range(root.shape[0]):
                roots[at, j] = root[j]
    return shown, roots
