"""Evasions: the cheapest way aside or turned, no way where there is none, and the walk that follows it."""

import itertools
import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, leg_capsules
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root.evasion.evasion import EvasionFinder, EvasionSettings
from elbowroom.planning.root.evasion.grid_search import GridPrices, cheapest
from elbowroom.planning.root.evasion.profile import PacedLine, follow_profile, turned_speed
from elbowroom.planning.root.line.line import new_line
from elbowroom.planning.root.motion import MotionBounds
from elbowroom.planning.root.plan import RootPlan, RootPlanKind
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.shapes import Box
from elbowroom.world.obstacles.tracks.moving import Moving, Repeat, Track
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

AVATAR = Humanoid.default()
FORWARD = Command(forward=1.0)
WALKING = RootState(z=0.6, forward=1.1)


def with_boxes(*boxes: tuple[list[float], list[float]]) -> Scene:
    rows = [{"type": "box", "center": center, "size": size} for center, size in boxes]
    return Scene.from_dict({**Scene.load("empty").to_dict(), "obstacles": rows})


def gap(width: float) -> Scene:
    """Two walls across the way at z 2.2, 0.2 m thick, with a gap in the middle."""
    walls: list[tuple[list[float], list[float]]] = [
        ([side * (0.5 * width + 2.0), 1.1, 2.2], [4.0, 2.2, 0.2]) for side in (-1.0, 1.0)
    ]
    return with_boxes(*walls)


def evasion(scene: Scene, start: RootState = WALKING) -> Any:
    finder = EvasionFinder(AVATAR, scene)
    grid = finder.ahead_of(new_line(start, FORWARD, RootMotionSettings()), start, 3.2, (1.1, 0.45), Moving(), 0.0)
    assert grid is not None
    return grid.cheapest(finder.settings.bodies[0], None)


def test_nothing_in_the_way_is_walked_straight() -> None:
    found = evasion(with_boxes())
    assert found.whole
    assert not found.profile.rows.any()
    assert found.cost == pytest.approx(0.0, abs=1e-6)


def test_the_body_turns_in_a_gap_narrower_than_the_shoulders_and_back_behind_it() -> None:
    found = evasion(gap(0.42))
    ahead = WALKING.z + found.profile.first + found.profile.step * np.arange(len(found.profile.rows))
    turned = np.abs(found.profile.rows[:, 1])
    assert found.whole
    assert turned[np.abs(ahead - 2.2) < 0.12].min() > math.radians(80.0)
    assert turned[ahead < 1.4].max() == 0.0
    assert turned[ahead > 3.2].max() == 0.0


def test_a_panel_is_passed_by_a_step_aside() -> None:
    found = evasion(with_boxes(([0.35, 1.5, 2.0], [0.6, 1.0, 0.2])))
    left = found.profile.rows[:, 0]
    assert found.whole
    assert -0.3 < left.min() < -0.1
    assert abs(left[-1]) < 0.05


@pytest.mark.parametrize("width", [0.2, 0.3])
def test_what_no_turn_gets_through_has_no_way_to_the_end(width: float) -> None:
    assert not evasion(gap(width)).whole


def test_the_search_finds_the_optimum_of_all_ways() -> None:
    """The twin tries every way through small random grids."""
    rng = np.random.default_rng(3)
    for _ in range(12):
        clear = rng.uniform(-0.02, 0.06, (3, 5, 3, 3)).astype(np.float32)
        clear[:, 0, 1, 1] = 0.06
        prices = GridPrices(0.0, 0.01, 0.06, 0.3, 0.1, 0.2, 0.25, 0.3, (3.0, 2.0, 1.0), 0.05, (0.4, 0.1))
        standing, favoured = rng.uniform(0.0, 0.3, 3), rng.integers(0, 3, (5, 2))
        way, cost = cheapest(clear, standing, prices, np.array([1, 1]), favoured)
        costs = [_cost_of(list(cells), clear, standing, prices, favoured) for cells in _ways()]
        best = min(costs)
        assert math.isfinite(best) == (len(way) == 5)
        if math.isfinite(best):
            assert cost == pytest.approx(best, abs=1e-6)
            assert _cost_of([tuple(cell) for cell in way[1:]], clear, standing, prices, favoured) == pytest.approx(best)


def _ways() -> Any:
    cells = list(itertools.product(range(3), range(3)))
    return itertools.product(cells, repeat=4)


def _cost_of(cells: list[Any], clear: Any, standing: Floats, prices: Any, favoured: Any) -> float:
    """What a way costs, with the cheapest turn on the spot before it."""
    turned = prices.margin + prices.swerving
    costs = [_cost_from(1, cells, clear, standing, prices, favoured)]
    for t in (0, 2):
        if clear[0, 0, 1, t] >= turned:
            costs.append(prices.spot + _cost_from(t, cells, clear, standing, prices, favoured))
    return min(costs)


def _cost_from(t0: int, cells: list[Any], clear: Any, standing: Floats, prices: Any, favoured: Any) -> float:
    total, j0, here = 0.0, 1, min(float(clear[0, 0, 1, 1]), prices.margin)
    for i, (j, t) in enumerate(cells, start=1):
        if max(abs(j - j0), abs(t - t0)) > 1 or clear[0, i, j, t] < (here if i <= 3 else prices.margin):
            return math.inf
        if t != t0 and min(clear[0, i, j, t], clear[0, i - 1, j0, t0]) < prices.margin + prices.swerving:
            return math.inf
        total += prices.shifting * (j - j0) ** 2 + prices.turning * (t - t0) ** 2
        total += standing[t] + prices.beside * (j - 1) ** 2 + prices.leftward * max(j - 1, 0)
        total += sum(prices.bodies[g] * (prices.comfort - clear[g, i, j, t]) for g in range(3))
        if abs(favoured[i, 0] - j) <= 1 and abs(favoured[i, 1] - t) <= 1:
            total -= prices.keeping
        j0, t0 = j, t
    return float(total + prices.ends[0] * (j0 - 1) ** 2 + prices.ends[1] * (t0 - 1) ** 2)


def test_a_profile_is_followed_closely_and_within_the_bounds() -> None:
    rows = np.zeros((33, 2))
    rows[8:14, 0], rows[6:8, 0], rows[14:16, 0] = 0.12, (0.04, 0.08), (0.08, 0.04)
    rows[10:20, 1] = np.radians([20, 40, 60, 80, 80, 80, 60, 40, 20, 0])
    states, bounds = np.zeros((30, 7)), MotionBounds(2.5, 2.0, 3.0, 14.0)
    states[0, 3] = 1.0
    follow_profile(states, rows, 0.0, 0.1, PacedLine(0.0, 0.0, 0.0, 0.0, 1.1, 0.45, False), 0.15, bounds)
    wanted = np.interp(states[:, 1], 0.1 * np.arange(33), rows[:, 0])
    assert np.abs(states[:, 0] - wanted).max() < 0.04
    turned = np.interp(states[:, 1], 0.1 * np.arange(33), rows[:, 1])
    assert np.abs(states[:, 2] - turned).max() < math.radians(12.0)
    assert np.abs(states[:, 5]).max() <= 2.5
    sideways = np.abs(states[:, 2]) > math.radians(70.0)
    assert np.hypot(states[sideways, 3], states[sideways, 4]).max() < 0.75


def test_sideways_one_is_slower() -> None:
    assert turned_speed(1.1, 0.45, 0.0) == pytest.approx(1.1)
    assert turned_speed(1.1, 0.45, 0.5 * math.pi) == pytest.approx(0.45)
    assert 0.45 < turned_speed(1.1, 0.45, 0.8) < 1.1


def candidates(scene: Scene, start: RootState = WALKING, command: Command = FORWARD) -> list[RootPlan]:
    return list(RootPlanner(AVATAR, scene).candidates(Asked(start, command, 16, 0.15, 2.0), (1.0, 0.6, 0.35)))


def test_where_nothing_is_lost_the_path_as_commanded_comes_first() -> None:
    found = candidates(Scene.load("c"))
    assert found[0].kind is RootPlanKind.STRAIGHT
    assert RootPlanKind.EVASION in {plan.kind for plan in found}
    assert all(plan.path.start_time == 2.0 and plan.path.horizon == 16 for plan in found)


def test_before_a_narrow_doorway_the_turned_way_comes_first_and_its_legs_are_free() -> None:
    scene = Scene.load("doorway")
    first = candidates(scene, RootState(z=1.2, forward=1.1))[0]
    assert first.kind is RootPlanKind.EVASION
    assert np.abs(first.path.states[:, 2]).max() > math.radians(75.0)
    model = body_model(AVATAR)
    states = first.path.sample(np.linspace(2.0, 4.4, 600))
    assert clearance(leg_capsules(model, states), model.roots.radii, scene.obstacles.standing).min() > 0.0


@pytest.mark.parametrize("command", [Command(), Command(forward=0.5, turn=0.5)])
def test_who_stands_or_turns_by_hand_is_not_led_aside(command: Command) -> None:
    assert all(plan.kind is not RootPlanKind.EVASION for plan in candidates(Scene.load("c"), command=command))


def test_who_lets_go_while_turned_still_means_the_way_he_went() -> None:
    planner, start = RootPlanner(AVATAR, Scene.load("doorway")), RootState(z=0.8, forward=1.1)
    first = next(iter(planner.candidates(Asked(start, FORWARD, 20, 0.15))))
    turns = np.abs(first.path.states[:, 2]) > math.radians(40.0)
    assert turns.any()
    turned = RootState(*first.path.states[np.argmax(turns)].tolist())
    stop = next(iter(planner.candidates(Asked(turned, Command(), 16, 0.15))))
    standing = RootState(*stop.path.states[-1].tolist())
    on = next(iter(planner.candidates(Asked(standing, FORWARD, 16, 0.15))))
    assert on.path.states[-1, 1] > standing.z + 0.4


def half_of_a_corridor(edge: float, near: float) -> Moving:
    """What somebody who comes towards one keeps to: all that is left of an edge, from so far ahead on, metres."""
    box, center = Box((0.5, 2.0, 3.3 - near)), np.array([[edge + 0.25, 1.0, 0.5 * (near + 3.3)]])
    return Moving((Track("half", box, np.zeros(1), center, np.zeros(1), Repeat.ONCE),))


def farthest_turn(plan: RootPlan) -> float:
    """The heading that is farthest from straight on along a path: its sign tells which shoulder goes first."""
    headings = plan.path.states[:, 2]
    return float(headings[np.abs(headings).argmax()])


@pytest.mark.parametrize("seed", range(3))
def test_who_goes_past_with_one_shoulder_first_does_not_change_to_the_other(seed: int) -> None:
    """Both ways cost about the same, and where the other walks is seen a little elsewhere in every plan."""
    walls: list[tuple[list[float], list[float]]] = [([x, 1.25, 3.0], [0.2, 2.5, 14.0]) for x in (-0.64, 0.64)]
    planner, rng, state = RootPlanner(AVATAR, with_boxes(*walls)), np.random.default_rng(seed), RootState(x=0.15)
    firsts = []
    for i in range(20):
        planner.others = half_of_a_corridor(-0.01 + rng.uniform(-0.006, 0.006), 1.4 - 0.02 * i)
        found = planner.candidates(Asked(state, Command(forward=0.62), 16, 0.15, 0.15 * i), (0.6, 0.35, 0.2))
        taken = next(plan for plan in found if plan.kind is RootPlanKind.EVASION)
        planner.follow(taken)
        firsts.append(farthest_turn(taken))
        state = RootState(*taken.path.states[1].tolist())
    assert min(firsts) * max(firsts) > 0.0
    assert state.z > 1.2


@pytest.mark.parametrize("seed", [0, 2, 3])
def test_who_steers_through_a_gap_keeps_to_the_shoulder_that_goes_first(seed: int) -> None:
    """A hand is never still: every plan is asked for a little elsewhere, and both shoulders cost about the same."""
    planner, rng, state, firsts = RootPlanner(AVATAR, gap(0.4)), np.random.default_rng(seed), WALKING, []
    for i in range(18):
        hand = Command(forward=1.0, direction=rng.uniform(-0.07, 0.07))
        found = planner.candidates(Asked(state, hand, 16, 0.15, 0.15 * i), (0.6, 0.35, 0.2))
        taken = next((plan for plan in found if plan.kind is RootPlanKind.EVASION), None)
        if taken is None:
            break
        planner.follow(taken)
        firsts.append(farthest_turn(taken))
        state = RootState(*taken.path.states[1].tolist())
    assert min(firsts) * max(firsts) > 0.0
    assert state.z > 2.2


def test_settings_give_turns_to_both_sides() -> None:
    angles = EvasionSettings().angles
    np.testing.assert_allclose(angles, -angles[::-1])
    assert angles[-1] == pytest.approx(0.5 * math.pi)
