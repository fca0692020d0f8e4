"""Courses that several tests look at, each made once."""

from functools import cache

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.gauntlet.course import Course, CourseMaker

SAMPLE = [(level, seed) for level in range(1, 6) for seed in (0, 1)]  # levels 3 to 5: straight and winding lines


@cache
def stock() -> tuple[Humanoid, CourseMaker]:
    humanoid = Humanoid.default()
    return humanoid, CourseMaker.of(humanoid)


@cache
def course(level: int, seed: int) -> Course:
    return stock()[1].course(level, seed)
