"""Whether what a program hands over is a number: it may be anything."""

import sys
from numbers import Integral, Real
from typing import Any


def is_number(value: object) -> bool:
    """Whether it is a finite number that a float can hold."""
    number: Any = value  # as types say nothing of what programs do
    return isinstance(value, Real) and bool(abs(number) <= sys.float_info.max)


def is_whole(value: object) -> bool:
    """Whether it is a whole number of Python's or NumPy's."""
    return isinstance(value, Integral)
