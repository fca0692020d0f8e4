"""The names of courses: `gauntlet:5:1013` is the course of level 5 with the seed 1013."""

import re

from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.levels import level_of
from elbowroom.world.stock_scenes import UnknownSceneError, check_scene_name

PREFIX = "gauntlet:"
NAMED = "gauntlet:LEVEL:SEED, for example gauntlet:5:1013"
LARGEST_SEED = 2**32 - 1
_NAME = re.compile(r"gauntlet:(\d{1,3}):(\d{1,10})")


def parse_name(name: str) -> tuple[int, int]:
    """Level and seed in the name of a course; raises `InputError` where it is no such name."""
    found = _NAME.fullmatch(name)
    if found is None or int(found[2]) > LARGEST_SEED:
        raise InputError(f"scene {name[:40]!r}: a course is named {NAMED}")
    level_of(int(found[1]))
    return int(found[1]), int(found[2])


def is_course(name: str) -> bool:
    """Whether a scene's name is, or is meant to be, that of a course."""
    return name.lower().startswith(PREFIX)


def check_name(name: str) -> None:
    """Raises `InputError` if this names neither a course nor a stock scene and is not like a file's name."""
    if is_course(name):
        parse_name(name.lower())
        return
    try:
        check_scene_name(name)
    except UnknownSceneError as error:
        raise InputError(f"{error} nor a random course ({NAMED})") from None
