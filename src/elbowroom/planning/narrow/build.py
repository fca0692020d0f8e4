"""How broad somebody is who walks straight on, how much slimmer with turned shoulders, and how tall."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, DOF, LOCAL, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import BodyModel, posture_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.free_map import LEVELS

Floats = NDArray[np.float64]

TWIST = float(np.deg2rad(45.0))  # how far shoulders turn against the hips
_WALK, _PHASES = 1.1, 16  # m/s; moments of a stride
_TWISTS = DofGroup.WAIST.at.start + 1  # its place in `q`


class Build(NamedTuple):
    """Half the breadth of an upper body, and its height, metres."""

    swinging: float  # with arms that swing
    broad: float  # with arms that hang straight, and
    slim: float  # with shoulders turned by `TWIST` besides
    low: int  # levels of the free map between elbows and shoulders: the first
    high: int  # and the one after the last
    tall: float  # the crown above the ground


def build_of(humanoid: Humanoid, model: BodyModel) -> Build:
    """Measure a body in the stock walk."""
    states, count = np.zeros((_PHASES, ROOT_STATE)), _PHASES + 2
    states[:, 3], states[:, 6] = _WALK, np.arange(_PHASES) / _PHASES
    q = np.zeros((count, DOF))
    q[:_PHASES, DOF - LOCAL :] = natural_walk()(RootPath(0.0, 1.0, states))
    q[-1, _TWISTS] = TWIST
    ends: Floats = posture_capsules(model, q, np.zeros((count, ROOT_STATE))).reshape(-1, 2, 3, count).astype(np.float64)
    upper = np.concatenate([humanoid.capsules.of(group) for group in (DofGroup.WAIST, *ARMS)])
    aside = (np.abs(ends[:, :, 0]).max(axis=1) + model.body.radii[:, None])[upper].max(axis=0)
    arms = ends[[humanoid.capsules.of(group)[0] for group in ARMS], :, 1, -2]  # from the elbows to the shoulders
    low = min(int(np.searchsorted(LEVELS, arms.min())), len(LEVELS) - 1)
    high = max(int(np.searchsorted(LEVELS, arms.max())), low + 1)
    swinging, broad, slim = float(aside[:_PHASES].max()), float(aside[-2]), float(aside[-1])
    tall = float((ends[:, :, 1, -2].max(axis=1) + model.body.radii).max())
    return Build(max(swinging, broad), broad, slim, low, high, tall)
