"""A scene of the model of a place: its parts stand in the way, start and finish are found in it."""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

from elbowroom.body.root import RootState
from elbowroom.world.ground.making import walked_over
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.place import Place
from elbowroom.world.places.reading import read_place
from elbowroom.world.places.scene_place import ScenePlace, standing_parts
from elbowroom.world.places.site import site_of
from elbowroom.world.scene import Gate, Scene

Progress = Callable[[str, float], None]

_AROUND = 4.0  # metres of ground round a place
_LARGEST = 1000.0  # metres of ground
_GATE = 1.6  # metres
_LONGEST_NAME = 60


def load_place_scene(path: Path, options: PlaceOptions, progress: Progress = lambda _what, _share: None) -> Scene:
    """The scene of a model's file; raises `InputError`."""
    return place_scene(read_place(path, options, progress), progress)


def place_scene(place: Place, progress: Progress = lambda _what, _share: None) -> Scene:
    """The scene of a place: its ground becomes height 0, the start is where one can begin; raises `InputError`."""
    found = site_of(place, progress)
    start, ground = found.beginning, found.height
    obstacles = walked_over(standing_parts(place, ground), found.floor)
    least, most = place.bounds
    wide, deep = np.minimum((most - least)[[0, 2]] + 2.0 * _AROUND, _LARGEST).tolist()
    x, z = (0.5 * (least + most))[[0, 2]].tolist()
    finish = (start.x + start.way * math.sin(start.heading), start.z + start.way * math.cos(start.heading))
    said = (*place.told, *found.notes, *place.notes)
    return Scene(
        name=_name_of(place.name),
        title=Path(place.name).stem[:_LONGEST_NAME] or "place",
        description=". ".join(sentence[:1].upper() + sentence[1:] for sentence in said)[:2000],
        ground_center=(x, z),
        ground_size=(wide, deep),
        start=RootState(x=start.x, z=start.z, heading=math.remainder(start.heading, 2.0 * math.pi)),
        finish=Gate(finish, math.remainder(start.heading, 2.0 * math.pi), _GATE),
        obstacles=obstacles,
        place=ScenePlace(
            file=place.name,
            sha256=place.digest,
            options=replace(place.options, ground=ground, scale=place.metre, up=place.up),
            parts=len(obstacles),
            place=place,
            notes=(*found.notes, *place.notes),
            floor=found.floor,
        ),
    )


def _name_of(file: str) -> str:
    """A name for menus and addresses."""
    return re.sub(r"[^A-Za-z0-9._-]+", "_", Path(file).name)[:_LONGEST_NAME] or "place"
