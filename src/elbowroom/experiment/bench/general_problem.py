"""Crossing a scene as a problem for a general motion planner: the upper body and time, along a straight walk.

The state is (upper body, time); the root walks straight ahead at its own speed, so a state is a whole posture. A
motion between two states is straight in both, goes forward in time, keeps the joint speeds that our planner keeps, and
touches nothing at any of its samples. Start and goal are the natural walk's postures, at the start and past the gate.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, columns_of, limits
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import RootState
from elbowroom.errors import InputError
from elbowroom.planning.command import Command
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

SECOND = 2.0  # radians that a second counts as in the distance of two states
_RATE = 60.0  # samples a second of a motion
_INTERVAL = 0.15  # seconds
_SETTING_OFF = 8  # key intervals until the pace is reached
_LONGEST = 1000


@dataclass(frozen=True, eq=False)
class CrossingProblem:
    """What a general planner has to solve; states are rows (upper body, seconds)."""

    path: RootPath
    low: Floats  # (d + 1,)
    high: Floats
    start: Floats
    goal: Floats
    speeds: tuple[tuple[slice, float], ...]  # columns of a group, rad/s over all of them together
    humanoid: Humanoid
    scene: Scene

    def __post_init__(self) -> None:
        object.__setattr__(self, "_model", body_model(self.humanoid))
        object.__setattr__(self, "_radii", self.humanoid.capsules.radii.astype(np.float32))

    def sampled(self, a: Floats, b: Floats) -> Floats:
        """States (n, d + 1) of the motion from one to another, both included."""
        count = max(int(np.ceil((b[-1] - a[-1]) * _RATE)), 1) + 1
        states: Floats = a + np.linspace(0.0, 1.0, count)[:, None] * (b - a)
        return states

    def postures(self, states: Floats) -> tuple[Floats, Floats]:
        """Configurations `q` (n, DOF) and root states (n, 7) of states."""
        roots = self.path.sample(states[:, -1])
        return np.hstack([roots[:, :3], states[:, :-1]]), roots

    def is_free(self, states: Floats) -> bool:
        """Whether no state (n, d + 1) touches an obstacle."""
        q, roots = self.postures(states)
        segments = posture_capsules(self._model, q, roots)  # type: ignore[attr-defined]
        return bool((clearance(segments, self._radii, self.scene.obstacles.standing) >= 0.0).all())  # type: ignore[attr-defined]

    def is_slow_enough(self, a: Floats, b: Floats) -> bool:
        """Whether the motion goes forward in time, within the joint speeds."""
        seconds = float(b[-1] - a[-1])
        return seconds > 0.0 and all(
            float(np.linalg.norm(b[at] - a[at])) <= speed * seconds for at, speed in self.speeds
        )


def crossing_problem(humanoid: Humanoid, scene: Scene) -> CrossingProblem:
    """The problem of crossing a scene."""
    path = _straight_walk(humanoid, scene)
    goals = natural_walk()(path)
    settings = ExactSettings()
    speeds = []
    for group in LOCAL_GROUPS:
        speeds.append((columns_of(group), settings.mean_speed_of(group)))
    low, high = np.concatenate([limits(group) for group in LOCAL_GROUPS]).T
    end = path.interval * path.horizon
    return CrossingProblem(
        path=path,
        low=np.append(low, 0.0),
        high=np.append(high, end),
        start=np.append(goals[0], 0.0),
        goal=np.append(goals[-1], end),
        speeds=tuple(speeds),
        humanoid=humanoid,
        scene=scene,
    )


def _straight_walk(humanoid: Humanoid, scene: Scene) -> RootPath:
    """Straight ahead until the finish, as if nothing stood in the way: set off, then walk on at the pace reached."""
    bare = replace(scene, obstacles=Obstacles())
    path = RootPlanner(humanoid, bare).plan(Asked(scene.start, Command(forward=1.0), _SETTING_OFF, _INTERVAL)).path
    states = list(path.states)
    last, before = states[-1], states[-2]
    while not scene.finished(RootState(*states[-1].tolist())):
        if len(states) > _LONGEST:
            raise InputError(f"scene {scene.name}: who walks straight ahead does not pass the finish")
        ahead = states[-1].copy()
        ahead[[0, 1, 6]] += (last - before)[[0, 1, 6]]
        states.append(ahead)
    return replace(path, states=np.array(states))
