"""Two who walk towards each other where there is little room: each keeps to its half, nobody is driven back."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.control.others.neighbour import Neighbour, Walker
from elbowroom.control.others.passing import expected, way_made
from elbowroom.experiment.meeting.meeting import Start, corridor, drawn, meet
from elbowroom.experiment.meeting.settings import WIDTHS, MeetingKind
from elbowroom.world.obstacles.tracks.moving import Moving

Floats = NDArray[np.float64]

BODY = np.array([[-0.2, 0.0, 0.0, 0.2, 1.7, 0.0, 0.05]])  # one capsule as broad as shoulders


@pytest.mark.long
@pytest.mark.parametrize(
    ("width", "left"),
    [
        (0.95, (0.121, 0.02)),
        (0.95, (0.0, 0.0)),
        (1.2, (0.0, 0.0)),
        (1.4, (0.02, 0.0)),
    ],
)
def test_two_who_meet_head_on_share_the_way(width: float, left: tuple[float, float]) -> None:
    assert meet(Start(width, left, 5.0, (1.0, 1.0))).well


@pytest.mark.long
@pytest.mark.parametrize("width", [0.95, 1.0, 1.6])
def test_who_stands_is_passed_and_not_driven_back(width: float) -> None:
    assert meet(Start(width, (0.0, 0.0), 5.0, (1.0, 0.0))).well


@pytest.mark.long
@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("kind", list(MeetingKind))
def test_wherever_two_meet_they_share_the_way(width: float, kind: MeetingKind) -> None:
    assert [met.start for seed in range(20) if not (met := meet(drawn(width, kind, seed))).well] == []


@pytest.mark.long
def test_who_stand_in_each_others_way_do_not_touch() -> None:
    """There is no room for two: both are at a loss, and then each shows something else than it said."""
    met = meet(drawn(0.86, MeetingKind.WALKS, 3))
    assert not met.passed
    assert not met.touched


def seen(x: float, z: float, wanted: tuple[float, float]) -> Neighbour:
    """Somebody at a place who wants to go somewhere."""
    walker = Walker(np.array([x, z]), np.array(wanted))
    return Neighbour(walker, Moving(), np.zeros(1), np.zeros((1, 1, 6)), np.zeros(1))


def test_both_find_the_same_halves() -> None:
    """The line between them is the same, less what both keep; it begins ahead of who has to step aside first."""
    rng = np.random.default_rng(2)
    for _ in range(40):
        width = float(rng.uniform(0.95, 3.0))
        free_map, room = corridor(width).obstacles.free_map, 0.5 * width - 0.3
        x, there = rng.uniform(-room, room, 2).tolist()
        gap = float(rng.uniform(2.0, 6.0))
        ahead, back = (0.0, 1.0), (0.0, -1.0)
        mine = expected(Walker(np.array([x, 0.0]), np.array(ahead)), BODY, (seen(there, gap, back),), free_map)
        yours = expected(Walker(np.array([there, gap]), np.array(back)), BODY, (seen(x, 0.0, ahead),), free_map)
        (centers, _), (others, _) = mine.poses(0.0), yours.poses(0.0)
        theirs, own = centers[0, 0], others[0, 0]
        half, other = mine.half_sizes[0], yours.half_sizes[0]
        assert abs(theirs[0] - own[0]) - half[0] - other[0] == pytest.approx(-0.02, abs=1e-6)
        if not any(stands_over(place, box, size) for place, box, size in ((x, theirs, half), (there, own, other))):
            assert abs(theirs[2] + own[2] - gap) < 0.02
        for ahead_of_one, length in ((theirs[2], half[2]), (gap - own[2], other[2])):
            assert 0.0 < ahead_of_one - length <= 0.5 * gap
            assert ahead_of_one + length > 0.5 * gap


def stands_over(place: float, center: Floats, half: Floats) -> bool:
    """Whether shoulders at a place, metres along X, are beside a half: who has to step aside begins to see it later."""
    return bool(abs(place - center[0]) < half[0] + 0.25)


def test_who_does_not_come_is_left_as_told() -> None:
    free_map, own = corridor(1.2).obstacles.free_map, Walker(np.zeros(2), np.array([0.0, 1.0]))
    for other in (seen(0.0, 3.0, (0.0, 1.0)), seen(0.0, 3.0, (0.0, 0.0)), seen(0.0, -3.0, (0.0, -1.0))):
        assert expected(own, BODY, (other,), free_map).tracks == other.boxes.tracks


def test_who_stands_makes_way_only_where_there_is_no_room() -> None:
    own = Walker(np.zeros(2), np.zeros(2))
    comes = (seen(0.0, 2.0, (0.0, -1.0)),)
    assert way_made(own, 0.0, BODY, comes, corridor(2.0).obstacles.free_map).idle
    assert way_made(own, 0.0, BODY, (seen(0.0, 2.0, (0.0, 1.0)),), corridor(1.2).obstacles.free_map).idle
    aside = way_made(own, 0.0, BODY, comes, corridor(1.2).obstacles.free_map)
    assert aside.strafe < -0.5
    assert abs(aside.forward) < 1e-9
    narrow = corridor(1.0).obstacles.free_map
    assert way_made(own, 0.0, BODY, comes, narrow).turn == pytest.approx(0.8)
    assert way_made(own, math.pi / 2, BODY, comes, narrow).forward < -0.5
    hard_by = way_made(own._replace(place=np.array([-0.27, 0.0])), 0.0, BODY, comes, narrow)
    assert hard_by.strafe > 0.5
    assert abs(hard_by.turn) < 1e-9
    turned = way_made(own, math.pi / 2, BODY, comes, corridor(1.2).obstacles.free_map)
    assert turned.forward < -0.5
    nearer = way_made(own._replace(place=np.array([0.2, 0.0])), 0.0, BODY, comes, corridor(1.2).obstacles.free_map)
    assert nearer.strafe > 0.5
