"""Speeds and accelerations of plans that begin in the middle of a motion, and what such a plan knows of that motion."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, columns_of
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.exact.lattice.tangents import peak_acceleration, peak_speed
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.full_plan import FullPlan
from elbowroom.planning.exact.plan.recent_plans import RecentPlans, after
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import UpperPlan
from elbowroom.planning.exact.planner import ExactPlanner
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.interpolation import hermite
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

T, HORIZON = 0.15, 8
LIMITS = ExactSettings()
HUMANOID = proportional_humanoid(1.72)


def beside() -> Scene:
    """A post to the left and a beam at the height of the head, a step ahead."""
    boxes = Obstacles.boxes(
        np.array([[0.42, 1.0, 0.7], [0.0, 1.72, 1.2]]),
        np.tile([0.0, 0, 0, 1], (2, 1)),
        np.array([[0.1, 0.3, 0.1], [0.5, 0.08, 0.1]]),
    )
    return replace(Scene.load("empty"), obstacles=boxes)


def walk() -> RootPath:
    states, times = np.zeros((HORIZON + 1, 7)), T * np.arange(HORIZON + 1)
    states[:, 1], states[:, 3], states[:, 6] = 1.1 * times, 1.1, 0.9 * times
    return RootPath(0.0, T, states)


@pytest.fixture(scope="module")
def body() -> UpperBodyPlanner:
    return UpperBodyPlanner(HUMANOID, beside(), LIMITS)


def at_speed(rng: np.random.Generator, share: float) -> Floats:
    """A velocity (11,) of which each group has a share of its greatest speed, in any direction."""
    velocity = np.zeros(LOCAL)
    for group in LOCAL_GROUPS:
        way = rng.normal(size=group.size)
        velocity[columns_of(group)] = share * LIMITS.speed_of(group) * way / np.linalg.norm(way)
    return velocity


def asked(plan: UpperPlan) -> tuple[float, float]:
    """The greatest speed and acceleration of a plan, in shares of the limits."""
    keys, velocities = plan.plan.configurations, plan.plan.velocities
    assert velocities is not None
    speed = acceleration = 0.0
    for group in LOCAL_GROUPS:
        at = columns_of(group)
        for k in range(len(keys) - 1):
            a, b = np.ascontiguousarray(keys[k, at]), np.ascontiguousarray(keys[k + 1, at])
            v, w = np.ascontiguousarray(velocities[k, at]), np.ascontiguousarray(velocities[k + 1, at])
            speed = max(speed, peak_speed(a, v, b, w, T) / LIMITS.speed_of(group))
            acceleration = max(acceleration, peak_acceleration(a, v, b, w, T) / LIMITS.acceleration_of(group))
    return speed, acceleration


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_a_plan_that_begins_in_motion_keeps_the_limits_unless_told_otherwise(
    body: UpperBodyPlanner, share: float
) -> None:
    rng, start = np.random.default_rng(7), natural_walk()(walk())[0]
    found = harder = 0
    for _ in range(8):
        velocity = at_speed(rng, share)
        gentle = body.plan(walk(), StartState(start, velocity))
        harsh = body.plan(walk(), StartState(start, velocity, harsh=True))
        if gentle.reached == HORIZON:
            found += 1
            assert max(asked(gentle)) <= 1.0 + 1e-9
            assert harsh.reached == HORIZON  # who may be harsh has a way, too, and is not harsh without need
            assert max(asked(harsh)) <= 1.0 + 1e-9
        elif harsh.reached == HORIZON:
            harder += 1
            assert max(asked(harsh)) > 1.0
    assert found + harder > 0
    if share == 0.3:
        assert found == 8


def planned() -> tuple[FullPlan, FullPlan]:
    """A plan, and one that goes on from its first key time."""
    planner, roots, wholes = ExactPlanner(HUMANOID, beside()), RootPlanner(HUMANOID, beside()), []
    upper = natural_walk()(RootPath(0.0, T, np.zeros((2, 7))))[0]
    query = MotionQuery(0.0, RootState(), upper, np.zeros(LOCAL), Command(forward=1.0), 5, T)
    for _ in range(2):
        motion = planner.plan_motion(roots, query)
        whole = planner.memory.recent.since(query.time)
        assert whole is not None
        wholes.append(whole)
        local = motion.local
        assert local.velocities is not None
        query = query._replace(
            time=query.time + T, root=RootState(*motion.root.path.states[1].tolist()),
            upper=local.configurations[1], velocity=local.velocities[1],
        )  # fmt: skip
    return wholes[0], wholes[1]


def test_who_changes_the_wish_before_a_plan_begins_still_knows_the_motion_until_then() -> None:
    earlier, last = planned()
    recent = RecentPlans()
    recent.take(earlier)
    recent.take(last)
    joined = recent.since(0.4 * T)
    assert joined is not None
    assert joined.root.path.start_time == earlier.root.path.start_time
    assert np.array_equal(joined.local.configurations[0], earlier.local.configurations[0])
    assert np.array_equal(joined.local.configurations[1:], last.local.configurations)
    assert np.array_equal(joined.root.path.states[1:], last.root.path.states)
    assert joined.margins is not None
    assert last.margins is not None
    assert np.array_equal(joined.margins.margins[:, 1:], last.margins.margins)
    previous = recent.previous(RootPath(0.4 * T, T, last.root.path.states[:5]))
    assert previous is not None
    for k in range(5):  # on the curves of both plans
        keys, velocities = joined.local.configurations[k : k + 2], joined.local.velocities
        assert velocities is not None
        shown, _ = hermite(np.array([0.0, T]), keys, velocities[k : k + 2], 0.4 * T)
        assert np.allclose(previous.keys[k], shown, atol=1e-12)
    assert recent.since(last.root.path.start_time) is last


def test_a_plan_that_does_not_go_on_from_the_earlier_one_is_not_joined_to_it() -> None:
    earlier, last = planned()
    moved = last.local.configurations.copy()
    moved[0, 4] += 1e-3
    elsewhere = last._replace(local=last.local._replace(configurations=moved))
    assert after(earlier, elsewhere) is elsewhere
    off_time = last._replace(root=last.root._replace(path=replace(last.root.path, start_time=0.7 * T)))
    assert after(earlier, off_time) is off_time
    assert after(last, earlier) is earlier
    assert after(earlier._replace(margins=None), last) is last
