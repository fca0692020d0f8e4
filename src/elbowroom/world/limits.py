"""How large things in a scene document may be."""

import math

from elbowroom.world.json_place import Place

FARTHEST = 10_000.0  # metres, any coordinate
LARGEST = 1_000.0  # metres, any size
NAME = 100  # characters
_FULL_TURN = 6.2832  # radians; what is larger was meant in degrees


def read_angle(place: Place) -> float:
    """An angle in radians."""
    if isinstance(place.value, int | float) and _FULL_TURN < abs(place.value) <= 360.0:
        place.fail(f"must be an angle in radians (were these degrees? then write {math.radians(place.value):.4f})")
    return place.number(-_FULL_TURN, _FULL_TURN)
