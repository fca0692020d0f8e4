"""What is kept from plan to plan: shared by all where it can be, and of no consequence but for time."""

import tracemalloc
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.clips.motion_set import STOCK
from elbowroom.control.controller import Controller
from elbowroom.control.plans.canned import standing_posture
from elbowroom.planning.command import Command
from elbowroom.planning.exact.group.upper_body_model import upper_body_model
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.planner import ExactPlanner
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.motion import Motion, MotionQuery
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.shared import Shared
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene
from sampled import sampled

T, QUEUE = 0.15, 5  # seconds, key frames


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return Humanoid.default()


def steered(humanoid: Humanoid, scene: Scene, settings: ExactSettings, seed: int, plans: int) -> list[Motion]:
    """The plans of somebody who walks as planned and changes his mind now and then."""
    rng, planner, roots = (
        np.random.default_rng(seed),
        ExactPlanner(humanoid, scene, settings),
        RootPlanner(humanoid, scene),
    )
    upper = standing_posture(scene.start.as_array())
    query = MotionQuery(0.0, scene.start, upper, np.zeros(LOCAL), Command(forward=1.0), QUEUE, T)
    found: list[Motion] = []
    for _ in range(plans):
        motion = planner.plan_motion(roots, query)
        found.append(motion)
        local, path = motion.local, motion.root.path
        if rng.uniform() < 0.15:
            forward, turn = rng.choice([1.0, 1.0, 0.6, 0.0, -1.0]), rng.choice([0.0, 0.0, 0.5, -1.0])
            query = query._replace(command=Command(forward=float(forward), turn=float(turn)))
        if not len(local.configurations):
            query = query._replace(time=query.time + T)  # it stands where it is
            continue
        assert local.velocities is not None
        query = query._replace(
            time=query.time + T,
            root=RootState(*path.states[1].tolist()),
            upper=local.configurations[1],
            velocity=local.velocities[1],
        )
    return found


def posts(seed: int) -> Scene:
    """Posts at random beside and in the way."""
    rng, count = np.random.default_rng(seed), 14
    places = np.stack(
        [rng.uniform(-0.7, 0.7, count), rng.uniform(0.7, 1.6, count), np.linspace(0.8, 6.0, count)], axis=1
    )
    boxes = Obstacles.boxes(places, np.tile([0.0, 0, 0, 1], (count, 1)), np.tile([0.05, 0.3, 0.05], (count, 1)))
    return replace(Scene.load("empty"), obstacles=boxes)


@pytest.mark.parametrize("where", sampled(["d", "posts 1", "c", "doorway", "posts 2"], 2))
def test_without_what_was_found_out_the_same_paths_are_found(where: str, humanoid: Humanoid) -> None:
    scene = posts(int(where[-1])) if where.startswith("posts") else Scene.load(where)
    known, anew = (
        steered(humanoid, scene, ExactSettings(remember=remember), seed=3, plans=24) for remember in (True, False)
    )
    for one, other in zip(known, anew, strict=True):
        assert np.array_equal(one.root.path.states, other.root.path.states)
        assert np.array_equal(one.local.configurations, other.local.configurations)
        assert one.local.status is other.local.status
        assert one.root.kind is other.root.kind
    assert sum(plan.local.checks for plan in known) < sum(plan.local.checks for plan in anew)


def test_who_walks_as_the_same_avatar_shares_its_model(humanoid: Humanoid) -> None:
    scene, settings = Scene.load("empty"), ExactSettings()
    with ThreadPoolExecutor(4) as pool:
        models = list(pool.map(lambda _: upper_body_model(humanoid, STOCK, settings, T), range(8)))
    assert all(model is models[0] for model in models)
    walkers = [UpperBodyPlanner(humanoid, scene, settings) for _ in range(2)]
    assert walkers[0].model is walkers[1].model is models[0]
    assert walkers[0].memory is not walkers[1].memory
    assert UpperBodyPlanner(humanoid, scene, ExactSettings(interval=0.2)).model is not models[0]


def test_one_more_walker_costs_little(humanoid: Humanoid) -> None:
    def walked() -> Controller:
        controller = Controller(humanoid, Scene.load("empty"))
        for _ in range(45):
            controller.step(Command(forward=1.0), 1 / 60)
        return controller

    crowd = [walked()]
    tracemalloc.start()
    before, _ = tracemalloc.get_traced_memory()
    crowd += [walked() for _ in range(4)]
    own = (tracemalloc.get_traced_memory()[0] - before) / 4
    tracemalloc.stop()
    assert own < 1.2e6


def test_added_postures_belong_to_who_added_them(humanoid: Humanoid) -> None:
    beam = Obstacles.boxes(np.array([[0.0, 1.72, 1.3]]), np.array([[0.0, 0, 0, 1]]), np.array([[1.0, 0.22, 0.05]]))
    scene = replace(Scene.load("empty"), obstacles=beam)
    states = np.zeros((13, 7))
    states[:, 1], states[:, 3], states[:, 6] = 1.1 * T * np.arange(13.0), 1.1, 0.9 * T * np.arange(13.0)
    path, coarse = RootPath(0.0, T, states), ExactSettings(samples_share=0.1)
    one, other = (UpperBodyPlanner(humanoid, scene, coarse) for _ in range(2))
    start = one.model.goals(path)[0]
    counts = {group: len(one.model.points[group]) for group in LOCAL_GROUPS}
    one.plan(path, StartState(start, np.zeros_like(start)))
    assert any(len(one.memory.known(group)) > counts[group] for group in LOCAL_GROUPS)
    for group in LOCAL_GROUPS:
        assert len(other.memory.known(group)) == counts[group]
        assert len(one.model.sets[group].postures.configurations) == counts[group]


def test_another_key_interval_is_another_memory(humanoid: Humanoid) -> None:
    scene = Scene.load("empty")
    planner, roots = ExactPlanner(humanoid, scene), RootPlanner(humanoid, scene)
    upper = standing_posture(scene.start.as_array())
    query = MotionQuery(0.0, scene.start, upper, np.zeros(LOCAL), Command(forward=1.0), QUEUE, T)
    planner.plan_motion(roots, query)
    before = planner.memory
    planner.plan_motion(roots, query._replace(time=T))
    assert planner.memory is before
    planner.plan_motion(roots, query._replace(interval=0.2))
    assert planner.memory is not before


def test_standing_is_standing_however_little_is_left_of_a_velocity(humanoid: Humanoid) -> None:
    beside = {"type": "box", "center": [0.7, 1.0, 0.0], "size": [0.4, 0.4, 0.4]}
    scene = Scene.of("beside", [beside], finish=(0.0, 5.0))
    planner, roots = ExactPlanner(humanoid, scene), RootPlanner(humanoid, scene)
    upper = standing_posture(scene.start.as_array())
    searched = []
    for turn in range(4):
        nearly = scene.start._replace(forward=1e-19 / (1 + turn), turn=-1e-30)
        query = MotionQuery(T * turn, nearly, upper + 1e-17 * turn, np.full(LOCAL, 1e-21), Command(), QUEUE, T)
        searched.append(planner.plan_motion(roots, query).local.nodes)
    assert searched[0] > 0
    assert not any(searched[1:])


def test_shared_things_are_made_once_and_go_with_who_uses_them() -> None:
    class Thing:
        """Somebody uses it."""

    shared, made = Shared[Thing](idle=1), []

    def make() -> Thing:
        made.append(1)
        return Thing()

    one = shared.get("one", make)
    assert shared.get("one", make) is one
    shared.get("two", make)
    assert shared.get("one", make) is one  # it is used, though another came
    shared.get("two", make)
    assert len(made) == 3  # nobody used it when another came
