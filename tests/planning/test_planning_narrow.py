"""Narrow places: only what stands to both sides counts, and what it asks for follows the room smoothly."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL, DofGroup, columns_of, within_limits
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import ROOT_STATE, RootState
from elbowroom.planning.command import Command
from elbowroom.planning.exact.sweep.own_body_nodes import SPARE
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.narrow.build import build_of
from elbowroom.planning.narrow.goals import goals_where_narrow
from elbowroom.planning.narrow.pace import slow_places
from elbowroom.planning.narrow.places import NarrowPlaces
from elbowroom.planning.root.line.line import new_line
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

HUMANOID = Humanoid.default()
MODEL = body_model(HUMANOID)
BUILD = build_of(HUMANOID, MODEL)
WIDTH = 2.0 * BUILD.broad  # of the shoulders
TWIST = columns_of(DofGroup.WAIST).start + 1
AT = 2.0  # metres ahead: where things stand
FAR = 4.0  # metres: out of sight of who sets out
T = 0.15


def scene(*boxes: tuple[float, float, float, float]) -> Scene:
    """Boxes as high as a wall: the middle's x and z, and the size along x and z."""
    obstacles = [{"type": "box", "center": [x, 1.1, z], "size": [a, 2.2, b]} for x, z, a, b in boxes]
    return Scene.of("narrow", obstacles, finish=(0.0, 5.0))


def gap(width: float, thick: float = 0.1) -> Scene:
    return scene(*((side * 0.5 * (width + 1.0), AT, 1.0, thick) for side in (-1.0, 1.0)))


def walk(speed: float = 1.1, heading: float = 0.0, turned: float = 0.0) -> RootPath:
    """From the origin, going where `heading` points, with the hips turned to the left of that."""
    states, gone = np.zeros((21, ROOT_STATE)), speed * T * np.arange(21.0)
    states[:, 0], states[:, 1], states[:, 2] = gone * np.sin(heading), gone * np.cos(heading), heading + turned
    states[:, 3], states[:, 4] = speed * np.cos(turned), -speed * np.sin(turned)
    return RootPath(0.0, T, states)


def wanted(place: Scene, path: RootPath) -> Floats:
    return goals_where_narrow(NarrowPlaces(BUILD, place.free_map), path, natural_walk()(path))


def most_turned(width: float) -> float:
    """How far shoulders would like to turn in a gap, degrees."""
    return float(np.rad2deg(np.abs(wanted(gap(width), walk())[:, TWIST]).max()))


@pytest.mark.parametrize(
    "place",
    [
        scene(),
        scene((0.45, AT, 0.4, 3.0)),  # a wall beside
        scene((0.0, 3.5, 4.0, 0.2)),  # a wall ahead
        scene((0.0, -0.4, 4.0, 0.2)),  # a wall behind
        gap(1.5 * WIDTH + 0.05),
    ],
    ids=["open", "beside", "ahead", "behind", "wide"],
)
def test_with_room_to_one_side_nothing_is_asked_for(place: Scene) -> None:
    path = walk()
    assert np.array_equal(wanted(place, path), natural_walk()(path))


def test_what_is_lower_than_elbows_turns_no_shoulders() -> None:
    low = [{"type": "box", "center": [x, 0.4, AT], "size": [0.4, 0.8, 0.4]} for x in (-0.45, 0.45)]
    path = walk()
    assert np.array_equal(wanted(Scene.of("tables", low, finish=(0.0, 5.0)), path), natural_walk()(path))


def test_shoulders_turn_the_more_the_narrower_it_is_and_by_no_leaps() -> None:
    widths = WIDTH * np.arange(1.5, 0.949, -0.01)
    turns = np.array([most_turned(width) for width in widths])
    assert turns[0] < 1e-9
    assert np.all(np.diff(turns) > -0.5)
    assert np.abs(np.diff(turns)).max() < 4.0  # degrees for a hundredth of a shoulder width
    onset = float(widths[turns >= 20.0].max()) / WIDTH
    assert 1.10 <= onset <= 1.30
    assert turns[-1] > 44.0


@given(ratio=st.floats(1.1, 1.5), thick=st.floats(0.02, 0.6))
@settings(max_examples=20, deadline=None)
def test_upper_bodies_that_do_as_they_like_leave_some_centimetres(ratio: float, thick: float) -> None:
    path, half = walk(), 0.5 * ratio * WIDTH
    goals = wanted(gap(2.0 * half, thick), path)
    q, centred = np.zeros((len(goals), DOF)), path.states.copy()
    q[:, DOF - LOCAL :] = goals
    assert within_limits(q)
    ends = posture_capsules(MODEL, q, centred).reshape(-1, 2, 3, len(goals)).astype(np.float64)
    along = ends[:, 0, None] + np.linspace(0.0, 1.0, 9)[:, None, None] * (ends[:, 1, None] - ends[:, 0, None])
    aside = half - np.abs(along[:, :, 0])
    beyond = np.maximum(np.abs(along[:, :, 2] - AT) - 0.5 * thick, 0.0)
    clear = np.hypot(aside, beyond) - MODEL.body.radii[:, None, None]
    upper = np.concatenate([HUMANOID.capsules.of(group) for group in DofGroup if group is not DofGroup.ROOT])
    assert clear[upper].min() > 0.035


def test_nothing_is_liked_in_which_the_body_runs_into_itself() -> None:
    """Arms that are drawn in, and shoulders that turn, leave a centimetre at every moment of a stride, as nodes do."""
    pairs, least = self_pairs(MODEL), []
    for ratio in np.arange(0.95, 1.6, 0.05):
        for begins in (0.0, 0.2, 0.4):
            path = walk()
            path.states[:, 6] = begins + 0.9 * T * np.arange(len(path.states))
            least.append(self_clearances(MODEL, pairs, path.states, wanted(gap(ratio * WIDTH), path)).min())
    assert min(least) > SPARE


@pytest.mark.parametrize("heading", [0.0, 0.7])
@pytest.mark.parametrize("turned", [0.3, -0.3])
def test_shoulders_turn_on_where_the_hips_are_turned(heading: float, turned: float) -> None:
    width = WIDTH * 1.05
    sine, cosine = np.sin(heading), np.cos(heading)
    boxes = [
        {
            "type": "box",
            "center": [AT * sine + side * cosine, 1.1, AT * cosine - side * sine],
            "size": [1.0, 2.2, 0.1],
            "yaw": heading,
        }
        for side in (0.5 * width + 0.5, -0.5 * width - 0.5)
    ]
    path = walk(heading=heading, turned=turned)
    twists = wanted(Scene.of("slanting", boxes, finish=(0.0, 5.0)), path)[:, TWIST]
    straight = wanted(gap(width), walk())[:, TWIST]
    assert np.all(np.sign(turned) * twists >= 0.0)
    assert np.abs(twists).max() == pytest.approx(np.abs(straight).max() - abs(turned), abs=0.05)


def test_who_stands_in_a_narrow_place_stays_turned() -> None:
    states = np.zeros((5, ROOT_STATE))
    states[:, 1] = AT
    found = wanted(gap(1.05 * WIDTH), RootPath(0.0, T, states))
    assert np.abs(np.rad2deg(found[:, TWIST]) - most_turned(1.05 * WIDTH)).max() < 1.0


def test_the_narrower_the_slower_and_wide_places_are_not_slow() -> None:
    line = new_line(RootState(), Command(forward=1.0), RootMotionSettings())
    shares = []
    for ratio in np.arange(1.45, 0.9, -0.05):
        places = slow_places(NarrowPlaces(BUILD, gap(ratio * WIDTH).free_map), line, 0.0, 4.0, 0.0)
        assert np.all(np.abs(places[:, 1] - AT) < 0.2)
        shares.append(float(places[:, 2].min(initial=1.0)))
    assert shares[0] == pytest.approx(1.0)
    assert np.all(np.diff(shares) <= 1e-9)
    assert 0.6 <= shares[-1] < 0.8


def test_slowing_down_is_the_same_from_plan_to_plan_and_costs_nothing() -> None:
    planner, command = RootPlanner(HUMANOID, gap(1.12 * WIDTH)), Command(forward=1.0)
    plan = planner.plan(Asked(RootState(forward=1.1), command, 16, T))
    speeds = plan.path.states[:, 3]
    assert speeds.min() < 0.95
    assert speeds[-1] > speeds.min()
    assert plan.lost == pytest.approx(0.0, abs=1e-6)
    for k in range(1, 14):
        later = planner.plan(Asked(RootState(*plan.path.states[k].tolist()), command, 16 - k, T, k * T))
        assert np.abs(later.path.states - plan.path.states[k:]).max() < 1e-9
        assert later.lost == pytest.approx(0.0, abs=0.01)


def crossed_at(place: Scene) -> float:
    """How far to the left somebody is who walks on and comes to what stands `FAR` metres ahead."""
    planner, start = RootPlanner(HUMANOID, place), RootState()
    for step in range(40):
        path = planner.plan(Asked(start, Command(forward=1.0), 16, T, 2.0 * T * step)).path
        if path.states[2, 1] > FAR:
            return float(np.interp(FAR, path.states[:, 1], path.states[:, 0]))
        start = RootState.of(path.states[2])
    raise AssertionError("nobody came there")


def between(ratio: float, wide: float) -> Scene:
    """Two posts or walls, so many shoulder widths apart and so many metres `wide`."""
    return scene(*((side * 0.5 * (ratio * WIDTH + wide), FAR, wide, 0.1) for side in (-1.0, 1.0)))


@pytest.mark.parametrize("wide", [0.1, 0.2, 0.3])
@pytest.mark.parametrize("ratio", [1.0, 1.1, 1.2, 1.3])
def test_in_the_open_one_walks_round_a_narrow_gap_with_room_to_spare(ratio: float, wide: float) -> None:
    outside = abs(crossed_at(between(ratio, wide))) - (0.5 * ratio * WIDTH + wide)
    assert outside > BUILD.swinging + 0.04


@pytest.mark.parametrize(("ratio", "wide"), [(1.4, 0.2), (1.0, 1.0), (1.1, 1.0), (1.2, 1.0)])
def test_where_it_is_broad_enough_or_far_to_go_round_one_walks_through(ratio: float, wide: float) -> None:
    assert abs(crossed_at(between(ratio, wide))) < 0.03


def test_who_finds_no_way_for_the_upper_body_beside_a_gap_is_offered_the_way_through() -> None:
    planner = RootPlanner(HUMANOID, between(1.1, 0.2))
    start = RootState(0.0, 1.2, 0.0, 1.1)
    plans = list(planner.candidates(Asked(start, Command(forward=1.0), 16, T)))
    assert plans[0].beside
    assert any(not plan.beside and np.abs(plan.path.states[:, 0]).max() < 0.03 for plan in plans[1:])
