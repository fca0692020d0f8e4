"""A cursor over untrusted JSON: every wrong value becomes one line that says where it stands and what is allowed."""

import json
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.json_numbers import NUMBERS

_MAX_JSON_BYTES = 64 * 1024 * 1024
_LARGEST = 1e6  # of any number that places something; far beyond every avatar, and its products stay finite
_SHOWN = 40  # characters of a wrong value that a message repeats


@dataclass(frozen=True)
class Field:
    """A JSON value and its place, e.g. `robot.vrm: nodes[3].rotation`; a missing value is None."""

    value: Any
    place: str

    @property
    def present(self) -> bool:
        """Whether the file has this field."""
        return self.value is not None

    def wrong(self, allowed: str) -> InputError:
        """The error that names the place, the value found there, and what is allowed."""
        if self.value is None:
            return InputError(f"{self.place} is missing: {allowed} is needed")
        shown = " ".join(repr(self.value).split())
        shown = shown if len(shown) <= _SHOWN else shown[:_SHOWN] + "..."
        return InputError(f"{self.place} is {shown}: it must be {allowed}")

    def at(self, key: str) -> "Field":
        """The member `key` of this object; missing when the object itself is missing."""
        if self.value is not None and not isinstance(self.value, dict):
            raise self.wrong("an object")
        separator = ": " if self.place.count(": ") == 0 else "."
        return Field((self.value or {}).get(key), f"{self.place}{separator}{key}")

    def names(self, most: int) -> list[str]:
        """The member names of this object, at most `most`; none when it is missing."""
        members = {} if self.value is None else self.value
        if not isinstance(members, dict):
            raise self.wrong("an object")
        if len(members) > most:
            raise InputError(f"{self.place} has {len(members)} members: at most {most} are read")
        return list(members)

    def items(self, most: int = 1_000_000) -> list["Field"]:
        """The elements of this list; none when it is missing."""
        if self.value is None:
            return []
        if not isinstance(self.value, list):
            raise self.wrong("a list")
        if len(self.value) > most:
            raise InputError(f"{self.place} has {len(self.value)} elements: at most {most} are read")
        return [Field(value, f"{self.place}[{i}]") for i, value in enumerate(self.value)]

    def pick(self, reference: "Field") -> "Field":
        """The element of this list whose index is the value of `reference`."""
        if self.value is not None and not isinstance(self.value, list):
            raise self.wrong("a list")
        if not self.value:
            raise InputError(f"{reference.place} points into {self.place}, which is empty or missing")
        index = reference.integer(0, len(self.value) - 1)
        return Field(self.value[index], f"{self.place}[{index}]")

    def integer(self, low: int, high: int) -> int:
        """A whole number within [low, high]."""
        value = self.value
        if isinstance(value, float) and value.is_integer():
            value = int(value)
        if not isinstance(value, int) or isinstance(value, bool) or not low <= value <= high:
            raise self.wrong(f"a whole number from {low} to {high}")
        return value

    def optional_integer(self, low: int, high: int, default: int) -> int:
        """A whole number within [low, high], or `default` when it is missing."""
        return self.integer(low, high) if self.present else default

    def vector(self, size: int) -> NDArray[np.float64]:
        """A list of `size` numbers, each finite and of sane size."""
        values = self.value
        if not isinstance(values, list) or len(values) != size or not all(_is_number(v) for v in values):
            raise self.wrong(f"a list of {size} numbers")
        return np.array(values, dtype=np.float64)

    def text(self, default: str = "") -> str:
        """A text, with its white space folded to single spaces and cut to 200 characters."""
        if self.value is None:
            return default
        if not isinstance(self.value, str):
            raise self.wrong("a text")
        return " ".join(self.value.split())[:200]

    def flag(self) -> bool:
        """A boolean; False when it is missing."""
        if self.value is None:
            return False
        if not isinstance(self.value, bool):
            raise self.wrong("true or false")
        return self.value


def _is_number(value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return math.isfinite(value) and abs(value) <= _LARGEST


def parse_json(text: bytes, name: str, nulls: bool = False) -> dict[str, Any]:
    """A JSON object from untrusted bytes; `name` stands for the file in messages. Raises `InputError`.

    Its numbers are finite, and a member that is null is none (but with `nulls`): who passes it on can count on both.
    """
    if len(text) > _MAX_JSON_BYTES:
        raise InputError(f"{name}: the JSON part has {len(text) >> 20} MB: at most {_MAX_JSON_BYTES >> 20} MB are read")
    try:
        value = json.loads(
            text.decode("utf-8-sig").rstrip("\x00 \t\r\n"),
            object_pairs_hook=None if nulls else _present,
            **NUMBERS,
        )
    except RecursionError:
        raise InputError(f"{name}: the JSON part is nested too deeply") from None
    except ValueError as error:
        raise InputError(f"{name}: the JSON part cannot be read: {_fault(text, error)}") from None
    if not isinstance(value, dict):
        raise InputError(f"{name}: the JSON part is not an object")
    return value


def beginning_of(data: bytes) -> str:
    """What a file begins with, to go on with after its name in a message."""
    if not data:
        return " is empty"
    text = data[:12].decode("latin-1")
    return f" begins with {text!r}" if text.isprintable() else f" begins with the bytes {data[:8].hex(' ')}"


def _fault(text: bytes, error: ValueError) -> str:
    """Where JSON goes wrong, in words for its writer."""
    if not text.strip(b"\x00 \t\r\n"):
        return "it is empty"
    if isinstance(error, json.JSONDecodeError):
        return f"line {error.lineno}, column {error.colno} is not as JSON goes on"
    if isinstance(error, UnicodeDecodeError):
        return f"its byte {error.start} is not UTF-8 text"
    return str(error)


def _present(members: list[tuple[str, Any]]) -> dict[str, Any]:
    return {name: value for name, value in members if value is not None}
