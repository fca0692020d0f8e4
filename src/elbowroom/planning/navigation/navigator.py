"""Finds ways in one scene for one avatar; what it remembers is what it would make again."""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from threading import Lock

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.planning.model.highest_step import as_climbed, as_stepped
from elbowroom.planning.navigation.cost_field import MetrePrices
from elbowroom.planning.navigation.girth import girth_of
from elbowroom.planning.navigation.room_map import Rectangle, RoomMap, ground_of, room_map
from elbowroom.planning.navigation.way import (
    NoWayError,
    Place,
    Spot,
    Way,
    checked,
    meant,
    placed,
    reachable_over,
    said,
    way_over,
)
from elbowroom.world.ground.ground import STEP
from elbowroom.world.scene import Scene

_MARGINS = (4.0, 16.0, math.inf)  # metres around start and goal that are looked at, one after the other


class Navigator:
    """Finds ways that are walked; where there is none, ways that lead over what is climbed. Threads may share it."""

    def __init__(self, humanoid: Humanoid, scene: Scene) -> None:
        self._made_of = humanoid, scene
        self._walked = _Finder(humanoid, as_stepped(scene, humanoid))

    @cached_property
    def _climbed(self) -> "_Finder | None":
        humanoid, scene = self._made_of
        climbed = as_climbed(scene, humanoid)
        return None if climbed is None else _Finder(humanoid, climbed)

    def find(self, start: Place | Spot, goal: Place | Spot) -> Way:
        """The way from one place to another.

        A goal without a height is on the floor there that a way leads to, at that of the start if it can be; a start
        without one is at 0. Raises `InputError` where the goal is no place on the ground, `NoWayError` where there is
        no way.
        """
        try:
            return self._walked.find(start, goal)
        except NoWayError:
            if self._climbed is None:
                raise
            try:
                return replace(self._climbed.find(start, goal), climbs=True)
            except NoWayError:
                pass
            raise

    def again(self, way: Way, start: Place | Spot, closed: Sequence[tuple[Spot, float]]) -> Way:
        """The way to where another leads, from elsewhere, around discs (middle, radius) that are taken to be closed.

        It leads over what is climbed if that does. Raises `NoWayError` where there is none.
        """
        finder = self._climbed if way.climbs else self._walked
        assert finder is not None
        return replace(finder.find(start, way.goal, closed), climbs=way.climbs)

    def room(self) -> RoomMap:
        """The room over the whole ground that is walked on."""
        return self._walked.room()

    def reachable(self, start: Place | Spot) -> NDArray[np.bool_]:
        """The places of the map of the whole ground (N,) to which one walks from a place."""
        return reachable_over(self.room(), self.prices, placed(start, 0.0))

    @property
    def prices(self) -> MetrePrices:
        """What ways cost."""
        return self._walked.prices


class _Finder:
    """Finds ways over one ground; threads may share it."""

    def __init__(self, humanoid: Humanoid, scene: Scene) -> None:
        self._scene = scene
        self._girth, self._ground = girth_of(humanoid), ground_of(scene)
        self.prices = MetrePrices(self._girth.slim)  # what ways cost
        self._known: RoomMap | None = None
        self._lock = Lock()

    def find(self, start: Place | Spot, goal: Place | Spot, closed: Sequence[tuple[Spot, float]] = ()) -> Way:
        """The way from one place to another, around closed discs; raises as `Navigator.find` and `again` do."""
        begin = placed(start, 0.0)
        end = placed(checked(goal), begin[1])
        ground, (x, _, z) = self._ground, end
        if not ground.holds(Rectangle(x, z, x, z)):
            edge = min(max(x, ground.low_x), ground.high_x), end[1], min(max(z, ground.low_z), ground.high_z)
            raise NoWayError(f"{said(end)} lies off the ground, which ends at {said(edge)}")
        both = Rectangle(min(begin[0], x), min(begin[2], z), max(begin[0], x), max(begin[2], z))
        for margin in _MARGINS if self._scene.ground.plain else _MARGINS[-1:]:
            area = both.around(margin, ground)
            try:
                return self._over(self._map_of(area), begin, goal, closed)
            except NoWayError as error:
                if area.holds(ground):
                    raise self._told(error) from None
        raise NoWayError(f"no way leads from {said(begin)} to {said(end)}")

    def _told(self, error: NoWayError) -> NoWayError:
        """Why there is no way, and that steps are too high where that may be it."""
        highest = self._scene.ground.step
        if self._scene.ground.plain or highest >= STEP:
            return error
        told = NoWayError(f"{error}; steps of {100.0 * highest:.0f} cm are the highest for such legs")
        told.nearest = error.nearest
        return told

    def _over(self, room: RoomMap, begin: Place, goal: Place | Spot, closed: Sequence[tuple[Spot, float]]) -> Way:
        """The way over a map to the first floor that one leads to; raises `NoWayError` about the first of them."""
        errors = []
        for end in meant(room, goal, begin[1]):
            try:
                return way_over(room, self.prices, begin, end, closed)
            except NoWayError as error:
                errors.append(error)
        raise errors[0]

    def room(self) -> RoomMap:
        """The room over the whole ground."""
        return self._map_of(self._ground)

    def _map_of(self, area: Rectangle) -> RoomMap:
        """The map that holds an area."""
        with self._lock:
            if self._known is None or not self._known.area.holds(area):
                self._known = room_map(self._scene, self._girth, area)
            return self._known
