"""Who has room does what is liked there: the motion that a search would find, without one."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, DofGroup, columns_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperPlan
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.root.path import RootPath
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
T, HORIZON = 0.15, 11
BESIDE = {"type": "box", "center": [0.6, 1.1, 1.0], "size": [0.4, 0.4, 0.4]}
HUMANOID, OPEN, NARROW = Humanoid.default(), Scene.load("empty"), Scene.of("box", [BESIDE], finish=(0.0, 5.0))


def way(seed: int) -> RootPath:
    """A walk that bends, at some speed and moment of the stride."""
    rng, states = np.random.default_rng(seed), np.zeros((HORIZON + 1, ROOT_STATE))
    speed, turn, phase = rng.uniform(0.3, 1.6), rng.uniform(-0.5, 0.5), rng.uniform()
    times = T * np.arange(HORIZON + 1)
    states[:, 2], states[:, 3], states[:, 5] = turn * times, speed, turn
    states[:, 6] = phase + 0.9 * times
    states[1:, 0] = np.cumsum(speed * T * np.sin(states[1:, 2]))
    states[1:, 1] = np.cumsum(speed * T * np.cos(states[1:, 2]))
    return RootPath(0.0, T, states)


def planned(scene: Scene, path: RootPath, off: float = 0.0, rate: float = 0.0) -> UpperPlan:
    """A plan from what is liked at the start of a path, or so far `off`, at such a rate."""
    body = UpperBodyPlanner(HUMANOID, scene, ExactSettings())
    upper, velocity = body.model.goals(path)[0].copy(), np.zeros(LOCAL)
    arm = columns_of(DofGroup.LEFT_ARM).start
    upper[arm] += off
    velocity[arm] = rate
    return body.plan(path, StartState(upper, velocity), None, None, Effort.QUICK)


def looked(upper: UpperPlan) -> bool:
    """Whether anything was searched for a plan."""
    return sum(row.nodes for row in upper.plan.evidence) > 0


@pytest.mark.parametrize("seed", range(6))
def test_it_is_what_a_search_finds(seed: int) -> None:
    path = way(seed)
    upper = planned(OPEN, path, rate=0.5)
    assert (upper.reached, looked(upper)) == (HORIZON, False)
    twin, found = upper.search.apart(), upper.plan
    assert twin.failed is None
    assert found.velocities is not None
    np.testing.assert_array_equal(found.configurations, twin.keys)
    np.testing.assert_array_equal(found.velocities, twin.velocities)
    np.testing.assert_array_equal(found.goals, twin.goals)
    assert upper.margins is upper.search.problem.required


@pytest.mark.parametrize(
    ("scene", "off", "rate"), [(NARROW, 0.0, 0.0), (OPEN, 0.2, 0.0), (OPEN, 0.0, 1e3)], ids=["near", "away", "fast"]
)
def test_who_has_no_room_or_is_elsewhere_is_searched_for(scene: Scene, off: float, rate: float) -> None:
    assert looked(planned(scene, way(1), off, rate))
