"""What counts as a number in JSON from outside: finite, and no longer than any that is meant."""

import math
from typing import Any, NoReturn

_MOST_DIGITS = 100  # of a whole number: far below where it could not be made a float


class NoNumberError(ValueError):
    """A word that stands for no number in JSON; its text says why."""


def finite(digits: str) -> float:
    """A number with a point or an exponent."""
    number = float(digits)
    if not math.isfinite(number):
        raise NoNumberError(f"{digits[:20]} is too large a number")
    return number


def whole(digits: str) -> int:
    """A number without."""
    if len(digits) > _MOST_DIGITS:
        raise NoNumberError(f"{digits[:20]}… is too large a number")
    return int(digits)


def no_constant(word: str) -> NoReturn:
    """NaN and Infinity, which Python's reader knows and JSON does not."""
    raise NoNumberError(f"{word} is not a JSON number; write a finite number")


NUMBERS: dict[str, Any] = {"parse_float": finite, "parse_int": whole, "parse_constant": no_constant}  # for json.loads
