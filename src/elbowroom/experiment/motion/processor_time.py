"""What gait, inverse kinematics and skeleton cost."""

from collections.abc import Callable
from dataclasses import dataclass
from time import thread_time_ns

import numpy as np

from elbowroom.body.dof import DOF
from elbowroom.body.gait.footholds import UNKNOWN, beside
from elbowroom.body.gait.living import body_of, living
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import CARRIAGE, ROOT_STATE

MANY = 256
_ROUNDS, _CALLS = 7, 50


@dataclass(frozen=True)
class ProcessorTime:
    """Microseconds of processor time: the best of several rounds."""

    one: float  # a skeleton alone
    each_of_many: float  # of 256 at once


def processor_time(humanoid: Humanoid) -> ProcessorTime:
    """Time the posing of walking bodies, feet and carriage included."""
    model = body_model(humanoid)
    roots = np.zeros((MANY, ROOT_STATE))
    roots[:, 3], roots[:, 6] = 1.1, np.linspace(0.0, 1.0, MANY)
    still = np.concatenate([beside(model.gait, roots[0]), np.zeros(CARRIAGE)])
    body = body_of(model.gait)
    states = np.array([living(body, still, beside(model.gait, root), 1.0, np.inf, UNKNOWN) for root in roots])
    postures = np.zeros((MANY, DOF))
    return ProcessorTime(
        _best(lambda: posture_capsules(model, postures[:1], states[:1])),
        _best(lambda: posture_capsules(model, postures, states)) / MANY,
    )


def _best(job: Callable[[], object]) -> float:
    job()
    rounds = []
    for _ in range(_ROUNDS):
        began = thread_time_ns()
        for _ in range(_CALLS):
            job()
        rounds.append((thread_time_ns() - began) / _CALLS)
    return 1e-3 * min(rounds)
