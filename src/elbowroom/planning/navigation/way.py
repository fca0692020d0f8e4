"""The way to a place on the floor, or the reason why there is none."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError, in_a_line
from elbowroom.planning.navigation.cost_field import CostField, Costly, MetrePrices, aim_from, field_to, straight_cost
from elbowroom.planning.navigation.room_map import RoomMap

Floats = NDArray[np.float64]
Place = tuple[float, float, float]  # x, height, z, metres
Spot = tuple[float, float]  # x, z, metres

_BESIDE = 0.6  # metres: who stands where a map has no room looks so far for the way
_DEARER = 0.3  # metres by which the straight line may be dearer than the way that was found
_NOBODY = -1  # a start that no point is: costs to all points
_BEYOND = 4.0  # metres off the way to which costs are known
_FARTHEST = 1e6  # metres from the middle of a scene: no number beyond is meant
_LOW = 0.05  # metres: a height that is not told
_FLOOR, _HIGHER = 0.5, 4.0  # metres up and down that are the same floor; how many metres aside count as one beyond that
_SAME = 1e-6  # metres: places nearer to each other are one


class NoWayError(InputError):
    """There is no way to a place; `nearest` is a place near it where one can stand, if there is one."""

    def __init__(self, why: str, nearest: Place | None = None) -> None:
        super().__init__(why if nearest is None else f"{why}; the nearest place to stand is {said(nearest)}")
        self.nearest = nearest  # where one can stand near it: x, height, z


def said(place: Place) -> str:
    """A place in words: x and z, and between them its height where that is not nearly 0."""
    x, height, z = place
    return f"{x:.2f}, {z:.2f}" if abs(height) < _LOW else f"{x:.2f}, {height:.2f}, {z:.2f}"


def checked(place: Place | Spot) -> Place | Spot:
    """A place that a program asks for; raises `InputError` where it is none."""
    try:
        numbers = tuple(map(float, place))
    except (TypeError, ValueError, OverflowError):
        numbers = ()
    if len(numbers) not in (2, 3) or not all(abs(number) <= _FARTHEST for number in numbers):
        raise InputError(f"goto: {in_a_line(place)} is no place: it is (x, z) or (x, height, z) in metres")
    return place


def placed(place: Place | Spot, height: float = 0.0) -> Place:
    """A place with its height, or with the one that is given."""
    return float(place[0]), float(place[1]) if len(place) == 3 else height, float(place[-1])


def meant(room: RoomMap, place: Place | Spot, height: float) -> list[Place]:
    """What a place may mean: itself; without a height there at this one, or on another floor, the nearest first."""
    first = placed(place, height)
    if len(place) == 3:
        return [first]
    others = [other for other in room.heights_at(first[0], first[2]) if abs(other - height) > _FLOOR]
    return [first, *(placed(place, other) for other in sorted(others, key=lambda other: abs(other - height)))]


def apart(one: Place, other: Place) -> float:
    """Metres from one place to another over the floor: heights count where they are on different floors."""
    above = max(abs(one[1] - other[1]) - _FLOOR, 0.0)
    return math.hypot(one[0] - other[0], one[2] - other[2], _HIGHER * above)


@dataclass(frozen=True, eq=False)
class Way:
    """What is known of the way to a place."""

    goal: Place
    room: RoomMap
    prices: MetrePrices
    field: CostField
    climbs: bool = False  # over what is too high for a step

    def left(self, place: Place | Spot) -> float:
        """Metres that are still to walk from a place, more where it is narrow; infinite where no way is known."""
        at = self._on_the_way(placed(place))
        return math.inf if at is None else float(self.field.cost[at])

    def aim(self, place: Place | Spot, far: float) -> Place | None:
        """Where to walk straight to from a place: at most `far` metres along the way; None where none is known."""
        x, height, z = placed(place)
        at = self._on_the_way((x, height, z))
        if at is None:
            return None
        if self.room.next_to(x, z, height) != at:
            return self.room.place(at)  # back to where there is room
        found = aim_from(self.field, self._costly, at, *self.room.in_grid(x, z), far)
        return self.goal if self.field.onward[found] < 0 else self.room.place(found)

    def sees(self, place: Place, aim: Place) -> bool:
        """Whether the straight line from a place to another is still about as good as the way."""
        (x, height, z), end = place, self.room.next_to(aim[0], aim[2], aim[1])
        if end is None:
            return False
        cost = straight_cost(self._costly, self.room.in_grid(x, z), height, end)
        return cost + self.left(aim) <= self.left(place) + _DEARER

    def corners(self, start: Place | Spot, far: float = 3.0) -> Floats:
        """The places (m, 3) at which the way from a start turns, both ends included."""
        places, after = [placed(start)], self.aim(start, far)
        while after is not None and apart(after, places[-1]) > _SAME:
            places.append(after)
            after = self.aim(after, far)
        return np.array(places)

    def onward(self, start: Place | Spot) -> NDArray[np.int64]:
        """The numbers (N,) of the places on the way from a start to the goal; none where no way is known."""
        at, found = self._on_the_way(placed(start)), list[int]()
        while at is not None and at >= 0:
            found.append(at)
            at = int(self.field.onward[at])
        return np.array(found, np.int64)

    def until(self, node: int) -> "Way":
        """The same way as far as one of its places."""
        onward = self.field.onward.copy()
        onward[node] = -1
        return replace(self, goal=self.room.place(node), field=self.field._replace(onward=onward))

    @property
    def _costly(self) -> Costly:
        return Costly(self.room.surfaces, self.room.room, self.room.above, self.room.steep, self.prices)

    def _on_the_way(self, place: Place) -> int | None:
        """The place nearest to another from which the way is known, if one is near."""
        x, height, z = place
        at = self.room.next_to(x, z, height)
        if at is not None and np.isfinite(self.field.cost[at]):
            return at
        return nearest_of(self.room, np.isfinite(self.field.cost), place, _BESIDE)


def way_over(
    room: RoomMap, prices: MetrePrices, start: Place, goal: Place, closed: Sequence[tuple[Spot, float]]
) -> Way:
    """The way over a map from a start to a goal, around discs that are closed (middle, radius).

    Raises `NoWayError` where one of them is no place to stand, or nothing leads from one to the other.
    """
    room = replace(room, room=_without(room, closed)) if closed else room
    free = room.room >= prices.slim
    last = nearest_of(room, free, goal, room.cell)
    if last is None:
        near = nearest_of(room, free, goal)
        why = f"nobody can stand at {said(goal)}: {2.0 * prices.slim:.2f} m of room are needed there"
        raise NoWayError(why, None if near is None else room.place(near))
    begin = nearest_of(room, free, start, _BESIDE)
    if begin is None:
        raise NoWayError(f"there is no way out of {said(start)}: there is less than {2.0 * prices.slim:.2f} m of room")
    costly = Costly(room.surfaces, room.room, room.above, room.steep, prices)
    field = field_to(costly, last, begin, _BEYOND)
    if not np.isfinite(field.cost[begin]):
        raise NoWayError(f"no way leads from {said(start)} to {said(goal)}")
    return Way((goal[0], room.place(last)[1], goal[2]), room, prices, field)


def reachable_over(room: RoomMap, prices: MetrePrices, start: Place) -> NDArray[np.bool_]:
    """The places of a map (N,) that a way leads to from a place; none where nothing leads away from it."""
    free = room.room >= prices.slim
    begin = nearest_of(room, free, start, _BESIDE)
    if begin is None:
        return np.zeros_like(free)
    costly = Costly(room.surfaces, room.room, room.above, room.steep, prices)
    return np.isfinite(field_to(costly, begin, _NOBODY, _BEYOND).cost)


def nearest_of(room: RoomMap, wanted: NDArray[np.bool_], place: Place, most: float = math.inf) -> int | None:
    """The wanted one (N,) of the places that is nearest to another, at most so many metres away; heights count more."""
    x, height, z = place
    at = room.next_to(x, z, height)
    if at is not None and wanted[at] and abs(float(room.surfaces.heights[at]) - height) <= _FLOOR:
        return at
    found = np.flatnonzero(wanted)
    if not len(found):
        return None
    rows, columns = np.divmod(room.surfaces.points[found], room.surfaces.columns)
    i, j = (round(each) for each in room.in_grid(x, z))
    above = np.maximum(np.abs(room.surfaces.heights[found] - height) - _FLOOR, 0.0)
    away = np.hypot(room.cell * np.hypot(rows - i, columns - j), _HIGHER * above)
    best = int(np.argmin(away))
    return int(found[best]) if away[best] <= most else None


def _without(room: RoomMap, closed: Sequence[tuple[Spot, float]]) -> NDArray[np.float32]:
    """The room of a map where discs are closed too, on all floors."""
    places, left = room.places, room.room.copy()
    for (middle_x, middle_z), radius in closed:
        away = np.hypot(places[:, 0] - middle_x, places[:, 2] - middle_z) - radius
        left = np.minimum(left, np.maximum(away, 0.0).astype(np.float32))
    return left
