"""The joint step on a real body: its tables against the body posed in the world, its certificate, and its memory."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, DOF, LOCAL, SEARCH_ORDER, DofGroup, columns_of
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import BodyModel, body_model, posture_capsules
from elbowroom.planning.exact.certificate.closed_nodes import Closed, SliceNodes
from elbowroom.planning.exact.joint.step import ALONE, PRODUCT, JointStep
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperBodySearch
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.sweep.own_body_nodes import SPARE
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.self_pairs import SelfPairs, carriers_of, self_clearances, self_pairs
from elbowroom.planning.result import BlockadeKind, PlanStatus
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import number_of, span_of
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Rows = tuple[tuple[tuple[float, ...], tuple[float, ...]], ...]
SETTINGS = ExactSettings(samples_share=0.3)  # few postures: the whole product can be looked at
AWAY = ((1.4, 1.0, 1.4), (0.1, 0.1, 0.1))
WALL = (((0.0, 1.5, 1.36), (3.0, 0.65, 0.1)), AWAY)  # legs pass, nobody else does
BRICKS = (
    *(((0.25 * i, 1.0 + 0.26 * j, 1.36), (0.125, 0.13, 0.1)) for i in range(-4, 5) for j in range(5)),
    *(((1.5 + 0.2 * i, 0.6, 0.6 + 0.2 * j), (0.05, 0.05, 0.05)) for i in range(8) for j in range(6)),
    AWAY,
)  # of a wall, and what lies about
PILLARS = (
    ((-0.26, 1.4, 1.4), (0.2, 0.9, 0.2)),
    ((0.26, 1.4, 1.4), (0.2, 0.9, 0.2)),
    AWAY,
)
POSTS = (((0.42, 1.0, 1.2), (0.08, 0.4, 0.08)), ((-0.45, 1.1, 1.5), (0.06, 0.3, 0.06)))


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return proportional_humanoid(1.72)


def scene_of(rows: Rows) -> Scene:
    centers, halves = (np.array(column) for column in zip(*rows, strict=True))
    boxes = Obstacles.boxes(centers, np.tile([0.0, 0.0, 0.0, 1.0], (len(centers), 1)), halves)
    return replace(Scene.load("empty"), obstacles=boxes)


def walk(horizon: int = 8) -> RootPath:
    states = np.zeros((horizon + 1, 7))
    times = 0.15 * np.arange(horizon + 1.0)
    states[:, 1], states[:, 3], states[:, 6] = 1.1 * times, 1.1, 0.9 * times
    return RootPath(0.0, 0.15, states)


def dressed(humanoid: Humanoid, scene: Scene, path: RootPath) -> UpperBodySearch:
    body = UpperBodyPlanner(humanoid, scene, SETTINGS)
    start = natural_walk()(path)[0]
    return body.plan(path, StartState(start, np.zeros_like(start)), effort=Effort.JOINT).search


def step_of(dressing: UpperBodySearch) -> JointStep:
    return dressing.joint_step()


def posture(step: JointStep, depth: int, nodes: tuple[int, ...]) -> Floats:
    upper = np.zeros(LOCAL)
    for number, (group, node) in enumerate(zip(SEARCH_ORDER, nodes, strict=True)):
        upper[columns_of(group)] = step.configurations(number, depth)[node]
    return upper


def test_its_tables_say_what_the_posed_body_says(humanoid: Humanoid) -> None:
    """Free or not, arm by arm and arm beside arm, at every moment that a slice looks at."""
    path, rng, model = walk(), np.random.default_rng(0), body_model(humanoid)
    dressing = dressed(humanoid, scene_of(POSTS), path)
    step, pairs = step_of(dressing), self_pairs(model)
    seen = {True: 0, False: 0}
    for _ in range(60):
        depth = int(rng.integers(4, 9))
        usable = [np.flatnonzero(np.isfinite(group.costs_alone[depth])) for group in step.nodes]
        nodes = tuple(int(rng.choice(row)) for row in usable)
        if not np.isfinite(step.nodes[0].base[depth, nodes[0]]):
            continue
        step.fill(depth, np.arange(step.filled.shape[1]) == nodes[0])
        upper = posture(step, depth, nodes)
        state = path.states[depth : depth + 1]
        apart = gap_of(model, pairs, ARMS[1], (ARMS[0],), state, upper)
        moments = len(step.around.places[depth])
        for side in range(2):
            arm = PRODUCT[1 + side]
            free = np.isfinite(step.costs[side][depth, nodes[0], nodes[arm]])
            near = min(child_clearance(humanoid, step, depth, i, upper, ARMS[side]) for i in range(moments))
            margin = step.nodes[arm].margins[depth]
            contact = gap_of(model, pairs, ARMS[side], carriers_of(ARMS[side]), state, upper)
            if abs(near - margin) > 1e-4 and abs(contact - SPARE) > 1e-3:
                assert free == (near >= margin and contact >= SPARE)
                seen[bool(free)] += 1
        if abs(apart - SPARE) > 1e-3:
            assert step.apart[depth, nodes[PRODUCT[1]], nodes[PRODUCT[2]]] == (apart >= SPARE)
    assert min(seen.values()) > 5


def gap_of(
    model: BodyModel, pairs: SelfPairs, group: DofGroup, others: tuple[DofGroup, ...], state: Floats, upper: Floats
) -> float:
    """How much nearer a group's parts could come to those of others, metres."""
    theirs = np.concatenate([pairs.capsules[other] for other in others])
    chosen = np.isin(pairs.first, pairs.capsules[group]) & np.isin(pairs.second, theirs)
    some = pairs._replace(
        first=pairs.first[chosen], second=pairs.second[chosen], kinds=pairs.kinds[chosen], limits=pairs.limits[chosen]
    )
    return float(self_clearances(model, some, state, upper[None]).min())


def test_a_child_outside_the_product_costs_what_it_must_under_each_waist(humanoid: Humanoid) -> None:
    """The head: its least cost under a waist, over all its nodes that are free there, posed one by one in the world."""
    path, rng = walk(), np.random.default_rng(2)
    step = step_of(dressed(humanoid, scene_of((((0.0, 1.66, 1.2), (0.5, 0.12, 0.1)), AWAY)), path))
    (head,) = ALONE
    group, near, comfort = step.nodes[head], step.settings.near, step.settings.comfort
    kinds = {"free": 0, "dearer": 0, "none": 0}
    for _ in range(20):
        depth = int(rng.integers(4, 9))
        waist = int(rng.choice(np.flatnonzero(np.isfinite(step.nodes[0].costs_alone[depth]))))
        if not np.isfinite(step.nodes[0].base[depth, waist]):
            continue
        step.fill(depth, np.arange(step.filled.shape[1]) == waist)
        found = step.problem().waist[depth, waist] - step.nodes[0].base[depth, waist]
        clear = np.full(group.base.shape[1], np.inf)
        for node in np.flatnonzero(np.isfinite(group.base[depth])):
            nodes = [0] * len(step.nodes)
            nodes[0], nodes[head] = waist, int(node)
            upper = posture(step, depth, tuple(nodes))
            moments = range(len(step.around.places[depth]))
            clear[node] = min(child_clearance(humanoid, step, depth, i, upper, SEARCH_ORDER[head]) for i in moments)
        costs = group.base[depth] + near * np.clip(comfort - clear, 0.0, 1.0) ** 2
        least = [costs[clear >= group.margins[depth] + shift].min(initial=np.inf) for shift in (-1e-4, 1e-4)]
        assert least[0] - 2e-3 <= found <= least[1] + 2e-3
        kinds["none" if np.isinf(found) else "dearer" if found > group.base[depth].min() + 0.01 else "free"] += 1
    assert min(kinds.values()) > 0


def child_clearance(
    humanoid: Humanoid, step: JointStep, depth: int, moment: int, upper: Floats, group: DofGroup
) -> float:
    """Of a group posed in the world with the pelvis where the slice has it at a moment."""
    model, place, turn = body_model(humanoid), step.around.places[depth, moment], step.around.turns[depth, moment]
    q = np.zeros((1, DOF))
    q[0, DOF - len(upper) :] = upper
    still = np.zeros((1, 7))
    still[0, 2] = 2.0 * np.arctan2(turn[1], turn[3])
    capsules = posture_capsules(model, q, still)[model.capsules_of(group).indices].astype(np.float64)
    hips = posture_pelvis(humanoid, still)
    moved = capsules + np.tile(place - hips, 2)[None, :, None]
    radii = humanoid.capsules.radii[model.capsules_of(group).indices]
    return float(clearance(moved, radii, span_of(step.around.obstacles, depth))[0])


def posture_pelvis(humanoid: Humanoid, state: Floats) -> Floats:
    from elbowroom.body.pose.kinematics import pelvis_frames

    return np.asarray(pelvis_frames(body_model(humanoid), state)[0][0])


def test_looking_at_few_waists_gives_the_optimum_of_all(humanoid: Humanoid) -> None:
    dressing = dressed(humanoid, scene_of(POSTS), walk())
    lazy, whole = step_of(dressing), step_of(dressing)
    for depth in range(len(whole.filled)):
        whole.fill(depth, np.ones(whole.filled.shape[1], np.bool_))
    found, best = lazy.search(), whole.search()
    assert found.status is best.status is PlanStatus.FOUND
    assert np.isclose(found.cost, best.cost, atol=1e-5)
    assert lazy.checks < whole.checks


def any_triple(humanoid: Humanoid, rows: Rows, path: RootPath, depth: int) -> bool:
    """Whether any posture of the upper body is free in a slice."""
    step = step_of(dressed(humanoid, scene_of(rows), path))
    step.fill(depth, np.ones(step.filled.shape[1], np.bool_))
    problem = step.problem()
    free = (
        np.isfinite(problem.waist[depth])[:, None, None]
        & np.isfinite(problem.left[depth])[:, :, None]
        & np.isfinite(problem.right[depth])[:, None, :]
        & problem.apart[depth]
    )
    return bool(free.any())


@pytest.mark.parametrize("rows", [WALL, PILLARS, BRICKS])
def test_the_named_obstacles_close_the_slice_and_each_is_needed(humanoid: Humanoid, rows: Rows) -> None:
    path = walk(10)
    found = dressed(humanoid, scene_of(rows), path).blockade()
    depth = round(found.time / path.interval)
    assert found.kind is BlockadeKind.NO_POSTURE
    assert np.isclose(found.ahead, 1.1 * found.time)
    assert found.place[1] == pytest.approx(path.states[depth, 1])
    named = tuple(rows[box] for box in found.obstacles)
    assert named
    assert AWAY not in named
    assert not any_triple(humanoid, (*named, AWAY), path, depth)
    for box in named:
        rest = tuple(row for row in named if row is not box)
        assert any_triple(humanoid, (*rest, AWAY), path, depth)


def test_hardly_anything_is_asked_of_what_closes_nothing(humanoid: Humanoid, monkeypatch: pytest.MonkeyPatch) -> None:
    search, asked, closed_by = dressed(humanoid, scene_of(BRICKS), walk(10)), list[int](), SliceNodes.closed_by

    def counted(nodes: SliceNodes, obstacles: Nearby) -> Closed:
        asked.append(number_of(obstacles))
        return closed_by(nodes, obstacles)

    monkeypatch.setattr(SliceNodes, "closed_by", counted)
    named = search.blockade().obstacles
    assert named
    assert asked.count(1) < 0.5 * len(BRICKS), "one by one only what closes something"
    assert sum(asked) < 6 * len(BRICKS)


def test_added_postures_open_a_way_and_are_the_same_each_time(humanoid: Humanoid) -> None:
    """A beam that a few waists of the clips do not pass, and more waists do."""
    scene, path = scene_of((((0.0, 1.72, 1.3), (1.0, 0.22, 0.05)),)), walk(12)
    start = natural_walk()(path)[0]
    plans = []
    for _ in range(2):
        body = UpperBodyPlanner(humanoid, scene, ExactSettings(samples_share=0.1))
        coarse = body.plan(path, StartState(start, np.zeros_like(start)), effort=Effort.JOINT)
        tries = [body.plan(path, StartState(start, np.zeros_like(start))) for _ in range(3)]
        plans.append(tries[-1])
        body.reset()
        again = body.plan(path, StartState(start, np.zeros_like(start)), effort=Effort.JOINT)
        assert again.reached == coarse.reached
    assert coarse.reached < path.horizon
    assert plans[0].reached == path.horizon
    assert np.array_equal(plans[0].plan.configurations, plans[1].plan.configurations)
    waists = plans[0].plan.configurations[:, columns_of(DofGroup.WAIST)]
    assert np.abs(waists).max() > 0.2
