"""What counts as the ground under the feet: how much of a foot may be in what it stands on.

In a walk on level ground a foot is on it, and a little of what stands for it is in it: of the capsule, which is larger
than the foot, and of the mesh where a heel strikes. Where feet stand on obstacles the same is allowed, and 3 mm more,
straight up: feet and toes are held against what stands as much higher as they get below level ground in the walking
cycle. So raised they must be free, like everything else; only the soles may be in what they stand on.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import HEIGHT, ROOT_STATE
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.poses import Posed, Poser
from elbowroom.experiment.judge.skin import Skin

Floats = NDArray[np.float64]

IN_GROUND = 0.003  # metres that a sole may be in what it stands on
_FEET = ("leftFoot", "leftToes", "rightFoot", "rightToes")
_SPEEDS, _PHASES = np.linspace(0.0, 1.6, 5), np.linspace(0.0, 1.0, 64, endpoint=False)  # m/s, strides


class Soles:
    """How much higher the feet of one avatar are held against obstacles, in one motion."""

    def __init__(self, humanoid: Humanoid, poser: Poser, motion: ShownMotion) -> None:
        self._feet = [poser.skeleton.index(bone) for bone in _FEET if poser.skeleton.has(bone)]
        self._used = motion.roots.shape[1] > HEIGHT and bool(np.abs(motion.roots[:, HEIGHT:]).max(initial=0.0) > 0.0)
        self._walked = _walked(poser) if self._used else None
        self._humanoid = humanoid

    def of_capsules(self) -> float:
        """For the collision body, metres; 0 where all that is shown stands on the plane at height 0."""
        if self._walked is None:
            return 0.0
        shapes = CapsuleShapes(self._humanoid)
        placed, feet = shapes.placed(self._walked), np.isin(self._humanoid.capsules.joints, self._feet)
        lowest = placed.middles[..., 1] - np.abs(placed.half_axes[..., 1]) - shapes.radii
        return IN_GROUND + max(0.0, -float(lowest[:, feet].min()))

    def of_mesh(self, skin: Skin) -> float:
        """The same for the mesh."""
        if self._walked is None:
            return 0.0
        vertices = np.flatnonzero(np.isin(skin.joints[:, 0], self._feet))
        lowest = skin.vertices(self._walked, vertices)[..., 1].min(initial=0.0)
        return IN_GROUND + max(0.0, -float(lowest))

    def raised(self, posed: Posed, lift: float) -> Posed:
        """Poses with the feet so much higher, metres."""
        if lift <= 0.0:
            return posed
        positions = posed.positions.copy()
        positions[:, self._feet, 1] += lift
        return Posed(positions, posed.rotations)


def _walked(poser: Poser) -> Posed:
    """Walks on the plane."""
    roots = np.zeros((len(_SPEEDS) * len(_PHASES), ROOT_STATE))
    roots[:, 3], roots[:, 6] = np.repeat(_SPEEDS, len(_PHASES)), np.tile(_PHASES, len(_SPEEDS))
    local, hips = poser.local(np.zeros((len(roots), DOF)), roots)
    return poser.world(local, hips, roots[:, :3])
