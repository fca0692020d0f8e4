"""Whether a body runs into itself: arms against trunk, head, thighs and each other."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.jit import exact_kernel
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.self_contact import axis_distance
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]

_SKIN = 0.02  # metres: capsules wrap the mesh generously, contact of their rims is no contact of bodies
_BODY = ("pelvis", "leftThigh", "rightThigh", "abdomen", "torso", "chest", "neck", "head")
_ABOVE_SHOULDER = ("neck", "head")  # the upper arm is rooted in the trunk and always touches what is below
_PARTS = ("UpperArm", "Forearm", "Hand")
_PHASES = 16


class SelfClearance:
    """Judges upper bodies of one humanoid.

    Capsules of two parts may overlap by 2 cm, or that much more than they do in the natural walk: some builds leave
    them no choice.
    """

    def __init__(self, humanoid: Humanoid) -> None:
        self._model = body_model(humanoid)
        self._pairs = _pairs(humanoid.capsules.names)
        radii = humanoid.capsules.radii
        touching = radii[self._pairs[:, 0]] + radii[self._pairs[:, 1]]
        self._allowed = np.minimum(touching, self._distances(*_natural_walk()).min(axis=0)) - _SKIN

    def clear(self, roots: Floats, uppers: Floats) -> NDArray[np.bool_]:
        """Whether root states (N, 7) with upper bodies (N, LOCAL) are clear of themselves, shape (N,)."""
        free: NDArray[np.bool_] = (self._distances(roots, uppers) >= self._allowed).all(axis=1)
        return free

    def _distances(self, roots: Floats, uppers: Floats) -> Floats:
        here = roots.copy()
        here[:, :3] = 0.0
        q = np.concatenate([here[:, :3], uppers], axis=1)
        segments = posture_capsules(self._model, q, here).astype(np.float64)
        return _pair_distances(np.ascontiguousarray(segments.transpose(2, 0, 1)), self._pairs)


def _natural_walk() -> tuple[Floats, Floats]:
    """Root states and upper bodies of a stand and of a walk at several phases."""
    states = np.zeros((2 * _PHASES, ROOT_STATE))
    states[_PHASES:, 3] = 1.1
    states[_PHASES:, 6] = np.arange(_PHASES) / _PHASES
    return states, natural_walk()(RootPath(0.0, 1.0, states))


def _pairs(names: tuple[str, ...]) -> NDArray[np.int64]:
    """Indices (P, 2) of the capsules that may run into each other; a part may have two of them."""

    def of(part: str) -> list[int]:
        return [i for i, name in enumerate(names) if name.split(" ")[0] == part]

    parts = [
        (side + part, other)
        for side in ("left", "right")
        for part in _PARTS
        for other in _BODY
        if part != "UpperArm" or other in _ABOVE_SHOULDER
    ]
    parts += [("left" + one, "right" + other) for one in _PARTS for other in _PARTS]
    return np.array([(i, j) for one, other in parts for i in of(one) for j in of(other)], np.int64)


@exact_kernel
def _pair_distances(segments: Floats, pairs: NDArray[np.int64]) -> Floats:
    """Distances (N, P) of the axes of pairs of capsules, for capsules (N, C, 6)."""
    out = np.empty((segments.shape[0], pairs.shape[0]))
    for n in range(segments.shape[0]):
        for i in range(pairs.shape[0]):
            out[n, i] = axis_distance(segments[n, pairs[i, 0]], segments[n, pairs[i, 1]])
    return out
