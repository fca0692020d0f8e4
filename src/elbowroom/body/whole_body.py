"""The whole posed body for kernels: what `kinematics.posture_capsules` does, in one piece.

A kernel that looks at many postures of a body takes its `WholeBody` once.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body import posing
from elbowroom.body.dof import LOWERING
from elbowroom.body.gait import foot_poses, hips_sinks
from elbowroom.body.kinematics import BodyModel
from elbowroom.body.legs import leg_rotations
from elbowroom.body.rises import raise_feet
from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]
Segments = NDArray[np.float32]


class WholeBody(NamedTuple):
    """What posing every capsule needs of a `BodyModel`, under the names that these things have there."""

    figure: posing.Figure
    capsules: posing.CapsuleChain
    leg_rest: Floats
    gait_legs: Floats
    scale: float
    half_leg: float


def whole_body(model: BodyModel) -> WholeBody:
    """The same for kernels; the arrays are the model's own."""
    gait = model.gait
    return WholeBody(model.figure, model.body.posed, model.leg_rest, gait.legs, gait.scale, gait.half_leg)


@exact_kernel
def posed_body(body: WholeBody, q: Floats, roots: Floats) -> tuple[Segments, Floats, Floats]:
    """All capsules (C, 6, N) for postures (N, DOF) and root states (N, 7), in the world.

    And the chest frames: places (N, 3) and rotations (N, 4) of the last spine joint.
    """
    feet, drops = foot_poses(body.gait_legs, body.scale, roots)
    raise_feet(body.gait_legs, roots, feet, drops)
    sinks = hips_sinks(body.half_leg, drops, q[:, LOWERING].copy())
    legs = leg_rotations(body.leg_rest, feet, sinks)
    return posing.pose_body(body.figure, body.capsules, q, roots, legs, sinks)
