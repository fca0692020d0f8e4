"""The way to a place on the floor, or the reason why there is none."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.planning.navigation.field import Field, Prices, aim_from, field_to, straight_cost
from elbowroom.planning.navigation.room_map import RoomMap

Floats = NDArray[np.float64]
Place = tuple[float, float]  # x, z, metres

_BESIDE = 0.6  # metres: who stands where a map has no room looks so far for the way
_DEARER = 0.3  # metres by which the straight line may be dearer than the way that was found
_NOBODY = -1  # a start that no point is: costs to all points
_BEYOND = 4.0  # metres off the way to which costs are known
_SAME = 1e-6  # metres: places nearer to each other are one


class NoWayError(InputError):
    """There is no way to a place; `nearest` is a place near it where one can stand, if there is one."""

    def __init__(self, why: str, nearest: Place | None = None) -> None:
        super().__init__(why if nearest is None else f"{why}; the nearest place to stand is {said(nearest)}")
        self.nearest = nearest


def said(place: Place) -> str:
    """A place in words."""
    return f"{place[0]:.2f}, {place[1]:.2f}"


@dataclass(frozen=True, eq=False)
class Way:
    """What is known of the way to a place."""

    goal: Place
    room: RoomMap
    prices: Prices
    field: Field

    def left(self, place: Place) -> float:
        """Metres that are still to walk from a place, more where it is narrow; infinite where no way is known."""
        point = self._on_the_way(place)
        return math.inf if point is None else float(self.field.cost[point])

    def aim(self, place: Place, far: float) -> Place | None:
        """Where to walk straight to from a place: at most `far` metres along the way; None where none is known."""
        point = self._on_the_way(place)
        if point is None:
            return None
        row, column = self._in_grid(place)
        if (round(row), round(column)) != point:
            return self._place(*point)  # back to where there is room
        at = aim_from(self.field, self.room.room, self.room.above, self.room.cell, self.prices, row, column, far)
        found = divmod(at, self.room.room.shape[1])
        return self.goal if self.field.onward[found] < 0 else self._place(*found)

    def sees(self, place: Place, aim: Place) -> bool:
        """Whether the straight line from a place to another is still about as good as the way."""
        row, column = self._in_grid(place)
        end = self.room.points(np.array(aim)).tolist()
        cost = straight_cost(
            self.room.room, self.room.above, self.room.cell, self.prices, (row, column), (end[0], end[1])
        )
        return cost + self.left(aim) <= self.left(place) + _DEARER

    def corners(self, start: Place, far: float = 3.0) -> Floats:
        """The places (m, 2), x and z, at which the way from a start turns, both ends included."""
        places, after = [start], self.aim(start, far)
        while after is not None and math.dist(after, places[-1]) > _SAME:
            places.append(after)
            after = self.aim(after, far)
        return np.array(places)

    def _in_grid(self, place: Place) -> tuple[float, float]:
        """Row and column of a place, and shares of them."""
        area, (rows, columns) = self.room.area, self.room.room.shape
        row, column = (place[1] - area.low_z) / self.room.cell, (place[0] - area.low_x) / self.room.cell
        return min(max(row, 0.0), rows - 1.0), min(max(column, 0.0), columns - 1.0)

    def _on_the_way(self, place: Place) -> tuple[int, int] | None:
        """The point nearest to a place from which the way is known, if one is near."""
        row, column = (round(each) for each in self._in_grid(place))
        if np.isfinite(self.field.cost[row, column]):
            return row, column
        return nearest_of(np.isfinite(self.field.cost), (row, column), _BESIDE / self.room.cell)

    def _place(self, row: int, column: int) -> Place:
        x, z = self.room.places(np.array([row, column])).tolist()
        return x, z


def way_over(room: RoomMap, prices: Prices, start: Place, goal: Place, closed: Sequence[tuple[Place, float]]) -> Way:
    """The way over a map from a start to a goal, around discs that are closed (middle, radius).

    Raises `NoWayError` where one of them is no place to stand, or nothing leads from one to the other.
    """
    room = replace(room, room=_without(room, closed)) if closed else room
    free = room.room >= prices.slim
    first, last = ((int(row), int(column)) for row, column in room.points(np.array([start, goal])))
    if not free[last]:
        near = nearest_of(free, last)
        x_z = None if near is None else room.places(np.array(near)).tolist()
        why = f"nobody can stand at {said(goal)}: {2.0 * prices.slim:.2f} m of room are needed there"
        raise NoWayError(why, None if x_z is None else (x_z[0], x_z[1]))
    begin = first if free[first] else nearest_of(free, first, _BESIDE / room.cell)
    if begin is None:
        raise NoWayError(f"there is no way out of {said(start)}: there is less than {2.0 * prices.slim:.2f} m of room")
    columns = room.room.shape[1]
    at, to = begin[0] * columns + begin[1], last[0] * columns + last[1]
    field = field_to(room.room, room.above, room.cell, prices, to, at, _BEYOND)
    if not np.isfinite(field.cost[begin]):
        raise NoWayError(f"no way leads from {said(start)} to {said(goal)}")
    return Way(goal, room, prices, field)


def reachable_over(room: RoomMap, prices: Prices, start: Place) -> NDArray[np.bool_]:
    """The points of a map (nz, nx) that a way leads to from a place; none where nothing leads away from it."""
    free = room.room >= prices.slim
    row, column = room.points(np.array(start)).tolist()
    begin = (row, column) if free[row, column] else nearest_of(free, (row, column), _BESIDE / room.cell)
    if begin is None:
        return np.zeros_like(free)
    at = begin[0] * room.room.shape[1] + begin[1]
    return np.isfinite(field_to(room.room, room.above, room.cell, prices, at, _NOBODY, _BEYOND).cost)


def nearest_of(wanted: NDArray[np.bool_], point: tuple[int, int], most: float = math.inf) -> tuple[int, int] | None:
    """The wanted point nearest to another, at most so many cells away."""
    found = np.argwhere(wanted)
    if not len(found):
        return None
    away = np.hypot(*(found - point).T)
    best = int(np.argmin(away))
    return (int(found[best, 0]), int(found[best, 1])) if away[best] <= most else None


def _without(room: RoomMap, closed: Sequence[tuple[Place, float]]) -> NDArray[np.float32]:
    """The room of a map where discs are closed too."""
    rows, columns = (np.arange(size) for size in room.room.shape)
    x, z = room.area.low_x + room.cell * columns, room.area.low_z + room.cell * rows
    left = room.room.copy()
    for (middle_x, middle_z), radius in closed:
        away = np.hypot(x[None] - middle_x, z[:, None] - middle_z) - radius
        left = np.minimum(left, np.maximum(away, 0.0).astype(np.float32))
    return left
