"""The map of free distances, the room that a body has on a grid, and paths that do not depend on what is remembered."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.geometry import quaternion
from elbowroom.planning.command import Command
from elbowroom.planning.root.evasion.room import GridFloor, LineGrid, Room, free_distance
from elbowroom.planning.root.evasion.turned_body import TurnedBody
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.free_map import CELL, FARTHEST, LEVELS
from elbowroom.world.obstacles.layout import Spans
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import about, joined, span_of
from elbowroom.world.scene import Scene
from sampled import sampled
from shapes import stacked

Floats = NDArray[np.float64]

AVATAR = Humanoid.default()
ANGLES = np.array([-0.8, 0.0, 1.2])
BODY = TurnedBody(AVATAR, ANGLES)
GRID = LineGrid(0.3, 0.1, 0.08, 8, 7, 0.06, 0.012, 0.047)
FLAT = GridFloor(np.zeros((8, 7)), -np.inf)
LINE = TravelLine((0.0, 0.0), 3.0, -2.0, 0.7, 0.7, True)
LOW, HIGH = np.array([1.0, -4.0]), np.array([6.0, 1.0])
SPEEDS = (1.1, 0.45)


def boxes_near(line: TravelLine, seed: int, count: int) -> Obstacles:
    """Random upright boxes beside the first three metres of a line."""
    rng = np.random.default_rng(seed)
    places = [line.point(rng.uniform(-1.0, 3.0), rng.uniform(-1.2, 1.2)) for _ in range(count)]
    centers = np.array([(x, rng.uniform(0.1, 1.8), z) for x, z in places])
    turns, halves = quaternion.about_axis(1, rng.uniform(-3.0, 3.0, count)), rng.uniform(0.05, 0.4, (count, 3))
    return Obstacles.boxes(centers, turns, halves)


def room_among(boxes: Obstacles, passing: Spans) -> Room:
    turned = BODY.going(LINE.heading - LINE.facing, SPEEDS)
    return Room(BODY, turned, LINE, GRID, (boxes.free_map.window(LOW, HIGH), FLAT), boxes.standing, passing)


NOTHING = stacked([Obstacles().standing] * GRID.rows)


@pytest.mark.parametrize("seed", range(3))
def test_the_map_tells_how_far_away_the_next_box_is(seed: int) -> None:
    boxes, rng = boxes_near(LINE, seed, 6), np.random.default_rng(seed)
    window = boxes.free_map.window(LOW, HIGH)
    for _ in range(300):
        x, z, level = rng.uniform(1.5, 5.5), rng.uniform(-3.5, 0.5), int(rng.integers(len(LEVELS)))
        ends = np.array([x, LEVELS[level] - 0.06, z, x, LEVELS[level] + 0.06, z])
        true = min(float(clearance(ends[None, :, None], np.zeros(1), boxes.standing)[0]), FARTHEST)
        told = free_distance(window.distances, level, (x - window.x) / CELL, (z - window.z) / CELL)
        assert told == pytest.approx(true, abs=0.71 * CELL)


def test_what_is_on_the_map_does_not_depend_on_who_came_first() -> None:
    one, other = (boxes_near(LINE, 5, 8).free_map for _ in range(2))
    for middle in np.random.default_rng(1).uniform(LOW, HIGH, (6, 2)):
        other.window(middle - 0.5, middle + 0.5)
    first, second = one.window(LOW, HIGH), other.window(LOW, HIGH)
    np.testing.assert_array_equal(first.distances, second.distances)
    assert first[1:] == second[1:]


def test_all_planners_in_a_place_share_one_map() -> None:
    boxes = boxes_near(LINE, 5, 3)
    assert boxes.free_map is boxes.free_map


@pytest.mark.parametrize("seed", range(4))
def test_a_cell_that_was_looked_into_has_the_clearance_of_the_body_at_its_best_place(seed: int) -> None:
    """The twin: every capsule against every box at that place."""
    boxes, passing = (
        boxes_near(LINE, seed, 5),
        stacked([boxes_near(LINE, 20 + i, 2).standing for i in range(GRID.rows)]),
    )
    rng, room = np.random.default_rng(seed), room_among(boxes, passing)
    cells = np.stack([rng.integers(0, GRID.columns, GRID.rows), rng.integers(0, len(ANGLES), GRID.rows)], axis=1)
    narrow = [min(room.clear[:2, i, j, t]) < 0.06 for i, (j, t) in enumerate(cells)]
    assert room.check_narrow(cells) == any(narrow)
    assert not room.check_narrow(cells)
    capsules, (sine, cosine) = BODY.going(0.0, SPEEDS).capsules, (np.sin(LINE.facing), np.cos(LINE.facing))
    for i, (j, t) in enumerate(cells):
        left = GRID.aside * (j - GRID.columns // 2) + room.shift[i, j, t]
        x, z = LINE.point(GRID.first + GRID.step * i, left)
        ends = capsules[t].reshape(-1, 3).astype(np.float64)
        turned = np.stack(
            [ends[:, 0] * cosine + ends[:, 2] * sine, ends[:, 1], ends[:, 2] * cosine - ends[:, 0] * sine]
        )
        posed = turned.T.reshape(-1, 6)
        near = about(joined(boxes.standing, span_of(passing, i)), x, z)
        for g in range(3 * narrow[i]):
            part = slice(BODY.groups[g], BODY.groups[g + 1])
            wanted = min(float(clearance(posed[part, :, None], BODY.radii[part], near)[0]), GRID.comfort)
            assert room.clear[g, i, j, t] == pytest.approx(wanted, abs=0.006)


def test_the_map_hardly_ever_closes_a_cell_that_is_free() -> None:
    """What it takes for closed is not checked: so it must be right about that."""
    closed, wrong = 0, 0
    for seed in range(12):
        boxes = boxes_near(LINE, seed, 5)
        guessed, known = room_among(boxes, NOTHING), room_among(boxes, NOTHING)
        for j in range(GRID.columns):
            for t in range(len(ANGLES)):
                known.check_narrow(np.tile([j, t], (GRID.rows, 1)))
        shut = guessed.clear[0] < GRID.margin
        closed, wrong = closed + int(shut.sum()), wrong + int((shut & (known.clear[0] >= GRID.margin)).sum())
    assert closed > 100
    assert wrong < 0.02 * closed


def test_boxes_that_pass_lower_the_room_and_leave_nothing_behind() -> None:
    boxes = boxes_near(LINE, 3, 1)
    before = room_among(boxes, NOTHING)
    crowd = stacked([boxes_near(LINE, 4, 12).standing] * GRID.rows)
    assert (room_among(boxes, crowd).clear < before.clear).any()
    np.testing.assert_array_equal(room_among(boxes, NOTHING).clear, before.clear)


@pytest.mark.parametrize("name", sampled(["doorway", "c", "traffic"]))
def test_who_knows_nothing_of_the_plans_before_finds_the_same_paths(name: str) -> None:
    """A walk whose planner keeps what it found, against a planner made anew for each plan."""
    scene = Scene.load(name)
    walking, state, evaded = RootPlanner(AVATAR, scene), scene.start._replace(x=scene.start.x + 0.03), False
    for i in range(14):
        fresh = RootPlanner(AVATAR, scene)
        fresh.memory = walking.memory
        asked = Asked(state, Command(forward=1.0), 12, 0.15, 0.15 * i)
        known, found = (list(planner.candidates(asked, (1.0, 0.6))) for planner in (walking, fresh))
        assert [plan.kind for plan in known] == [plan.kind for plan in found]
        for one, other in zip(known, found, strict=True):
            np.testing.assert_array_equal(one.path.states, other.path.states)
            assert one.lost == other.lost
        walking.follow(known[0])
        evaded = evaded or known[0].kind.value == "evasion"
        state = RootState(*known[0].path.states[1].tolist())
    assert evaded == (name == "doorway")
