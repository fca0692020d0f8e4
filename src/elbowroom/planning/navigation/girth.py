"""How much room somebody takes who walks: what a map of room is read with."""

from typing import NamedTuple

import numpy as np

from elbowroom.body.dof import DOF
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, leg_capsules, posture_capsules
from elbowroom.body.root import ROOT_STATE

_WALK, _PHASES = 1.1, 32  # m/s; moments of a stride
_STOOPED = 0.62  # of the height: lower than this the deepest duck is no help
_BOWED = 0.8  # the same on a steep stair, where thighs rise high: the trunk bends no lower over them
_MAP_ERROR = 0.02  # metres by which a map may say too little between its points


class Girth(NamedTuple):
    """Metres."""

    slim: float  # room to each side without which legs do not pass; above them a body turns and folds
    stooped: float  # what hangs no lower is ducked under
    bowed: float  # the same on a steep stair
    tall: float


def girth_of(humanoid: Humanoid) -> Girth:
    """What one avatar takes."""
    model = body_model(humanoid)
    roots = np.zeros((_PHASES, ROOT_STATE))
    roots[:, 3], roots[:, 6] = _WALK, np.arange(_PHASES) / _PHASES
    aside = np.abs(leg_capsules(model, roots)[:, [0, 3]]).max(axis=(1, 2)) + model.roots.radii
    standing = posture_capsules(model, np.zeros((1, DOF)), np.zeros((1, ROOT_STATE)))
    tall = float((standing[:, [1, 4], 0].max(axis=1) + model.body.radii).max())
    return Girth(float(aside.max()) - _MAP_ERROR, _STOOPED * tall, _BOWED * tall, tall)
