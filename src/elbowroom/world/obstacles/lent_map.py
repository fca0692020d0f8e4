"""One map of free distances for all who walk in a place, for as long as any of them holds it: it takes megabytes."""

from typing import Any
from weakref import ReferenceType, ref

from elbowroom.world.ground.ground import PLAIN, Ground
from elbowroom.world.obstacles.free_map import FreeMap, Near


class LentMap:
    """Who asks while somebody holds the map has the same; copies of a place begin with none."""

    def __init__(self, near: Near, ground: Ground = PLAIN) -> None:
        """As for `FreeMap`."""
        self._made_of = near, ground
        self._lent: ReferenceType[FreeMap] | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        return LentMap, self._made_of

    def take(self) -> FreeMap:
        """The map, to be held as long as it is used."""
        found = None if self._lent is None else self._lent()
        if found is None:
            found = FreeMap(*self._made_of)
            self._lent = ref(found)
        return found
