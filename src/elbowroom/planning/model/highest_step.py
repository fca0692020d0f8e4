"""How high a step one body takes: so high that its raised leg does not come into its own trunk.

Ground has steps that are high for anybody. Who has short legs under a thick trunk has a knee in the belly, or a foot,
long before that: such a body stays in front of what is too high for it.
"""

from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import SEARCH_ORDER, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import RISES, ROOT_STATE
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.footing import OVER
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.shared import Shared
from elbowroom.world.ground.ground import STEP
from elbowroom.world.scene import Scene
from elbowroom.world.stepped_scene import stepped

Floats = NDArray[np.float64]

_SPEEDS, _PHASES = (0.0, 0.3, 0.6), 16  # m/s of a walk up steps, moments of its stride
_APART = 0.005  # metres between heights that are tried

_HIGHEST: WeakKeyDictionary[Humanoid, float] = WeakKeyDictionary()
_SCENES: Shared[Scene] = Shared(idle=0)


def as_stepped(scene: Scene, humanoid: Humanoid) -> Scene:
    """A scene as it is for a body: steps that are too high for it are in its way. One for all who ask."""
    if scene.ground.plain:
        return scene
    if humanoid not in _HIGHEST:
        _HIGHEST[humanoid] = highest_step(humanoid)
    highest = _HIGHEST[humanoid]
    return scene if highest >= scene.ground.step else _SCENES.get((scene, humanoid), lambda: stepped(scene, highest))


def highest_step(humanoid: Humanoid) -> float:
    """The height of a step in metres up to which trunk and legs are apart in a stride, a foot over its edge included.

    No more than `STEP`, above which all climb.
    """
    rises = np.arange(0.0, STEP * (1.0 + OVER) + _APART, _APART)
    free = rises[np.logical_and.accumulate(_trunk_clearances(humanoid, rises) >= 0.0)]
    return min(float(free.max(initial=0.0)) / (1.0 + OVER), STEP)


def _trunk_clearances(humanoid: Humanoid, rises: Floats) -> Floats:
    """How much nearer trunk and legs could come to each other (R,) where one foot is raised by `rises` (R,), metres."""
    states = np.zeros((len(rises), len(_SPEEDS), _PHASES, ROOT_STATE))
    states[..., 3], states[..., 6] = np.array(_SPEEDS)[:, None], np.arange(_PHASES) / _PHASES
    states[..., RISES] = rises[:, None, None]
    rows, model = states.reshape(-1, ROOT_STATE), body_model(humanoid)
    gaps = self_clearances(model, self_pairs(model), rows, natural_walk()(RootPath(0.0, 1.0, rows)))
    least: Floats = gaps[SEARCH_ORDER.index(DofGroup.WAIST)].reshape(len(rises), -1).min(axis=1)
    return least
