"""A recorded swing on a body that is not the recorded one: arms are lifted out of hips and trunk.

A stride fits the build that it was recorded on. On broader hips, a thicker trunk or a bigger head its hands would pass
through them. So at each phase the arms are abducted, as little as it takes, until they keep as clear of the body as in
the stock walk; where that is not enough they go a part of the way back to the arm at rest.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, CHILDREN, SEARCH_ORDER, DofGroup, clamp, side_by_side
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import BodyModel, body_model
from elbowroom.body.root import ROOT_STATE
from elbowroom.clips.motion_set import MotionSet
from elbowroom.clips.swing import KEYS, Swing, resting
from elbowroom.planning.model.self_pairs import SelfPairs, self_clearances, self_pairs
from elbowroom.planning.shared import Shared

Floats = NDArray[np.float64]

_ABDUCTION = 1  # component of an arm
_LIFTS = np.deg2rad(np.arange(0.0, 42.0, 2.0))  # by which an arm may be abducted, the least first
_EASES = (0.0, 0.25, 0.5, 0.75, 1.0)  # parts of the way back to rest, the least first
_SPREAD, _SMOOTH = 5, 1.5  # keys to which a change reaches, and over which it is smoothed


_FITTED: Shared[MotionSet] = Shared()


def fitted(motions: MotionSet, humanoid: Humanoid) -> MotionSet:
    """The same motions with a swing that suits this body, the same ones for all who ask."""
    swing = motions.swing
    if swing is None:
        return motions

    def fit() -> MotionSet:
        model = body_model(humanoid)
        return replace(motions, swing=_fitted(swing, model, self_pairs(model)))

    return _FITTED.get((motions, humanoid), fit)


def _fitted(swing: Swing, model: BodyModel, pairs: SelfPairs) -> Swing:
    lifts, eases = np.zeros((2, KEYS)), np.zeros((2, KEYS))
    settled = np.zeros((2, KEYS), np.bool_)
    for ease in _EASES:
        for lift in _LIFTS:
            clear = _clear(swing, model, pairs, np.full((2, KEYS), lift), np.full((2, KEYS), ease)) & ~settled
            lifts[clear], eases[clear] = lift, ease
            settled |= clear
        if settled.all():
            break
    eases[~settled] = 1.0
    return replace(swing, keys=_changed(swing, _smooth(lifts), _smooth(eases)))


def _clear(swing: Swing, model: BodyModel, pairs: SelfPairs, lifts: Floats, eases: Floats) -> NDArray[np.bool_]:
    """Whether each arm, and those that must keep clear of it, keep clear at each key, (2, KEYS)."""
    roots = np.zeros((KEYS, ROOT_STATE))
    roots[:, 3], roots[:, 6] = swing.speed, np.arange(KEYS) / KEYS
    keys = _changed(swing, lifts, eases)
    uppers = side_by_side(keys)[:KEYS]
    clear = self_clearances(model, pairs, roots, uppers) >= 0.0
    beside = [
        [SEARCH_ORDER.index(other) for other in CHILDREN if other is arm or arm in other.clear_of] for arm in ARMS
    ]
    return np.stack([np.logical_and.reduce(clear[rows]) for rows in beside])


def _smooth(change: Floats) -> Floats:
    """The same and more, without jumps along the stride."""
    # Takes a tenth of a start to import, and most walk with the stock swing.
    from scipy.ndimage import gaussian_filter1d, maximum_filter1d

    spread = maximum_filter1d(change, _SPREAD, axis=1, mode="wrap")
    smooth: Floats = gaussian_filter1d(spread, _SMOOTH, axis=1, mode="wrap")
    return smooth


def _changed(swing: Swing, lifts: Floats, eases: Floats) -> dict[DofGroup, Floats]:
    """The keys with the arms eased towards rest and lifted, each (2, KEYS) of left and right arm."""
    keys = dict(swing.keys)
    for group, lift, ease in zip(ARMS, lifts, eases, strict=True):
        rows = keys[group] + np.append(ease, ease[0])[:, None] * (resting(group) - keys[group])
        rows[:, _ABDUCTION] += np.append(lift, lift[0])
        keys[group] = clamp(group, rows)
    return keys
