"""Where one walks in a place: what its survey comes to, kept on disk, since looking a place over takes a while."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from elbowroom.kept_arrays import Arrays, kept
from elbowroom.world.places.beginning import Beginning
from elbowroom.world.places.floor_area import FloorArea
from elbowroom.world.places.place import Place
from elbowroom.world.places.survey import survey


class Site(NamedTuple):
    """What a scene is made of, beside the place itself."""

    height: float  # of the floor that is walked on, metres
    beginning: Beginning
    notes: tuple[str, ...]  # how ground and start were found
    floor: FloorArea | None  # to keep to; None where one begins beside the place


def site_of(place: Place, progress: Callable[[str, float], None] = lambda _what, _share: None) -> Site:
    """The site of a place; raises `InputError` where it is too large."""
    progress("Looking for floors", 0.0)
    told, stands = place.options.ground, np.array([part.stands for part in place.parts])
    heads = place.name.encode(), stands, np.array([] if told is None else [told])
    parts = (each for part in place.parts for each in (part.vertices, part.faces))
    return _read(kept(__file__, (*heads, *parts), lambda: _surveyed(place, progress)))


def _surveyed(place: Place, progress: Callable[[str, float], None]) -> Arrays:
    found = survey(place, progress)
    floor = found.floor
    return {
        "height": np.array([found.ground.height]),
        "beginning": np.array(found.beginning),
        "notes": np.array(found.notes, np.str_),
        "origin": np.array([] if floor is None else [*floor.origin, floor.cell]),
        "there": np.zeros((0, 0), np.bool_) if floor is None else floor.there,
    }


def _read(arrays: Arrays) -> Site:
    floor, (x, z, heading, way) = None, arrays["beginning"].tolist()
    if len(arrays["origin"]):
        left, back, cell = arrays["origin"].tolist()
        floor = FloorArea((left, back), cell, arrays["there"])
    return Site(float(arrays["height"][0]), Beginning(x, z, heading, way), tuple(arrays["notes"].tolist()), floor)
