"""Whether a shown motion runs into the avatar's own body, at any moment.

It is looked at as closely as need be (`own_looks`). An interval that was looked at for an earlier plan is known by its
content.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.kinematics import BodyModel
from elbowroom.body.whole_body import whole_body
from elbowroom.held import hold
from elbowroom.planning.exact.content import names_of
from elbowroom.planning.exact.own_looks import OwnParts, least_gaps
from elbowroom.planning.root_path import RootPath
from elbowroom.planning.self_pairs import SelfPairs

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

_UNSEEN = 2e-4  # metres by which parts may come nearer between two of the last looks
_AFAR = 2.0  # times as much room is left far ahead: what was free from afar stays free when it is near
_SOON = 4  # key intervals ahead until which a motion is near
_REMEMBERED = 4096  # intervals


class OwnMotion:
    """One avatar's motion among its own parts."""

    def __init__(self, model: BodyModel, pairs: SelfPairs) -> None:
        self._parts = hold(OwnParts(whole_body(model), pairs.first, pairs.second, pairs.kinds, pairs.limits))
        self._known: dict[bytes, tuple[int, float]] = {}  # the arm that comes nearest, and its gap

    def contacts(self, path: RootPath, keys: Floats, rates: Floats, chosen: Bools, ahead: int) -> Indices:
        """The arm, 0 or 1, that runs into the body in each chosen interval (n,) of a shown motion, or -1.

        `keys` (n+1, 11) and `rates` (n+1, 11) are the upper body and its velocity at the key times, the first of which
        is `ahead` key intervals from now. An interval that was looked at for an earlier plan is known by its content.
        It leaves room for what no look sees, and farther ahead as much again.
        """
        at: list[int] = np.flatnonzero(chosen).tolist()
        names = names_of(path.states, keys, rates, at, 2)
        if len(self._known) > _REMEMBERED:
            self._known.clear()
        missing = [(k, name) for k, name in zip(at, names, strict=True) if name not in self._known]
        if missing:
            intervals = np.array([k for k, _ in missing])
            gaps = least_gaps(self._parts, path.states, keys, rates, path.interval, intervals)
            for (_, name), (left, right, both) in zip(missing, gaps.T.tolist(), strict=True):
                self._known[name] = (0, left) if left <= min(right, both) else (1, min(right, both))
        found = np.full(path.horizon, -1)
        for k, name in zip(at, names, strict=True):
            arm, gap = self._known[name]
            if gap < _UNSEEN * (1.0 if ahead + k < _SOON else _AFAR):
                found[k] = arm
        return found
