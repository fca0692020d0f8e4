"""How large things in a scene document may be."""

import math
import re

from elbowroom.world.json_place import JsonPlace

FARTHEST = 10_000.0  # metres, any coordinate
LARGEST = 1_000.0  # metres, any size
NAME = 100  # characters
_COLOR = re.compile(r"#[0-9a-fA-F]{6}")
_FULL_TURN = 6.2832  # radians; what is larger was meant in degrees


def read_angle(place: JsonPlace) -> float:
    """An angle in radians."""
    if isinstance(place.value, int | float) and _FULL_TURN < abs(place.value) <= 360.0:
        place.fail(f"must be an angle in radians (were these degrees? then write {math.radians(place.value):.4f})")
    return place.number(-_FULL_TURN, _FULL_TURN)


def read_color(place: JsonPlace) -> str:
    """A colour in six hexadecimal digits, such as "#c07a3e"."""
    if not isinstance(place.value, str) or not _COLOR.fullmatch(place.value):
        place.fail('must be a colour such as "#c07a3e"')
    return place.value.lower()
