"""What a program hands over may be anything: whether it is a number, and what a controller is made of."""

import sys
from numbers import Integral, Real
from typing import Any

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.motion_set import MotionSet
from elbowroom.errors import InputError, in_a_line
from elbowroom.world.scene import Scene


def is_number(value: object) -> bool:
    """Whether it is a finite number that a float can hold."""
    number: Any = value  # as types say nothing of what programs do
    return isinstance(value, Real) and bool(abs(number) <= sys.float_info.max)


def is_whole(value: object) -> bool:
    """Whether it is a whole number of Python's or NumPy's."""
    return isinstance(value, Integral)


def check_made_of(humanoid: object, scene: object, motions: object) -> None:
    """Raises `InputError` for what a program takes for one of these."""
    for name, given, kind, maker in (
        ("humanoid", humanoid, Humanoid, "Humanoid.load"),
        ("scene", scene, Scene, "Scene.load"),
        ("motions", motions, MotionSet, "motions_of"),
    ):
        if not isinstance(given, kind):
            raise InputError(f"{name}: {in_a_line(given)} is no {kind.__name__}: {maker} makes one")
