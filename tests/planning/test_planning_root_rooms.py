"""What the root planner keeps from plan to plan is what it would find again."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.geometry import quaternion
from elbowroom.planning.command import Command
from elbowroom.planning.root.line import TravelLine
from elbowroom.planning.root.line_rooms import Grid, LineRooms
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.turned_body import TurnedBody
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import about, joined, stacked
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

AVATAR = Humanoid.default()
BODY = TurnedBody(AVATAR)
GRID = Grid(0.1, 0.08, 7, 0.06)
ANGLES = np.array([-0.8, 0.0, 1.2])
LINE = TravelLine((0.0, 0.0), 3.0, -2.0, 0.7, 0.7, True)
SPEEDS = (1.1, 0.45)
NOTHING = stacked([Obstacles().standing] * 8)


def boxes_near(line: TravelLine, seed: int, count: int) -> Obstacles:
    """Random boxes beside the first three metres of a line."""
    rng, centers, turns, halves = np.random.default_rng(seed), [], [], []
    for _ in range(count):
        x, z = line.point(rng.uniform(-1.0, 3.0), rng.uniform(-1.2, 1.2))
        centers.append((x, rng.uniform(0.1, 1.8), z))
        turns.append(quaternion.about_axis(1, rng.uniform(-3.0, 3.0)))
        halves.append(rng.uniform(0.05, 0.4, 3))
    return Obstacles.boxes(centers, turns, halves)


@pytest.mark.parametrize("seed", range(4))
def test_rows_that_are_kept_are_those_that_would_be_found_anew(seed: int) -> None:
    boxes = boxes_near(LINE, seed, 6)
    walking = LineRooms(BODY, boxes, ANGLES, GRID)
    for first in (0, 2, 3, 9, 1, 40):
        previous = walking.ahead(LINE, SPEEDS, first, 8, NOTHING)[0]
        fresh = LineRooms(BODY, boxes, ANGLES, GRID).ahead(LINE, SPEEDS, first, 8, NOTHING)[0]
        np.testing.assert_array_equal(previous.clear, fresh.clear)
        np.testing.assert_array_equal(previous.shift, fresh.shift)
    other = LINE._replace(heading=0.9, facing=0.9)
    previous = walking.ahead(other, SPEEDS, 2, 8, NOTHING)[0]
    np.testing.assert_array_equal(
        previous.clear, LineRooms(BODY, boxes, ANGLES, GRID).ahead(other, SPEEDS, 2, 8, NOTHING)[0].clear
    )


@pytest.mark.parametrize("first", [0.0, 3.0, 4.37])
def test_the_room_is_the_clearance_of_the_body_moved_to_each_place(first: float) -> None:
    """The twin: every capsule at every place against every box; what passes counts in its own row alone."""
    standing, passing = boxes_near(LINE, 7, 5), [boxes_near(LINE, 20 + i, 2).standing for i in range(8)]
    grid = GRID._replace(aside=1e-9)  # so narrow that each place is its own best
    scratch = LineRooms(BODY, standing, ANGLES, grid).ahead(LINE, SPEEDS, first, 8, stacked(passing))[0]
    capsules = BODY.along(LINE, ANGLES, SPEEDS).capsules.astype(np.float64)
    for i in range(8):
        x, z = LINE.point(grid.step * (first + i))
        boxes = about(joined(standing.standing, passing[i]), x, z)
        for t, posed in enumerate(capsules):
            for g in range(3):
                part = slice(BODY.groups[g], BODY.groups[g + 1])
                wanted = min(float(clearance(posed[part, :, None], BODY.radii[part], boxes)[0]), grid.comfort)
                np.testing.assert_allclose(scratch.clear[g, i, :, t], wanted, atol=2e-6)


def test_boxes_that_pass_leave_nothing_behind() -> None:
    rooms = LineRooms(BODY, boxes_near(LINE, 3, 1), ANGLES, GRID)
    before = rooms.ahead(LINE, SPEEDS, 0, 8, NOTHING)[0]
    assert (
        rooms.ahead(LINE, SPEEDS, 0, 8, stacked([boxes_near(LINE, 4, 12).standing] * 8))[0].clear < before.clear
    ).any()
    np.testing.assert_array_equal(rooms.ahead(LINE, SPEEDS, 0, 8, NOTHING)[0].clear, before.clear)


@pytest.mark.parametrize("name", ["doorway", "c", "traffic"])
def test_who_knows_nothing_of_the_plans_before_finds_the_same_paths(name: str) -> None:
    """A walk whose planner keeps what it found, against a planner made anew for each plan."""
    scene = Scene.load(name)
    walking, state, evaded = RootPlanner(AVATAR, scene), scene.start._replace(x=scene.start.x + 0.03), False
    for i in range(14):
        fresh = RootPlanner(AVATAR, scene)
        fresh.memory = walking.memory
        asked = state, Command(forward=1.0), 12, 0.15, 0.15 * i, (1.0, 0.6)
        known, found = list(walking.candidates(*asked)), list(fresh.candidates(*asked))
        assert [plan.kind for plan in known] == [plan.kind for plan in found]
        for one, other in zip(known, found, strict=True):
            np.testing.assert_array_equal(one.path.states, other.path.states)
            assert one.lost == other.lost
        walking.follow(known[0])
        evaded = evaded or known[0].kind.value == "evasion"
        state = RootState(*known[0].path.states[1].tolist())
    assert evaded == (name == "doorway")
