"""How high one body steps, and climbs: so high that its raised leg does not come into its own trunk.

Ground has steps that are high for anybody, and that one climbs where there is no other way. Who has short legs under a
thick trunk has a knee in the belly, or a foot, long before that: such a body stays in front of what is too high for it.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import SEARCH_ORDER, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.made_once import made_once
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import RISES, ROOT_STATE
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.footing import OVER
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.shared import Shared
from elbowroom.world.ground.ground import STEP
from elbowroom.world.scene import Scene
from elbowroom.world.stepped_scene import climbed, stepped

Floats = NDArray[np.float64]

CLIMB = 0.46  # metres: the knee of an adult; of shorter legs in proportion
_SPEEDS, _PHASES = (0.0, 0.3, 0.6), 16  # m/s of a walk up steps, moments of its stride
_APART = 0.005  # metres between heights that are tried

_STEPPED: Shared[Scene] = Shared(idle=0)
_CLIMBED: Shared[Scene] = Shared(idle=0)


def as_stepped(scene: Scene, humanoid: Humanoid) -> Scene:
    """A scene as it is for a body: steps that are too high for it are in its way. One for all who ask."""
    if scene.ground.plain:
        return scene
    highest = highest_step(humanoid)
    return scene if highest >= scene.ground.step else _STEPPED.get((scene, highest), lambda: stepped(scene, highest))


def as_climbed(scene: Scene, humanoid: Humanoid) -> Scene | None:
    """A scene as it is for a body that climbs; None where that leads no farther. One for all who ask.

    The first who asks waits while its ground is made, a second or two in a large place.
    """
    highest = highest_climb(humanoid)
    if highest <= highest_step(humanoid):
        return None
    found = _CLIMBED.get((scene, highest), lambda: climbed(scene, highest))
    return None if found.ground is scene.ground else found


def highest_step(humanoid: Humanoid) -> float:
    """The height of a step in metres up to which trunk and legs are apart in a stride, a foot over its edge included.

    No more than `STEP`, above which all climb.
    """
    return min(_highest(humanoid), STEP)


def highest_climb(humanoid: Humanoid) -> float:
    """The same of what is climbed: no more than `CLIMB`, or as much less as the legs are shorter."""
    return min(_highest(humanoid), CLIMB * min(body_model(humanoid).gait.scale, 1.0))


@made_once
def _highest(humanoid: Humanoid) -> float:
    """How high a foot can be raised out of the way of the trunk, less what it keeps above an edge; metres."""
    rises = np.arange(0.0, CLIMB * (1.0 + OVER) + _APART, _APART)
    free = rises[np.logical_and.accumulate(_trunk_clearances(humanoid, rises) >= 0.0)]
    return float(free.max(initial=0.0)) / (1.0 + OVER)


def _trunk_clearances(humanoid: Humanoid, rises: Floats) -> Floats:
    """How much nearer trunk and legs could come to each other (R,) where one foot is raised by `rises` (R,), metres."""
    states = np.zeros((len(rises), len(_SPEEDS), _PHASES, ROOT_STATE))
    states[..., 3], states[..., 6] = np.array(_SPEEDS)[:, None], np.arange(_PHASES) / _PHASES
    states[..., RISES] = rises[:, None, None]
    rows, model = states.reshape(-1, ROOT_STATE), body_model(humanoid)
    gaps = self_clearances(model, self_pairs(model), rows, natural_walk()(RootPath(0.0, 1.0, rows)))
    least: Floats = gaps[SEARCH_ORDER.index(DofGroup.WAIST)].reshape(len(rises), -1).min(axis=1)
    return least
