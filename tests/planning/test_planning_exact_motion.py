"""What the exact planner shows over time: it depends on nothing computed before, is bounded, and returns quickly."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, columns_of, limits
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.exact.lattice.tangents import peak_acceleration, peak_speed, smooth_tangents
from elbowroom.planning.exact.memory.previous_plan import PreviousPlan, StartState
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.planner import ExactPlanner
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.interpolation import hermite
from elbowroom.planning.motion import MotionQuery, SupersededError
from elbowroom.planning.result import LocalPlan, PlanStatus
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene
from stiff import forbid_crouching

Floats = NDArray[np.float64]
T = 0.15


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return proportional_humanoid(1.72)


def scene_of(centers: list[list[float]], half_sizes: list[list[float]]) -> Scene:
    boxes = Obstacles.boxes(np.array(centers), np.tile([0.0, 0, 0, 1], (len(centers), 1)), np.array(half_sizes))
    return replace(Scene.load("empty"), obstacles=boxes)


def walk(horizon: int, first: int = 0, speed: float = 1.1) -> RootPath:
    states, times = np.zeros((horizon + 1, 7)), T * (first + np.arange(horizon + 1))
    states[:, 1], states[:, 3], states[:, 6] = speed * times, speed, 0.9 * times
    return RootPath(T * first, T, states)


def posts() -> Scene:
    return scene_of(
        [[0.45, 1.0, 1.6], [-0.5, 1.2, 2.3], [0.1, 1.78, 3.0]], [[0.08, 0.3, 0.08]] * 2 + [[0.3, 0.05, 0.1]]
    )


def played(humanoid: Humanoid, scene: Scene, count: int) -> tuple[Floats, Floats, Floats, Floats]:
    """Key frames, velocities, goals and places of a walk that is planned anew at every key frame."""
    planner, roots = ExactPlanner(humanoid, scene), RootPlanner(humanoid, scene)
    upper = natural_walk()(RootPath(0.0, T, np.zeros((2, 7))))[0]
    query = MotionQuery(0.0, RootState(), upper, np.zeros(LOCAL), Command(forward=1.0), 5, T)
    keys, velocities, goals, places = [], [], [], []
    for _ in range(count):
        motion = planner.plan_motion(roots, query)
        local = motion.local
        assert len(local.configurations) > 1
        assert local.velocities is not None
        keys.append(local.configurations[0])
        velocities.append(local.velocities[0])
        goals.append(local.goals[0])
        places.append(motion.root.path.states[0, :2])
        query = query._replace(
            time=query.time + T,
            root=RootState(*motion.root.path.states[1].tolist()),
            upper=local.configurations[1],
            velocity=local.velocities[1],
        )
    return np.array(keys), np.array(velocities), np.array(goals), np.array(places)


def test_what_was_computed_before_changes_no_plan(humanoid: Humanoid) -> None:
    body = UpperBodyPlanner(humanoid, posts(), ExactSettings())
    start = natural_walk()(walk(1, speed=0.0))[0]
    previous, velocity, checks = None, np.zeros(LOCAL), []
    for first in range(6):
        path = walk(16, first)
        plan = body.plan(path, StartState(start, velocity), previous).plan
        fresh = UpperBodyPlanner(humanoid, posts(), ExactSettings())
        anew = fresh.plan(path, StartState(start, velocity), previous).plan
        assert len(plan.configurations) == 17
        assert plan.velocities is not None
        assert anew.velocities is not None
        assert np.allclose(plan.configurations, anew.configurations, atol=1e-9)
        assert np.allclose(plan.velocities, anew.velocities, atol=1e-9)
        again = (
            UpperBodyPlanner(humanoid, posts(), ExactSettings()).plan(path, StartState(start, velocity), previous).plan
        )
        assert np.array_equal(anew.configurations, again.configurations)
        checks.append((plan.checks, anew.checks))
        previous = PreviousPlan.freely(np.concatenate([plan.configurations[1:], plan.configurations[-1:]]))
        start, velocity = plan.configurations[1], plan.velocities[1]
    assert sum(known for known, _ in checks[1:]) < 0.5 * sum(anew for _, anew in checks[1:])


def test_the_shown_motion_is_bounded_and_does_not_jitter(humanoid: Humanoid) -> None:
    chosen = ExactSettings()
    keys, velocities, _, _ = played(humanoid, posts(), 30)
    for group in LOCAL_GROUPS:
        at = columns_of(group)
        most, speed = chosen.acceleration_of(group), chosen.speed_of(group)
        low, high = limits(group).T
        for k in range(len(keys) - 1):
            ends = keys[k, at], velocities[k, at], keys[k + 1, at], velocities[k + 1, at]
            assert peak_acceleration(*ends, T) <= most * (1 + 1e-6)
            assert np.linalg.norm(ends[2] - ends[0]) <= chosen.mean_speed_of(group) * T * (1 + 1e-6)
            curve = [
                hermite(np.array([0, T]), np.stack(ends[::2]), np.stack(ends[1::2]), u * T)
                for u in np.linspace(0.0, 1.0, 31)
            ]
            assert max(float(np.linalg.norm(rate)) for _, rate in curve) <= speed * (1 + 1e-6)
            assert all(np.all((value >= low - 1e-6) & (value <= high + 1e-6)) for value, _ in curve)


@pytest.fixture
def stiff(humanoid: Humanoid, monkeypatch: pytest.MonkeyPatch) -> Humanoid:
    """One who cannot crouch."""
    forbid_crouching(monkeypatch)
    return replace(humanoid)


def test_who_stands_before_a_wall_plans_once_and_leaves_as_soon_as_asked(stiff: Humanoid) -> None:
    wall = scene_of([[0.0, 1.25, 1.6]], [[3.0, 0.1, 0.6]])  # legs pass, nobody else does
    planner, roots = ExactPlanner(stiff, wall), RootPlanner(stiff, wall)
    upper = natural_walk()(RootPath(0.0, T, np.zeros((2, 7))))[0]
    query = MotionQuery(0.0, RootState(), upper, np.zeros(LOCAL), Command(forward=1.0), 5, T)
    checks = []
    for _ in range(110):  # two ways out, some steps long, are tried
        motion = planner.plan_motion(roots, query)
        local = motion.local
        assert local.velocities is not None
        assert motion.root.path.start_time == pytest.approx(query.time)
        checks.append(local.checks)
        query = query._replace(
            time=query.time + T,
            root=RootState(*motion.root.path.states[1].tolist()),
            upper=local.configurations[1],
            velocity=local.velocities[1],
        )
    assert max(checks) > 0
    assert checks[-10:] == [0] * 10
    assert local.blockade is not None
    assert local.blockade.obstacles == (0,)
    assert query.time - T < local.blockade.time < query.time + 3.0
    back = planner.plan_motion(roots, query._replace(command=Command(forward=-1.0)))
    assert back.root.path.states[-1, 1] < query.root.z - 0.1
    assert back.local.blockade is None


def test_a_reset_leaves_no_trace(stiff: Humanoid) -> None:
    """Also of what was added and found: after it, a blocked way is planned as it was the first time."""
    wall = scene_of([[0.0, 1.25, 1.6], [0.45, 1.0, 0.9]], [[3.0, 0.1, 0.6], [0.08, 0.3, 0.08]])
    planner, roots = ExactPlanner(stiff, wall), RootPlanner(stiff, wall)
    upper = natural_walk()(RootPath(0.0, T, np.zeros((2, 7))))[0]
    first = MotionQuery(0.0, RootState(), upper, np.zeros(LOCAL), Command(forward=1.0), 5, T)

    def walked() -> list[tuple[Floats, Floats, int]]:
        query, seen = first, []
        for _ in range(12):
            motion = planner.plan_motion(roots, query)
            local, states = motion.local, motion.root.path.states
            assert local.velocities is not None
            seen.append((states, local.configurations, local.checks))
            query = query._replace(
                time=query.time + T,
                root=RootState(*states[1].tolist()),
                upper=local.configurations[1],
                velocity=local.velocities[1],
            )
        return seen

    before = walked()
    planner.reset()
    roots.reset()
    after = walked()
    for one, other in zip(before, after, strict=True):
        assert np.array_equal(one[0], other[0])
        assert np.array_equal(one[1], other[1])
        assert one[2] == other[2]


def test_back_in_the_natural_swing_half_a_second_after_a_lone_obstacle(humanoid: Humanoid) -> None:
    scene = scene_of([[0.36, 0.95, 2.0]], [[0.1, 0.3, 0.1]])
    keys, _, goals, places = played(humanoid, scene, 30)
    away = np.linalg.norm(keys - goals, axis=1)
    assert away.max() > 0.2  # it was evaded
    past = int(np.argmax(places[:, 1] > 2.0 + 0.1 + 0.25))  # the body is behind it, a trunk's depth further
    assert away[past + round(0.5 / T) + 1 :].max() < 0.1


@settings(deadline=None, max_examples=50)
@given(st.integers(0, 10_000))
def test_the_law_of_the_curve_s_acceleration(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values, wide = rng.uniform(-1, 1, (8, 3)), np.tile([-9.0, 9.0], (3, 1))
    slopes = np.diff(values, axis=0) / T
    tangents = smooth_tangents(values, T, slopes[0], wide, np.zeros(8, np.bool_))
    bound = 3.0 * np.abs(np.diff(slopes, axis=0)).max(axis=0) / T
    for k in range(1, 6):
        for i in range(3):
            one = slice(i, i + 1)
            ends = values[k, one], tangents[k, one], values[k + 1, one], tangents[k + 1, one]
            assert peak_acceleration(*ends, T) <= bound[i] + 1e-9
    narrow = np.stack([values.min(axis=0), values.max(axis=0)], axis=1)
    inside = smooth_tangents(values, T, np.zeros(3), narrow, np.zeros(8, np.bool_))
    times = T * np.arange(8.0)
    for time in np.linspace(0.0, times[-1], 200):
        value, _ = hermite(times, values, inside, float(time))
        assert np.all((value >= narrow[:, 0] - 1e-9) & (value <= narrow[:, 1] + 1e-9))


@settings(deadline=None, max_examples=100)
@given(st.integers(0, 10_000), st.booleans())
def test_a_curve_is_nowhere_faster_than_its_peak_and_nearly_that_fast_somewhere(seed: int, resting: bool) -> None:
    rng = np.random.default_rng(seed)
    a, v, b, w = rng.uniform(-1, 1, (4, int(rng.integers(1, 5)))) * np.array([[0.4], [6.0], [0.4], [6.0]])
    v, w = (0.0 * v, 0.0 * w) if resting else (v, w)
    times, ends, rates = np.array([0.0, T]), np.stack([a, b]), np.stack([v, w])
    shown = [hermite(times, ends, rates, u * T)[1] for u in np.linspace(0.0, 1.0, 513)[:-1]]
    seen = float(np.linalg.norm(np.array([*shown, w]), axis=1).max())
    most = peak_speed(a, v, b, w, T)
    assert seen * (1 - 1e-9) <= most <= seen + 0.01 * (np.linalg.norm(b - a) / T + np.linalg.norm(rates, axis=1).sum())
    if resting:
        assert most == pytest.approx(1.5 * np.linalg.norm(b - a) / T, rel=0.005)


def test_a_lone_step_is_within_the_limits_however_it_goes_on() -> None:
    """From rest to rest by the longest step there is, with the velocities of key postures that bend there."""
    chosen = ExactSettings()
    for group in LOCAL_GROUPS:
        step = np.array([chosen.mean_speed_of(group) * T])
        mean, rest = 0.5 * step / T, np.zeros(1)
        assert peak_speed(rest, mean, step, mean, T) <= chosen.speed_of(group)
        assert peak_acceleration(rest, mean, step, mean, T) <= chosen.acceleration_of(group)


def test_a_plan_in_a_hurry_takes_what_the_groups_find_one_after_the_other(humanoid: Humanoid) -> None:
    """Where a plan that has the time searches them all together."""
    scene = Scene.load("d")
    upper = natural_walk()(RootPath(0.0, T, np.zeros((2, 7))))[0]

    def planned(ahead: float, *, hurry: bool) -> LocalPlan:
        planner, roots = ExactPlanner(humanoid, scene), RootPlanner(humanoid, scene)
        start = scene.start._replace(z=scene.start.z + ahead)
        query = MotionQuery(0.0, start, upper, np.zeros(LOCAL), Command(forward=1.0), 5, T, hurry=hurry)
        return planner.plan_motion(roots, query).local

    places = np.arange(1.0, 3.0, 0.25)
    hasty, patient = ([planned(float(ahead), hurry=hurry) for ahead in places] for hurry in (True, False))
    assert all(plan.joint is None for plan in hasty)
    assert sum(plan.status is PlanStatus.FOUND for plan in hasty) > len(places) // 2
    assert any(plan.joint is not None for plan in patient)


def test_a_plan_that_nobody_waits_for_is_given_up_at_any_stage_and_leaves_no_trace(stiff: Humanoid) -> None:
    wall = scene_of([[0.0, 1.25, 1.6], [0.45, 1.0, 0.9]], [[3.0, 0.1, 0.6], [0.08, 0.3, 0.08]])
    planner, roots = ExactPlanner(stiff, wall), RootPlanner(stiff, wall)
    upper = natural_walk()(RootPath(0.0, T, np.zeros((2, 7))))[0]
    asked: list[None] = []

    def superseded() -> bool:
        asked.append(None)
        return len(asked) == limit

    query = MotionQuery(0.0, RootState(), upper, np.zeros(LOCAL), Command(forward=1.0), 5, T, superseded=superseded)
    limit = 0
    whole = planner.plan_motion(roots, query).local.configurations
    stages = len(asked)
    assert stages > 5
    for limit in range(1, stages + 1, 2):
        planner.reset()
        roots.reset()
        asked.clear()
        with pytest.raises(SupersededError):
            planner.plan_motion(roots, query)
        assert len(asked) == limit
        planner.reset()
        roots.reset()
        again = planner.plan_motion(roots, query._replace(superseded=lambda: False)).local.configurations
        assert np.array_equal(again, whole)
