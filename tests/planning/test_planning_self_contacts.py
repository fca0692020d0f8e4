"""What an arm ran into is not tried again on the same path while the body is the same; nor is it if it is liked."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, SEARCH_ORDER, DofGroup, columns_of
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.exact.group.own_contacts import OwnContact, rule_out_near
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan import upper_body
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.sweep.own_motion import OwnMotion
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.interpolation import hermite
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.narrow.places import NarrowPlaces
from elbowroom.planning.result import PlanStatus
from elbowroom.planning.root.path import RootPath
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

STEP = 0.15  # seconds between key frames
WAIST, ARM = np.array([0.1, 0.0, 0.0]), np.array([0.5, 0.2, 0.0, 1.0])


def test_a_contact_happens_again_while_the_groups_before_are_the_same() -> None:
    contact = OwnContact(DofGroup.LEFT_ARM, 5, WAIST, ARM, 0.15)
    assert contact.happens(WAIST + 1e-9)
    assert not contact.happens(WAIST + 0.01)


def test_nodes_near_to_what_touched_are_ruled_out() -> None:
    rng = np.random.default_rng(0)
    known, own = ARM + rng.uniform(-0.15, 0.15, (30, 4)), ARM + rng.uniform(-0.15, 0.15, (10, 4))
    costs = np.zeros(32 + 10, np.float32)
    costs[7] = np.inf
    rule_out_near(costs, known, own, ARM, 0.15)
    expected = np.concatenate([np.linalg.norm(rows - ARM, axis=1) < 0.15 for rows in (known, np.zeros((2, 4)), own)])
    expected[7] = True
    assert np.array_equal(np.isinf(costs), expected)
    assert 5 < expected.sum() < 37


@pytest.mark.parametrize("group", [DofGroup.LEFT_ARM, DofGroup.RIGHT_ARM])
def test_a_body_that_would_like_to_run_into_itself_does_not(group: DofGroup, monkeypatch: pytest.MonkeyPatch) -> None:
    """Only of the natural walk is it known that it touches nothing of the body."""
    humanoid, step, count = proportional_humanoid(1.72), 0.15, 12
    model, times = body_model(humanoid), step * np.arange(count + 1.0)
    states = np.zeros((count + 1, ROOT_STATE))
    states[:, 1], states[:, 3], states[:, 6] = 1.1 * times, 1.1, 0.9 * times
    liked = natural_walk()(RootPath(0.0, step, states))
    share = np.clip((times - 2.0 * step) / (4.0 * step), 0.0, 1.0)[:, None]
    liked[:, columns_of(group)] += share * (np.array([-0.1, 0.0, 0.0, 0.3]) - liked[:, columns_of(group)])

    def folded(narrow: NarrowPlaces, path: RootPath, goals: Floats) -> Floats:
        return liked

    def least(uppers: Floats, rows: Floats) -> float:
        return float(self_clearances(model, self_pairs(model), rows, uppers).min())

    monkeypatch.setattr(upper_body, "goals_where_narrow", folded)
    post = {"type": "box", "center": [0.9, 1.0, 1.0], "size": [0.2, 2.0, 0.2]}
    planner = UpperBodyPlanner(humanoid, Scene.of("post", [post], finish=(0.0, 5.0)), ExactSettings())
    path, start = (
        RootPath(0.0, step, states),
        StartState(natural_walk()(RootPath(0.0, step, states))[0], np.zeros(LOCAL)),
    )
    plan = planner.plan(path, start).plan
    assert plan.velocities is not None
    assert least(liked, states) < -0.005
    moments = np.linspace(0.0, times[-1], 8 * count + 1)
    shown = np.array([hermite(times, plan.configurations, plan.velocities, moment)[0] for moment in moments])
    assert least(shown, path.sample(moments)) >= 0.0


def test_all_places_where_a_motion_runs_into_the_body_are_ruled_out_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Here the body is wherever the arm swings: one place after the other would take as many motions as intervals."""
    arm, scene = columns_of(DofGroup.RIGHT_ARM), Scene.load("d")
    planner = UpperBodyPlanner(proportional_humanoid(1.72), scene, ExactSettings(self_rounds=2))
    path = RootPath(0.0, STEP, np.tile(scene.start.as_array(), (13, 1)))
    swung, motions = natural_walk()(path)[:, arm], list[int]()

    def contacts(_: OwnMotion, path: RootPath, keys: Floats, rates: Floats, walk: Floats, ahead: int) -> Longs:
        near = np.linalg.norm(keys[1:, arm] - swung[1:], axis=1) < 0.1
        near[:2] = False
        motions.append(int(near.sum()))
        return np.where(near, SEARCH_ORDER.index(DofGroup.RIGHT_ARM), -1)

    monkeypatch.setattr(OwnMotion, "contacts", contacts)
    plan = planner.plan(path, StartState(natural_walk()(path)[0], np.zeros(LOCAL))).plan
    assert plan.status is PlanStatus.FOUND
    assert motions == [10, 0]
