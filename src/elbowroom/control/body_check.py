"""The last word before a pose is shown: how far the whole body is from every obstacle."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model, posture_capsules
from elbowroom.world.clearance import clearance_of
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]


def configuration(root: Floats, upper: Floats) -> Floats:
    """The configuration `q` (13,) of a root state (7,) and an upper body (10,)."""
    return np.concatenate([root[:3], upper])


class BodyCheck:
    """Clearance of a humanoid's whole collision body in a scene."""

    def __init__(self, humanoid: Humanoid, scene: Scene) -> None:
        self._model = body_model(humanoid)
        self._radii = humanoid.capsules.radii.astype(np.float32)
        self._table = scene.boxes.table

    def clearance(self, root: Floats, upper: Floats) -> float:
        """Metres from the nearest obstacle, negative where the body touches, for root (7,) and upper body (10,).

        The avatar is put at the origin and the obstacles move instead, so that single precision holds anywhere.
        """
        near, table = root.copy(), self._table.copy()
        near[:2] = 0.0
        table[:, 0] -= root[0]
        table[:, 2] -= root[1]
        segments = posture_capsules(self._model, configuration(near, upper)[None], near[None])
        return clearance_of(segments[:, :, 0], self._radii, table)
