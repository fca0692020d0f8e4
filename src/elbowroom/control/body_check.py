"""The last word before a pose is shown: how far the whole body is from every obstacle."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model, posture_capsules
from elbowroom.world.clearance import clearance, clearance_of
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_BETWEEN = np.array([0.25, 0.5, 0.75])  # at 60 frames a second: 240 poses


def configuration(root: Floats, upper: Floats) -> Floats:
    """The configuration `q` (14,) of a root state (7,) and an upper body (11,)."""
    return np.concatenate([root[:3], upper])


class BodyCheck:
    """Clearance of a humanoid's whole collision body in a scene, at a time; what moves stands where it is then."""

    def __init__(self, humanoid: Humanoid, scene: Scene) -> None:
        self.model = body_model(humanoid)
        self._radii = humanoid.capsules.radii.astype(np.float32)
        self._table = scene.boxes.table
        self.moving = scene.moving

    def clearance(self, root: Floats, upper: Floats, time: float) -> float:
        """Metres from the nearest obstacle, negative where the body touches, for root (7,) and upper body (11,).

        The avatar is put at the origin and the obstacles move instead, so that single precision holds anywhere.
        """
        segments = posture_capsules(self.model, configuration(root, upper)[None], self._near(root, root)[None])
        return clearance_of(segments[:, :, 0], self._radii, self._around(root, time))

    def clearance_between(
        self, roots: tuple[Floats, Floats], uppers: tuple[Floats, Floats], times: tuple[float, float]
    ) -> float:
        """The least clearance, metres, of the poses that a screen shows between two frames: straight interpolants."""
        root = roots[0] + _BETWEEN[:, None] * (roots[1] - roots[0])
        upper = uppers[0] + _BETWEEN[:, None] * (uppers[1] - uppers[0])
        segments = posture_capsules(self.model, np.hstack([root[:, :3], upper]), self._near(root, roots[0]))
        if not len(self.moving):
            return float(clearance(segments, self._radii, self._around(roots[0], times[0])).min())
        looks = times[0] + _BETWEEN * (times[1] - times[0])
        found = [
            clearance_of(segments[:, :, i], self._radii, self._around(roots[0], float(time)))
            for i, time in enumerate(looks)
        ]
        return min(found)

    def _near(self, roots: Floats, origin: Floats) -> Floats:
        near = roots.copy()
        near[..., :2] -= origin[:2]
        return near

    def _around(self, origin: Floats, time: float) -> Floats:
        table = self._table.copy()
        if len(self.moving):
            table = np.concatenate([table, self.moving.tables([time])[0]])
        table[:, 0] -= origin[0]
        table[:, 2] -= origin[1]
        return table
