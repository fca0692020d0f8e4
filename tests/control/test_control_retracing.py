"""Who stays in mid-stride and comes to no stand goes back the way he came, pose by pose."""

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL
from elbowroom.body.gait.foot_state import SWING
from elbowroom.body.root import RISES, ROOT_STATE, SHOWN
from elbowroom.control.key_frame_queue import Playback
from elbowroom.control.shown.retracing import Past, Retracing

DT = 1 / 60
UPPER = np.zeros(LOCAL)


def pose(along: float, speed: float = 0.5) -> Playback:
    root: NDArray[np.float64] = np.zeros(SHOWN)
    root[1], root[3] = along, speed
    return Playback(root, UPPER, UPPER)


def walked(count: int, speed: float = 0.5) -> tuple[Retracing, list[Playback]]:
    """So many frames of an even walk."""
    retracing, poses = Retracing(), [pose(speed * DT * k, speed) for k in range(count)]
    for before, shown in pairwise(poses):
        retracing.show(Past(before, DT), shown)
    return retracing, poses


def stayed(retracing: Retracing, last: Playback, seconds: float) -> None:
    for _ in range(round(seconds / DT)):
        retracing.show(Past(last, DT), last)


def gone_back(retracing: Retracing, dt: float = DT) -> list[Playback]:
    found = []
    while retracing.goes_back:
        if (before := retracing.before(dt)) is not None:
            retracing.went()
            found.append(before.pose)
    return found


def test_who_walks_or_has_come_to_a_stand_stays_or_goes_on() -> None:
    retracing, poses = walked(200)
    assert not retracing.goes_back
    stayed(retracing, poses[-1], 0.4)
    assert not retracing.goes_back, "legs are still given time to come to a stand"
    still = pose(float(poses[-1].root[1]), 0.0)
    stayed(retracing, still, 5.0)
    assert not retracing.goes_back


def test_what_is_remembered_is_at_rest() -> None:
    retracing, poses = walked(60)
    swinging = [each._replace(upper_velocity=np.ones(LOCAL)) for each in poses]
    retracing.forget()
    for before, shown in pairwise(swinging):
        retracing.show(Past(before, DT), shown)
    stayed(retracing, swinging[-1], 0.6)
    back = gone_back(retracing)
    assert back
    assert not any(each.upper_velocity.any() for each in back)
    assert len({id(each.upper_velocity) for each in back}) == 1, "nobody keeps a row of zeros for each"


def test_who_trembles_before_a_wall_stands_there() -> None:
    """A step aside that leads no farther: the root's velocity dies away, begins again, and is never quite nothing."""
    retracing, _ = walked(100)
    at_the_wall = pose(0.8, 0.0)
    retracing.show(Past(pose(0.8), DT), at_the_wall)
    for k in range(600):
        trembling = Playback(at_the_wall.root.copy(), UPPER, UPPER)
        trembling.root[[3, 5]] = 0.01 * math.sin(k), 0.005 * math.cos(k)
        retracing.show(Past(at_the_wall, DT), trembling)
        assert not retracing.goes_back


@pytest.mark.parametrize("dt", [DT, 0.5 * DT])
def test_who_stays_in_a_stride_goes_back_as_fast_as_he_came_and_each_time_farther(dt: float) -> None:
    retracing, poses = walked(200)
    stayed(retracing, poses[-1], 0.6)
    first = gone_back(retracing, dt)
    assert all(each.root is before.root for each, before in zip(first, poses[-2::-1], strict=False))
    assert len(first) * DT == pytest.approx(0.4, abs=2 * DT)
    stayed(retracing, first[-1], 0.6)
    assert len(gone_back(retracing, dt)) == pytest.approx(2 * len(first), abs=2)


def dithered(retracing: Retracing, last: Playback, seconds: float) -> Playback:
    """Arms that swing to and fro on the spot, never twice the same way; what is shown last."""
    for k in range(round(seconds / DT)):
        swing = 0.02 * abs((k % 40) - 20) + 1e-3 * math.sin(k)
        dithering = pose(float(last.root[1]), 0.0)._replace(upper=np.full(LOCAL, swing))
        retracing.show(Past(last, DT), dithering)
        last = dithering
    return last


def test_who_dithers_where_he_finds_no_way_still_knows_how_he_came() -> None:
    retracing, poses = walked(200)
    place = float(poses[-1].root[1]) + 0.01
    stands = pose(place, 0.0)
    stands.root[ROOT_STATE + SWING] = 0.2  # what a foot will do next poses nothing
    retracing.show(Past(poses[-1], DT), stands)
    last = dithered(retracing, stands, 12.0)
    for _ in range(60 * 4):
        if not retracing.goes_back:
            retracing.wait(last, DT, on_the_way=True)
    arrival = retracing.arrival(last, DT)
    assert arrival is not None
    assert arrival.pose.root is stands.root
    shown, roots = retracing.go_straight(last, arrival, DT).pose, []
    assert 0.0 < np.abs(shown.upper - last.upper).max() <= 1.5 * DT + 1e-9
    for back in gone_back(retracing):
        assert np.abs(back.upper - shown.upper).max() <= 1.5 * DT + 1e-9
        roots.append(float(back.root[1]))
        shown = back
    assert max(roots) <= place + 1e-9
    assert place - roots[-1] == pytest.approx(0.5 * 0.4, abs=0.03)
    assert len(roots) * DT < 0.4 + float(np.abs(last.upper).max()) / 1.5 + 3 * DT


def test_a_second_on_the_spot_is_remembered_and_where_it_was_cut() -> None:
    retracing, poses = walked(200)
    last = dithered(retracing, poses[-1], 0.2)
    assert retracing.arrival(last, DT) is None
    last = dithered(retracing, last, 12.0)
    for _ in range(60 * 4):
        retracing.wait(last, DT, on_the_way=True)
    joined = []
    while (past := retracing.before(1.0)) is not None and past.pose.root[1] >= poses[-1].root[1]:
        joined.append(past.joined)
        retracing.went()
    assert joined.count(False) == 1, "from the last second on the spot to how he came there"
    assert 58 <= len(joined) <= 62


def test_the_way_back_ends_where_no_more_is_remembered() -> None:
    retracing, poses = walked(30)
    stayed(retracing, poses[-1], 0.6)
    assert len(gone_back(retracing)) * DT == pytest.approx(0.4, abs=2 * DT)
    stayed(retracing, poses[5], 0.6)
    gone_back(retracing)
    retracing.show(Past(poses[0], DT), poses[1])
    assert not retracing.goes_back, "who goes on from there is not called back"


def test_only_so_much_is_remembered_and_what_touched_is_no_way_back() -> None:
    retracing, poses = walked(600)
    for _ in range(9):
        stayed(retracing, poses[-1], 0.6)
        gone_back(retracing)
    stayed(retracing, poses[-1], 0.6)
    assert not retracing.goes_back, "nothing is left"
    retracing, poses = walked(200)
    retracing.forget()
    stayed(retracing, poses[-1], 0.6)
    assert not retracing.goes_back


@pytest.mark.parametrize(("rise", "on_the_way"), [(0.1, False), (0.4, False), (0.0, True)])
def test_who_finds_no_way_from_steep_treads_or_to_a_place_for_long_goes_back_and_before_a_wall_one_stands(
    rise: float, on_the_way: bool
) -> None:
    retracing, poses = walked(200)
    still = pose(float(poses[-1].root[1]), 0.0)
    still.root[RISES] = rise
    retracing.show(Past(poses[-1], DT), still)
    for second in range(4):
        assert not retracing.goes_back or second == 3 or (on_the_way and second == 2)
        for _ in range(60):
            retracing.show(Past(still, DT), still)
            retracing.wait(still, DT, on_the_way=on_the_way)
    assert retracing.goes_back is (rise > 0.25 or on_the_way)
