"""Ways to a place: against a slow twin on random grids, and in rooms where the answer is known."""

import heapq
import math
from collections.abc import Mapping
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.errors import InputError
from elbowroom.planning.navigation.cost_field import CostField, Costly, MetrePrices, aim_from, field_to
from elbowroom.planning.navigation.girth import girth_of
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.room_map import ground_of, room_map
from elbowroom.planning.navigation.surfaces import one_plane
from elbowroom.planning.navigation.way import NoWayError
from elbowroom.world.scene import Scene

CELL, FAR = 0.1, 1e9
PRICES = MetrePrices(0.2)
STEPS = [(a, b) for a in (-2, -1, 0, 1, 2) for b in (-2, -1, 0, 1, 2) if math.gcd(a, b) == 1]


def random_grid(seed: int) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(1, 14, 2))
    room = rng.uniform(0.0, 0.6, shape) * (rng.random(shape) > rng.uniform(0.0, 0.5))
    return room.astype(np.float32), rng.uniform(0.0, 0.6, shape).astype(np.float32)


def naive_price(room: NDArray[np.float32], above: NDArray[np.float32], i: int, j: int) -> float:
    if room[i, j] < PRICES.slim:
        return math.inf
    narrow = min(max((PRICES.roomy - room[i, j]) / (PRICES.roomy - PRICES.slim), 0.0), 1.0)
    return float(1.0 + PRICES.tight * narrow**2 + PRICES.ducked * (above[i, j] < PRICES.headroom))


def naive_costs(room: NDArray[np.float32], above: NDArray[np.float32], goal: tuple[int, int]) -> NDArray[np.float64]:
    """Dijkstra with the library's heap; between the two ends of a long step lie the points that it passes."""
    cost, heap = np.full(room.shape, math.inf), [(0.0, goal)]
    price = np.array([[naive_price(room, above, i, j) for j in range(room.shape[1])] for i in range(room.shape[0])])
    cost[goal] = 0.0
    while heap:
        reached, (i, j) = heapq.heappop(heap)
        if reached > cost[i, j]:
            continue
        for a, b in STEPS:
            if not (0 <= i + a < room.shape[0] and 0 <= j + b < room.shape[1]):
                continue
            metre = 0.5 * (price[i, j] + price[i + a, j + b])
            if 2 in (abs(a), abs(b)):
                long, short = (1, 0) if abs(a) == 2 else (0, 1)
                half = np.array([a, b]) * (np.array([long, short])) // 2
                for passed in (half, np.array([a, b]) - half):
                    metre = max(metre, price[i + passed[0], j + passed[1]])
            total = reached + metre * CELL * math.hypot(a, b)
            if total < cost[i + a, j + b]:
                cost[i + a, j + b] = total
                heapq.heappush(heap, (total, (i + a, j + b)))
    return cost


def costly_of(room: NDArray[np.float32], above: NDArray[np.float32]) -> Costly:
    rows, columns = room.shape
    return Costly(
        one_plane((rows, columns), CELL),
        room.reshape(-1),
        above.reshape(-1),
        np.zeros(rows * columns, np.float32),
        PRICES,
    )


def field_of(room: NDArray[np.float32], above: NDArray[np.float32], goal: tuple[int, int]) -> CostField:
    """The field of a plane, in rows and columns."""
    found = field_to(costly_of(room, above), goal[0] * room.shape[1] + goal[1], -1, FAR)
    return CostField(found.cost.reshape(room.shape), found.onward.reshape(room.shape))


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**31))
def test_costs_are_those_of_the_slow_twin(seed: int) -> None:
    room, above = random_grid(seed)
    goal = tuple(np.random.default_rng(seed + 1).integers(0, room.shape))
    expected = naive_costs(room, above, goal)
    found = field_of(room, above, goal)
    reached = np.isfinite(expected)
    assert np.array_equal(reached, np.isfinite(found.cost))
    assert np.allclose(found.cost[reached], expected[reached], atol=1e-6)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**31))
def test_going_on_leads_to_the_goal_through_free_points_and_costs_ever_less(seed: int) -> None:
    room, above = random_grid(seed)
    goal = tuple(np.random.default_rng(seed + 1).integers(0, room.shape))
    field = field_of(room, above, goal)
    for start in np.argwhere(np.isfinite(field.cost) & (room >= PRICES.slim)):
        at, last = (int(start[0]), int(start[1])), math.inf
        while field.onward[at] >= 0:
            assert room[at] >= PRICES.slim
            assert field.cost[at] < last
            last, at = field.cost[at], divmod(int(field.onward[at]), room.shape[1])
        assert at == goal


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**31))
def test_who_walks_straight_to_the_aim_walks_where_there_is_room(seed: int) -> None:
    room, above = random_grid(seed)
    goal = tuple(np.random.default_rng(seed + 1).integers(0, room.shape))
    field = field_of(room, above, goal)
    for i, j in np.argwhere(np.isfinite(field.cost)):
        flat = CostField(field.cost.reshape(-1), field.onward.reshape(-1))
        aim = aim_from(flat, costly_of(room, above), i * room.shape[1] + j, float(i), float(j), FAR)
        to = np.array(divmod(aim, room.shape[1]))
        steps = max(int(np.ceil(np.hypot(*(to - (i, j))))), 1)
        line = np.rint(np.linspace((i, j), to, steps + 1)[1:]).astype(int)
        if aim != i * room.shape[1] + j:
            assert (room[line[:, 0], line[:, 1]] >= PRICES.slim).all()


def test_a_search_that_ends_at_the_start_knows_its_cost_exactly() -> None:
    room, above = np.full((40, 40), 0.6, np.float32), np.full((40, 40), 0.6, np.float32)
    room[20, :35] = 0.0
    whole = field_of(room, above, (5, 5))
    start = 30 * 40 + 5
    near = field_to(costly_of(room, above), 5 * 40 + 5, start, 0.3)
    assert near.cost[start] == pytest.approx(whole.cost[30, 5])
    assert np.isfinite(near.cost).sum() < np.isfinite(whole.cost).sum()


# --- in scenes -------------------------------------------------------------------------------------------------------


def wall(x: float, width: float, z: float = 2.0, height: float = 2.4) -> dict[str, object]:
    return {"type": "box", "center": [x, 0.5 * height, z], "size": [width, height, 0.2]}


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return Humanoid.default()


def navigator_among(humanoid: Humanoid, *obstacles: Mapping[str, object]) -> Navigator:
    return Navigator(humanoid, Scene.of("walls", obstacles, finish=(0.0, 4.0)))


def test_the_stock_avatar_takes_forty_centimetres(humanoid: Humanoid) -> None:
    girth = girth_of(humanoid)
    assert 0.17 < girth.slim < 0.21
    assert 1.06 < girth.stooped < 1.1 < girth.tall < 1.8


def test_the_map_says_how_far_away_a_wall_is(humanoid: Humanoid) -> None:
    scene = Scene.of("wall", [wall(0.0, 2.0)], finish=(0.0, 4.0))
    room = room_map(scene, girth_of(humanoid), ground_of(scene))
    places = np.array([[0.0, 1.5], [0.0, 1.8], [0.0, 2.0], [3.0, 2.0]])
    found = [float(room.room[room.next_to(x, z, 0.0) or 0]) for x, z in places]
    assert found == pytest.approx([0.4, 0.1, 0.0, 0.6], abs=room.cell)


def test_the_wider_of_two_doors_is_taken_where_both_are_as_near(humanoid: Humanoid) -> None:
    doors = [wall(-3.9, 4.0), wall(0.0, 2.9), wall(3.95, 4.1)]  # 0.45 m at the left of the picture, 0.45 at the right
    doors[0]["center"] = [-4.1, 1.2, 2.0]  # now 0.65 m
    way = navigator_among(humanoid, *doors).find((0.0, 0.0), (0.0, 4.0))
    crossing = way.corners((0.0, 0.0))
    assert crossing[:, 0].min() < -1.0
    assert crossing[:, 0].max() < 0.5


def test_a_slit_is_no_way(humanoid: Humanoid) -> None:
    navigator = navigator_among(humanoid, wall(-5.15, 10.0), wall(5.15, 10.0))
    with pytest.raises(NoWayError, match=r"no way leads from 0\.00, 0\.00 to 0\.00, 4\.00"):
        navigator.find((0.0, 0.0), (0.0, 4.0))
    way = navigator_among(humanoid, wall(-5.25, 10.0), wall(5.25, 10.0)).find((0.0, 0.0), (0.0, 4.0))
    assert way.left((0.0, 0.0)) > 4.0


def test_under_a_beam_one_goes_stooped_or_not_at_all(humanoid: Humanoid) -> None:
    beam: dict[str, object] = {"type": "box", "center": [0.0, 1.9, 2.0], "size": [20.0, 1.0, 0.2]}
    low: dict[str, object] = {**beam, "center": [0.0, 1.5, 2.0]}
    straight = navigator_among(humanoid).find((0.0, 0.0), (0.0, 4.0)).left((0.0, 0.0))
    ducked = navigator_among(humanoid, beam).find((0.0, 0.0), (0.0, 4.0)).left((0.0, 0.0))
    assert ducked > straight + 0.3
    with pytest.raises(NoWayError):
        navigator_among(humanoid, low).find((0.0, 0.0), (0.0, 4.0))


def test_who_asks_for_the_inside_of_a_box_is_told_the_nearest_place(humanoid: Humanoid) -> None:
    box: dict[str, object] = {"type": "box", "center": [0.0, 0.5, 2.0], "size": [1.0, 1.0, 1.0]}
    navigator = navigator_among(humanoid, box)
    with pytest.raises(NoWayError, match=r"nobody can stand at 0\.40, 2\.00: .* nearest place") as told:
        navigator.find((0.0, 0.0), (0.4, 2.0))
    nearest = told.value.nearest
    assert nearest is not None
    assert nearest == pytest.approx((0.7, 0.0, 2.0), abs=0.07)
    assert navigator.find((0.0, 0.0), nearest).left(nearest) == pytest.approx(0.0)


def test_places_off_the_ground_and_no_places_are_refused(humanoid: Humanoid) -> None:
    navigator = navigator_among(humanoid)
    with pytest.raises(NoWayError, match="lies off the ground"):
        navigator.find((0.0, 0.0), (0.0, 400.0))
    with pytest.raises(InputError, match="is no place"):
        navigator.find((0.0, 0.0), (math.nan, 0.0))


def test_what_is_closed_is_gone_round(humanoid: Humanoid) -> None:
    navigator = navigator_among(humanoid)
    start, goal = (0.0, 0.0), (0.0, 4.0)
    way = navigator.again(navigator.find(start, goal), start, [((0.0, 2.0), 0.5)])
    line = way.corners(start)
    points = np.concatenate([np.linspace(a, b, 50) for a, b in pairwise(line)])
    assert np.hypot(*(points[:, [0, 2]] - (0.0, 2.0)).T).min() > 0.5 + way.prices.slim - way.room.cell


def test_who_stands_hard_by_a_wall_is_led_away_from_it(humanoid: Humanoid) -> None:
    way = navigator_among(humanoid, wall(0.0, 3.0)).find((0.0, 1.75), (0.0, 4.0))
    aim = way.aim((0.0, 1.75), 3.0)
    assert aim is not None
    assert aim[2] < 1.75 + way.room.cell
