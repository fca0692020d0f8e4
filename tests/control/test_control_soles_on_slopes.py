"""Feet that are held against obstacles on slopes: as much of them may be in the ground as on a floor."""

import math

import numpy as np
import pytest

from elbowroom.body.dof import LOCAL
from elbowroom.body.gait.foot_state import PITCH, Z
from elbowroom.body.gait.footholds import beside
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import FOOT, HEIGHT, RISES, ROOT_STATE
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.world.scene import Scene

AVATAR = Humanoid.default()
BEGIN, LONG = 2.0, 4.0  # metres: where a slope begins, and how long it is
EVEN = 1e-4  # metres: 3 mm of the lift are upright


@pytest.mark.parametrize("steep", [8.0, 12.0, 20.0])
@pytest.mark.parametrize("pitch", [-0.3, 0.0, 0.5, 1.0])
def test_a_pitched_foot_is_as_clear_of_a_slope_as_of_a_floor(steep: float, pitch: float) -> None:
    """On a slope it was held too low, by the more the deeper its capsules are: none of its poses was free there."""
    grade = math.tan(math.radians(steep))
    points = [[x, y, z] for x in (-2.0, 2.0) for y, z in ((0.0, 0.0), (grade * LONG, LONG), (0.0, LONG))]
    ramp = {"type": "hull", "points": points, "center": [0.0, 0.0, BEGIN]}
    check, found = BodyCheck(AVATAR, Scene.of("ramp", [ramp], finish=(0.0, 9.0))), []
    for z, rises in ((0.0, 0.0), (BEGIN + 0.5 * LONG, grade)):
        root = np.zeros(ROOT_STATE)
        root[1], root[HEIGHT] = z, rises * max(z - BEGIN, 0.0)
        row = beside(body_model(AVATAR).gait, root)
        for side in range(2):
            at = ROOT_STATE + FOOT * side
            row[at + PITCH] = pitch
            row[RISES + 2 * side : RISES + 2 * side + 2] = rises * row[at + Z], -math.atan(rises)
        axes, radii = check.axes(row, np.zeros(LOCAL))[:, :, 0], AVATAR.capsules.radii
        heights = axes[:, 1::3] - root[HEIGHT] - rises * axes[:, 2::3]
        feet = check.soles.footing.each_foot(body_model(AVATAR).body).any(axis=0)
        found.append(heights[feet].min(axis=1) / math.hypot(1.0, rises) - radii[feet])
    assert np.abs(found[1] - found[0]).max() < EVEN + 0.003 * (1.0 - math.cos(math.radians(steep)))
    assert found[1].min() > 0.0
