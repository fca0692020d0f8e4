"""Walking along a way with corners: which leg one is on, what lies ahead, and that a path goes on as it was."""

import itertools
import math

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root.line.way_ahead import leg_at, way_ahead
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlanKind
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.world.scene import Scene

WAY = ((0.0, 0.0), (0.0, 3.0), (2.0, 3.0), (2.0, 9.0))
INTERVAL = 0.15


def test_the_next_leg_is_reached_where_it_is_nearer_and_none_is_left_out() -> None:
    assert leg_at(WAY, 0.1, 1.0, 0) == 0
    assert leg_at(WAY, 0.5, 2.9, 0) == 1
    assert leg_at(WAY, 2.0, 8.0, 1) == 2
    assert leg_at(WAY, 0.0, 0.0, 2) == 2  # nobody goes back


def test_along_a_thin_wall_one_stays_on_ones_side() -> None:
    """The way back is nearer to who walks a little aside, but it is not the next leg."""
    there_and_back = ((0.0, 0.0), (0.0, 5.0), (0.3, 5.0), (0.3, 0.0))
    assert leg_at(there_and_back, 0.25, 2.0, 0) == 0


@pytest.mark.parametrize("sight", [1.0, 3.5, 6.0, 30.0])
def test_what_lies_ahead_is_as_long_as_sight_and_on_the_way(sight: float) -> None:
    ahead = way_ahead(WAY, 0, 0.2, 1.0, sight)
    assert ahead.seen[0].tolist() == [0.2, 1.0]
    assert ahead.walked[0].tolist() == list(WAY[0])
    length = float(np.hypot(*np.diff(ahead.walked, axis=0).T).sum())
    whole = sum(math.dist(a, b) for a, b in itertools.pairwise(WAY))
    assert length == pytest.approx(min(1.0 + sight, whole))
    assert ahead.ends == (1.0 + sight > whole)
    np.testing.assert_allclose(ahead.seen[-1], ahead.walked[-1])


def test_a_path_along_a_way_goes_on_as_it_was_round_the_corner_and_stands_at_the_end() -> None:
    """Planned again from any of its states, it is the same to the end of the first one."""
    planner, state = RootPlanner(Humanoid.default(), Scene.load("empty")), RootState()
    command, apart, walked = Command(forward=1.0, direction=0.0, way=WAY), 0.0, []
    before = planner.plan(Asked(state, command, 18, INTERVAL)).path.states
    for number in range(1, 90):
        state = RootState(*before[1].tolist())
        plan = planner.plan(Asked(state, command, 18, INTERVAL, number * INTERVAL))
        apart = max(apart, float(np.abs(plan.path.states[:-1] - before[1:]).max()))
        assert plan.lost < planner.settings.untroubled
        before = plan.path.states
        walked.append((state.x, state.z))
    assert apart < 1e-9
    assert math.dist(walked[-1], WAY[-1]) < 0.05
    assert math.hypot(state.forward, state.lateral) < 0.1
    corner = min(math.dist(place, WAY[1]) for place in walked)
    assert corner < 0.4


def aslant() -> Scene:
    """A passage of 0.46 m between the corners of two blocks, aslant, as a door in a corner of a house has it."""
    blocks = [((-2.0, 0.0), (-6.0, -0.3)), ((0.46, 3.0), (0.15, 4.0))]  # from where to where along x and z
    obstacles = [
        {"type": "box", "center": [0.5 * (a + b), 1.1, 0.5 * (c + d)], "size": [b - a, 2.2, d - c], "yaw": 0.0}
        for (a, b), (c, d) in blocks
    ]
    return Scene.from_dict({**Scene.load("empty").to_dict(), "obstacles": obstacles})


THROUGH = ((-1.3, 0.0), (-0.1, 0.0), (0.26, -0.18), (0.74, -0.72), (1.5, -0.66))


def test_who_would_meet_a_corner_by_cutting_it_keeps_closer_to_the_way() -> None:
    start = RootState(-0.48, 0.01, 0.5 * math.pi, 0.66)
    plan = RootPlanner(Humanoid.default(), aslant()).plan(Asked(start, Command(forward=1.0, way=THROUGH), 16, INTERVAL))
    assert plan.kind is RootPlanKind.STRAIGHT
    assert plan.path.states[-1, 0] > 1.0


def test_a_path_that_is_made_longer_goes_on_as_it_was() -> None:
    """Asked for anew, it would keep closer to the way from its first step on, for what has come into view."""
    planner, command = RootPlanner(Humanoid.default(), aslant()), Command(forward=1.0, way=THROUGH)
    start = RootState(-0.76, 0.0, 0.5 * math.pi, 0.66)
    before = planner.plan(Asked(start, command, 3, INTERVAL))
    state, left = RootState(*before.path.states[1].tolist()), RootPath(INTERVAL, INTERVAL, before.path.states[1:])
    anew = planner.plan(Asked(state, command, 16, INTERVAL, INTERVAL))
    longer = planner.prolonged(left, Asked(state, command, 16, INTERVAL, left.start_time))
    assert longer.path.horizon == 16
    assert longer.path.start_time == INTERVAL
    assert np.array_equal(longer.path.states[:3], left.states)
    assert not np.allclose(anew.path.states[:3], left.states, atol=1e-3)
    on = planner.plan(Asked(RootState(*left.states[-1].tolist()), command, 14, INTERVAL, 3 * INTERVAL))
    assert np.array_equal(longer.path.states[2:], on.path.states)


def test_a_slower_walk_along_a_way_loses_what_it_is_slower_by() -> None:
    """Else it would be taken for the path as commanded, and be searched for anew at every key frame."""
    planner, command = (
        RootPlanner(Humanoid.default(), Scene.load("empty")),
        Command(forward=1.0, direction=0.0, way=WAY),
    )
    start = RootState(forward=1.1)
    lost = [planner.plan(Asked(start, command, 16, INTERVAL), pace=pace).lost for pace in (1.0, 0.6, 0.35)]
    assert lost == pytest.approx([0.0, 0.4 * 16 * INTERVAL, 0.65 * 16 * INTERVAL], abs=0.01)
