"""Courses as scenes by name: `gauntlet:5:1013` is the course of level 5 with the seed 1013."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import numpy as np

from elbowroom.experiment.gauntlet.course import Course, make_course
from elbowroom.experiment.gauntlet.levels import LEVELS
from elbowroom.experiment.gauntlet.names import PREFIX, check_name, is_course, parse_name
from elbowroom.experiment.gauntlet.user import CourseUser
from elbowroom.experiment.scripted_user import User
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.scene import Scene


def random_names(seed: int = 0) -> tuple[str, ...]:
    """The names of one course of every level."""
    return tuple(f"{PREFIX}{level}:{seed}" for level in LEVELS)


def course_scene(name: str) -> Scene:
    """The scene of the course of this name; makes it, which takes a moment. Raises `InputError`."""
    return _course(name).scene


def course_user(name: str, seed: int) -> User | None:
    """Who follows the line of the course of this name, for `crossing`; None where a scene is no course."""
    if not is_course(name):
        return None
    return CourseUser(_course(name.lower()).line, np.random.default_rng([seed, 2])).command


@lru_cache(maxsize=16)
def _course(name: str) -> Course:
    made = make_course(*parse_name(name))
    return replace(made, scene=replace(made.scene, name=name))


def load_scene(
    name: str,
    options: PlaceOptions | None = None,
    progress: Callable[[str, float], None] = lambda _what, _share: None,
) -> Scene:
    """A course, a stock scene by name, a scene file, or a model of a place; raises `InputError`."""
    check_name(name)
    return course_scene(name.lower()) if is_course(name) else Scene.load(name, options, progress)
