"""Whether a body that is shown keeps out of itself: in a frame, and all the way from one frame to the next.

Planners prove a motion on the legs of the walking cycle. What is shown stands and steps on feet of its own, carries
hips and chest otherwise, and its arms make way for its legs: so it is proven once more, all pairs of parts, by
`halving`, as screens have it between two frames (`body/pose/between_frames.py`).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.between_frames import FramePair, capsules_between, speeds_between
from elbowroom.body.pose.kinematics import BodyModel, body_model
from elbowroom.body.pose.whole_body import WholeBody
from elbowroom.by_reference import by_reference
from elbowroom.clips.motion_set import MotionSet
from elbowroom.jit import brief_exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.halving import begun, due, settle
from elbowroom.planning.model.axis_distances import clear_pairs
from elbowroom.planning.model.self_pairs import OVERLAP, self_pairs
from elbowroom.planning.shared import Shared

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_WALKS = 1e-3  # metres that its own walk keeps at least: it is free for everybody
_ONE = plain(1)  # part of the time at a time
_HALVINGS = plain(9)  # of the time between two frames


@by_reference
class ShownPairs(NamedTuple):
    """A body and its P pairs of parts that must not be deeper in each other than they may."""

    body: WholeBody
    first: Indices  # (P,) one capsule
    second: Indices  # (P,) and the other
    limits: Floats32  # (P,) metres: as near their axes may come


class OwnBodyCheck:
    """The parts of one avatar as they are shown; frozen."""

    def __init__(self, model: BodyModel, motions: MotionSet) -> None:
        """`motions` are those that it walks with: where they bring parts nearer than the stock walk, these may come."""
        pairs, walk = self_pairs(model), self_pairs(model, natural_walk(motions))
        limits = np.minimum(pairs.limits, walk.limits + (OVERLAP - _WALKS)).astype(np.float32)
        self._pairs = ShownPairs(model.whole, pairs.first, pairs.second, limits)

    def free_between(self, frames: FramePair) -> bool:
        """Whether no part is deeper in another than it may be, from one frame to the next; or comes out of it."""
        return bool(_proven(self._pairs, frames))


_CHECKS: Shared[OwnBodyCheck] = Shared()


def own_body_check(humanoid: Humanoid, motions: MotionSet) -> OwnBodyCheck:
    """The check of an avatar that walks with some motions: the same for all who ask."""
    return _CHECKS.get((humanoid, motions), lambda: OwnBodyCheck(body_model(humanoid), motions))


@inner_exact_kernel
def _pair_gaps(pairs: ShownPairs, chosen: Indices, axes: Floats32) -> Floats32:
    """How much nearer the parts of `chosen` pairs (K,) may come in N postures (C, 6, N): (N, K) metres."""
    gaps = np.empty((axes.shape[2], len(chosen)), np.float32)
    for k in range(len(chosen)):
        found = clear_pairs(axes[pairs.first[chosen[k]]], axes[pairs.second[chosen[k]]])
        for n in range(len(found)):
            gaps[n, k] = found[n] - pairs.limits[chosen[k]]
    return gaps


@inner_exact_kernel
def _norm(x: float, y: float, z: float) -> float:
    return math.sqrt(x * x + y * y + z * z)


@helper
def _near(pairs: ShownPairs, lengths: Floats, axes: Floats32) -> Indices:
    """The pairs (K,) that could meet as they move by `lengths` (P,): by balls round their axes at first (C, 6, 2)."""
    count, near, balls = 0, np.empty(len(lengths), np.int64), np.empty((len(axes), 4))
    for c in range(len(axes)):
        half = 0.5 * (axes[c, 3:, 0] - axes[c, :3, 0])
        balls[c, :3], balls[c, 3] = axes[c, :3, 0] + half, _norm(half[0], half[1], half[2])
    for p in range(len(lengths)):
        one, other = balls[pairs.first[p]], balls[pairs.second[p]]
        apart = _norm(one[0] - other[0], one[1] - other[1], one[2] - other[2])
        if apart < one[3] + other[3] + pairs.limits[p] + lengths[p]:
            near[count] = p
            count += 1
    return near[:count]


@helper
def _on_the_spot(frames: FramePair) -> FramePair:
    """The same without the way and the turn of the root: parts are no nearer to each other for that."""
    return FramePair(frames.place, np.zeros(frames.roots.shape), frames.joints, frames.hips, frames.arcs)


@brief_exact_kernel
def _proven(pairs: ShownPairs, shown: FramePair) -> bool:
    """Whether each pair is proven free all the way from one frame to another.

    Who is in himself already may go on to where he is no deeper.
    """
    frames = _on_the_spot(shown)
    both = capsules_between(pairs.body, frames, np.array([0.0, 1.0]))
    speeds = speeds_between(pairs.body, frames, both)
    lengths = speeds[pairs.first] + speeds[pairs.second]
    near = _near(pairs, lengths, both)
    if len(near) == 0:
        return True
    ends = _pair_gaps(pairs, near, both)
    if ends[0].min() < 0.0:
        return bool(ends[1].min() >= ends[0].min())
    parts, shares = np.empty(1, np.int64), np.empty(1)
    proof = begun(ends, lengths[near].reshape((1, len(near))), _ONE, 0.0, _HALVINGS)
    while due(proof, parts, shares) > 0:
        settle(proof, _pair_gaps(pairs, near, capsules_between(pairs.body, frames, shares)), _ONE)
    return bool(proof.least.min() >= 0.0)
