"""Courses as scenes by name: `gauntlet:5:1013` is the course of level 5 with the seed 1013."""

import re
from dataclasses import replace
from functools import lru_cache

from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.course import LARGEST_SEED, make_course
from elbowroom.experiment.gauntlet.levels import LEVELS, level_of
from elbowroom.world.scene import Scene, UnknownSceneError

PREFIX = "gauntlet:"
NAMED = "gauntlet:LEVEL:SEED, for example gauntlet:5:1013"
_NAME = re.compile(r"gauntlet:(\d{1,3}):(\d{1,10})")


def random_names(seed: int = 0) -> tuple[str, ...]:
    """The names of one course of every level."""
    return tuple(f"{PREFIX}{level}:{seed}" for level in LEVELS)


def parse_name(name: str) -> tuple[int, int]:
    """Level and seed in the name of a course; raises `InputError` where it is no such name."""
    found = _NAME.fullmatch(name)
    if found is None or int(found[2]) > LARGEST_SEED:
        raise InputError(f"scene {name[:40]!r}: a course is named {NAMED}")
    level_of(int(found[1]))
    return int(found[1]), int(found[2])


@lru_cache(maxsize=16)
def course_scene(name: str) -> Scene:
    """The scene of the course of this name; makes it, which takes a moment. Raises `InputError`."""
    return replace(make_course(*parse_name(name)).scene, name=name)


def load_scene(name: str) -> Scene:
    """A course, a stock scene by name, or a scene file; raises `InputError`."""
    if name.lower().startswith(PREFIX):
        return course_scene(name.lower())
    try:
        return Scene.load(name)
    except UnknownSceneError as error:
        raise InputError(f"{error} nor a random course ({NAMED})") from None
