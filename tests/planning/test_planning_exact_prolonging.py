"""A walk that goes on as planned: what is kept of a plan, what its new end is like, and when all is planned anew."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.exact.plan.new_plan import NewPlan
from elbowroom.planning.exact.planner import ExactPlanner
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.interpolation import hermite
from elbowroom.planning.motion import Motion, MotionQuery
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Sphere
from elbowroom.world.obstacles.tracks.moving import Moving, Track
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
T, LONG = 0.15, 16  # seconds, key frames: the planner's look-ahead, all of which is asked for
SETTINGS = ExactSettings()
SPARE = round(SETTINGS.spare / T)
FORWARD = Command(forward=1.0)


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return proportional_humanoid(1.72)


@pytest.fixture(scope="module")
def posts() -> Scene:
    """Posts beside the way, every 0.8 m, for the arms or for the trunk."""
    rng = np.random.default_rng(5)
    aside = rng.uniform(0.32, 0.45, 12) * np.tile([1.0, -1.0], 6)
    places = np.stack([aside, np.full(12, 1.1), 1.2 + 0.8 * np.arange(12)], axis=1)
    boxes = Obstacles.boxes(places, np.tile([0.0, 0, 0, 1], (12, 1)), np.full((12, 3), [0.05, 0.3, 0.05]))
    return replace(Scene.load("empty"), obstacles=boxes)


def first_query(command: Command = FORWARD) -> MotionQuery:
    upper = natural_walk()(RootPath(0.0, T, np.zeros((2, 7))))[0]
    return MotionQuery(0.0, RootState(), upper, np.zeros(LOCAL), command, LONG, T)


def after(query: MotionQuery, motion: Motion, keys: int = 1) -> MotionQuery:
    """The query of who has played so many key frames of a motion."""
    local = motion.local
    assert local.velocities is not None
    return query._replace(
        time=query.time + keys * T,
        root=RootState(*motion.root.path.states[keys].tolist()),
        upper=local.configurations[keys],
        velocity=local.velocities[keys],
    )


def test_on_uneven_ground_a_plan_looks_no_farther_ahead_than_in_a_hurry(humanoid: Humanoid) -> None:
    sill: dict[str, Any] = {"type": "box", "center": [0.0, 0.05, 3.0], "size": [2.0, 0.1, 0.3]}
    uneven = Scene.of("sill", [sill], finish=(0.0, 6.0))
    for scene, ahead in ((Scene.load("empty"), SETTINGS.look_ahead), (uneven, SETTINGS.hurried_ahead)):
        planner = ExactPlanner(humanoid, scene)
        planner.plan_motion(RootPlanner(humanoid, scene), first_query()._replace(horizon=4))
        assert planner.memory.ongoing is not None
        assert planner.memory.ongoing.whole.root.path.horizon == round(ahead / T)


def test_the_last_plan_is_played_until_it_gets_short_and_only_its_end_is_new(humanoid: Humanoid, posts: Scene) -> None:
    planner, roots = ExactPlanner(humanoid, posts), RootPlanner(humanoid, posts)
    query = first_query()
    motion = planner.plan_motion(roots, query)
    changed, evading = [], 0.0
    for _ in range(36):
        query = after(query, motion)
        known, motion = motion.local, planner.plan_motion(roots, query)
        local = motion.local
        assert len(local.configurations) == LONG + 1
        previous = LONG + SPARE - round(SETTINGS.revisited / T)
        assert np.allclose(local.configurations[:previous], known.configurations[1:][:previous], atol=1e-12)
        changed.append(not np.allclose(local.configurations[:LONG], known.configurations[1:], atol=1e-6))
        evading = max(evading, float(np.abs(local.configurations - local.goals).max()))
    assert any(changed[::4])  # the end was not just added to
    assert not any(any(changed[begin::4]) for begin in range(1, 4))
    assert evading > 0.3


def test_a_motion_with_many_new_ends_is_free_of_everything_at_every_moment(humanoid: Humanoid, posts: Scene) -> None:
    planner, roots, model = ExactPlanner(humanoid, posts), RootPlanner(humanoid, posts), body_model(humanoid)
    query, least = first_query(), np.inf
    for _ in range(48):
        motion = planner.plan_motion(roots, query)
        local, path = motion.local, motion.root.path
        assert local.velocities is not None
        times = np.linspace(0.0, T, 24, endpoint=False)
        states = path.sample(path.start_time + times)
        span, ends, rates = np.array([0.0, T]), local.configurations[:2], local.velocities[:2]
        shown = [hermite(span, ends, rates, float(time))[0] for time in times]
        poses = np.concatenate([states[:, :3], shown], axis=1)
        assert poses.shape[1] == DOF
        segments = posture_capsules(model, poses, states)
        least = min(least, float(clearance(segments, humanoid.capsules.radii, posts.obstacles.standing).min()))
        query = after(query, motion)
    assert 0.0 < least < SETTINGS.comfort


def moved_arm(query: MotionQuery) -> MotionQuery:
    return query._replace(upper=query.upper + 0.01)


def faster_arm(query: MotionQuery) -> MotionQuery:
    return query._replace(velocity=query.velocity + 0.1)


def aside(query: MotionQuery) -> MotionQuery:
    return query._replace(root=query.root._replace(x=query.root.x + 0.01))


def late(query: MotionQuery) -> MotionQuery:
    return query._replace(time=query.time + 0.05)


def turned(query: MotionQuery) -> MotionQuery:
    return query._replace(command=Command(forward=1.0, turn=0.5))


def hurried(query: MotionQuery) -> MotionQuery:
    return query._replace(hurry=True)


@pytest.mark.parametrize("otherwise", [moved_arm, faster_arm, aside, late, turned, hurried])
def test_who_is_elsewhere_or_wants_something_else_is_planned_for_anew(otherwise, humanoid: Humanoid) -> None:  # type: ignore[no-untyped-def]
    scene = Scene.load("b")
    planner, roots = ExactPlanner(humanoid, scene), RootPlanner(humanoid, scene)

    def query_under_way() -> MotionQuery:
        query = first_query()._replace(root=scene.start)
        for _ in range(4):
            query = after(query, planner.plan_motion(roots, query))
        return query  # while its plan is still long enough

    assert planner.plan_motion(roots, query_under_way()).local.nodes == 0
    planner.reset()
    assert planner.plan_motion(roots, otherwise(query_under_way())).local.nodes > 0


def test_while_something_moves_every_plan_is_new(humanoid: Humanoid, posts: Scene) -> None:
    far = Track("far", Sphere(0.1), np.array([0.0, 9.0]), np.array([[5.0, 1.0, 5.0]] * 2), np.zeros(2))
    scene = replace(posts, obstacles=replace(posts.obstacles, moving=Moving((far,))))
    planner, roots, query = ExactPlanner(humanoid, scene), RootPlanner(humanoid, scene), first_query()
    for _ in range(5):
        motion = planner.plan_motion(roots, query)
        assert motion.local.nodes > 0
        query = after(query, motion)


@pytest.mark.parametrize(("bent", "kept"), [(10.0, True), (25.0, False)])
def test_a_hand_that_turns_a_little_stops_nobody_who_has_a_way(
    bent: float, kept: bool, humanoid: Humanoid, posts: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where what it means now leads nowhere one goes on as planned before."""
    planner, roots = ExactPlanner(humanoid, posts), RootPlanner(humanoid, posts)
    query = first_query(Command(forward=1.0, direction=0.0))
    known = planner.plan_motion(roots, query)
    made = NewPlan.made
    monkeypatch.setattr(NewPlan, "made", lambda self, left: made(self, left)._replace(leads_on=False))
    turned = after(query, known)._replace(command=Command(forward=1.0, direction=math.radians(bent)))
    motion = planner.plan_motion(roots, turned)
    same = np.allclose(motion.root.path.states[:LONG], known.root.path.states[1:], atol=1e-9)
    assert same == kept
