"""Planning calls one after another, as a walk makes them: each begins where the one before has its next key frame."""

from collections.abc import Iterator
from dataclasses import replace
from time import perf_counter_ns, thread_time_ns
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.exact.planner import ExactPlanner
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.motion import Motion, MotionQuery
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

INTERVAL = 0.15  # seconds between key frames, as the controller has them
_QUEUE = 5  # key frames handed over
_FORWARD = Command(forward=1.0)


class PlanCall(NamedTuple):
    """What one call cost."""

    milliseconds: float  # of processor time, root and upper body: other work on the machine counts little
    waited: float  # milliseconds by the clock
    checks: int  # capsule-box checks of the upper body
    found: bool
    searched: bool  # whether anything was planned: who walks on as planned is given the rest of an earlier plan


def crossing_calls(humanoid: Humanoid, scene: Scene, key_frames: int, most: int = 400) -> Iterator[PlanCall]:
    """The calls of `exact`, looking `key_frames` ahead, while the avatar walks straight from start to finish.

    At most `most` calls: who stands before something that has no way through would plan for ever.
    """
    planner = ExactPlanner(humanoid, scene, replace(ExactSettings(), look_ahead=key_frames * INTERVAL))
    roots = RootPlanner(humanoid, scene)
    query = _first_query(scene)
    for _ in range(most):
        began, clock = thread_time_ns(), perf_counter_ns()
        motion = planner.plan_motion(roots, query)
        spent, waited = thread_time_ns() - began, perf_counter_ns() - clock
        found = len(motion.local.configurations) > 1
        yield PlanCall(1e-6 * spent, 1e-6 * waited, motion.local.checks, found, motion.local.nodes > 0)
        if not found or scene.finished(query.root):
            return
        query = _next_query(query, motion)


def _first_query(scene: Scene) -> MotionQuery:
    root = scene.start
    path = RootPath(0.0, INTERVAL, np.tile(root.as_array(), (2, 1)))
    upper = natural_walk()(path)[0]
    return MotionQuery(0.0, root, upper, np.zeros_like(upper), _FORWARD, _QUEUE, INTERVAL)


def _next_query(query: MotionQuery, motion: Motion) -> MotionQuery:
    local = motion.local
    ahead = local.configurations[1] - local.configurations[0]
    velocity = ahead / INTERVAL if local.velocities is None else local.velocities[1]
    return query._replace(
        time=query.time + INTERVAL,
        root=RootState(*motion.root.path.states[1].tolist()),
        upper=local.configurations[1],
        velocity=velocity,
    )
