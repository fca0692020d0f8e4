"""Two who are shown at once and each do as they like within the room that they leave do not meet."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.control.others.neighbour import Neighbour, Walker
from elbowroom.control.others.room_left import leaves_room
from elbowroom.world.obstacles.tracks.moving import Moving

Floats = NDArray[np.float64]

NOW = 1 / 60
RADII = np.array([0.1, 0.05])


def body(rng: np.random.Generator, place: Floats) -> Floats:
    """A trunk and an arm that hangs from it somehow, (2, 6)."""
    shoulder = place + np.array([0.0, 1.4, 0.0])
    hand = shoulder + rng.uniform([-0.3, -0.5, -0.3], [0.3, 0.0, 0.3])
    return np.array([[*place, *shoulder], [*shoulder, *hand]])


def told(was: Floats, said: Floats) -> Neighbour:
    walker = Walker(was[0, [0, 2]], np.zeros(2))
    return Neighbour(walker, Moving(), np.array([0.0, NOW]), np.array([was, said]), RADII)


def moved(rng: np.random.Generator, axes: Floats, most: float) -> Floats:
    """A body a little aside, and its hand a little more."""
    out = axes + np.tile(rng.uniform(-most, most, 3) * [1.0, 0.0, 1.0], 2)
    out[1, 3:] += rng.uniform(-most, most, 3)
    return out


def gap(one: Floats, other: Floats) -> float:
    """Metres between two bodies: from points along their axes."""
    shares = np.linspace(0.0, 1.0, 24)[:, None, None]
    points = [axes[:, :3] + shares * (axes[:, 3:] - axes[:, :3]) for axes in (one, other)]
    away = np.linalg.norm(points[0][:, None, :, None] - points[1][None, :, None], axis=-1)
    return float((away - RADII[:, None] - RADII).min())


def pairs(seed: int, count: int) -> list[tuple[bool, bool, float, float]]:
    """Who may show what it tries, the gap then, and the gap if only the first shows it, of two who stand close by."""
    rng, found = np.random.default_rng(seed), []
    for _ in range(count):
        was = [body(rng, np.zeros(3)), body(rng, np.array([rng.uniform(0.2, 0.5), 0.0, 0.0]))]
        if gap(*was) < 0.0:
            continue
        said = [moved(rng, axes, 0.06) for axes in was]
        tried = [moved(rng, (was, said)[rng.integers(2)][k], rng.choice([0.0, 0.02, 0.1])) for k in range(2)]
        known = [told(a, b) for a, b in zip(was, said, strict=True)]
        first = leaves_room(known[0], known[1], was[0], tried[0], NOW)
        second = leaves_room(known[1], known[0], was[1], tried[1], NOW)
        found.append((first, second, gap(*tried), gap(tried[0], was[1])))
    return found


@pytest.mark.parametrize("seed", range(3))
def test_what_both_may_show_does_not_touch(seed: int) -> None:
    found = pairs(seed, 400)
    both = [gap for first, second, gap, _ in found if first and second]
    assert min(both) > -1e-5  # the judge samples, and finds rather more
    assert len(both) > 60
    assert sum(gap < 0.0 for *_, gap, _ in found) > 10  # what they tried would have touched now and then


def test_who_stays_is_not_touched_by_whoever_does_something() -> None:
    found = [row for seed in range(3) for row in pairs(seed, 150)]
    assert min(stays for first, _, _, stays in found if first) > -1e-5


def test_who_keeps_its_word_may_go_as_far_as_it_said() -> None:
    rng = np.random.default_rng(5)
    for _ in range(50):
        was, other = body(rng, np.zeros(3)), body(rng, np.array([0.6, 0.0, 0.0]))
        said = moved(rng, was, 0.03)
        if gap(was, other) < 0.05 or gap(said, other) < 0.05:
            continue
        assert leaves_room(told(was, said), told(other, other), was, said, NOW)
