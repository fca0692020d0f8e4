"""Finds ways in one scene for one avatar; what it remembers is what it would make again."""

import math
from collections.abc import Sequence
from threading import Lock

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.errors import InputError
from elbowroom.planning.navigation.field import Prices
from elbowroom.planning.navigation.girth import girth_of
from elbowroom.planning.navigation.room_map import Rectangle, RoomMap, ground_of, room_map
from elbowroom.planning.navigation.way import NoWayError, Place, Way, reachable_over, said, way_over
from elbowroom.world.scene import Scene

_MARGINS = (4.0, 16.0, math.inf)  # metres around start and goal that are looked at, one after the other


class Navigator:
    """Threads may share it."""

    def __init__(self, humanoid: Humanoid, scene: Scene) -> None:
        self._scene, self._girth, self._ground = scene, girth_of(humanoid), ground_of(scene)
        self._prices = Prices(self._girth.slim)
        self._known: RoomMap | None = None
        self._lock = Lock()

    def find(self, start: Place, goal: Place, closed: Sequence[tuple[Place, float]] = ()) -> Way:
        """The way from one place to another, around discs (middle, radius) that are taken to be closed.

        Raises `InputError` where the goal is no place on the ground, `NoWayError` where there is no way.
        """
        if not all(map(math.isfinite, goal)):
            raise InputError(f"goto: {goal[0]}, {goal[1]} is no place")
        ground = self._ground
        if not ground.holds(Rectangle(*goal, *goal)):
            x, z = min(max(goal[0], ground.low_x), ground.high_x), min(max(goal[1], ground.low_z), ground.high_z)
            raise NoWayError(f"{said(goal)} lies off the ground, which ends at {said((x, z))}")
        both = Rectangle(min(start[0], goal[0]), min(start[1], goal[1]), max(start[0], goal[0]), max(start[1], goal[1]))
        for margin in _MARGINS:
            area = both.around(margin, ground)
            try:
                return way_over(self._map_of(area), self._prices, start, goal, closed)
            except NoWayError:
                if area.holds(ground):
                    raise
        raise NoWayError(f"no way leads from {said(start)} to {said(goal)}")

    def room(self) -> RoomMap:
        """The room over the whole ground."""
        return self._map_of(self._ground)

    def reachable(self, start: Place) -> NDArray[np.bool_]:
        """The points of the map of the whole ground (nz, nx) that a way leads to from a place."""
        return reachable_over(self.room(), self._prices, start)

    @property
    def prices(self) -> Prices:
        """What ways cost."""
        return self._prices

    def _map_of(self, area: Rectangle) -> RoomMap:
        """The map that holds an area."""
        with self._lock:
            if self._known is None or not self._known.area.holds(area):
                self._known = room_map(self._scene, self._girth, area)
            return self._known
