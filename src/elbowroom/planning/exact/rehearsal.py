"""Plans that nobody asked for: past a box and before a wall, so that what is rarely needed is compiled and loaded."""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.upper_body import UpperBody
from elbowroom.planning.goal import goal_configurations
from elbowroom.planning.root_path import RootPath
from elbowroom.world.boxes import Boxes
from elbowroom.world.scene import Scene

_INTERVAL, _HORIZON, _SPEED = 0.15, 8, 1.1  # seconds, key frames, m/s
_BESIDE = ((0.45, 1.0, 0.8), (0.1, 0.1, 0.1))  # centre and half size, metres: in the way of the left hand
_WALL = ((0.0, 1.5, 1.0), (3.0, 0.6, 0.1))  # legs pass, nobody else does


@lru_cache(maxsize=4)
def rehearse(humanoid: Humanoid) -> None:
    """Plan once each way, joint step, added postures and certificate included; once for each humanoid."""
    states = np.zeros((_HORIZON + 1, ROOT_STATE))
    times = _INTERVAL * np.arange(_HORIZON + 1.0)
    states[:, 1], states[:, 3], states[:, 6] = _SPEED * times, _SPEED, 0.9 * times
    path = RootPath(0.0, _INTERVAL, states)
    for center, half in (_BESIDE, _WALL):
        boxes = Boxes(np.array([center]), np.array([[0.0, 0.0, 0.0, 1.0]]), np.array([half]))
        scene = replace(Scene.load("empty"), boxes=boxes, box_names=("box",))
        body = UpperBody(humanoid, scene, ExactSettings())
        start = goal_configurations(body.goals, path)[0]
        dressing = body.plan(path, start, np.zeros_like(start)).dressing
        dressing.together(1)
        dressing.blockade()
