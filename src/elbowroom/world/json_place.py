"""A value in a JSON document that knows where it stands, so that every complaint about it can say so."""

import difflib
import json
import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from elbowroom.errors import InputError
from elbowroom.formats.json_numbers import NUMBERS

_SHOWN = 60  # characters of a wrong value that are quoted


@dataclass(frozen=True)
class JsonPlace:
    """A value, the file that it came from and its path there, such as `$.obstacles[3].size[0]`."""

    source: str
    path: str
    value: Any

    def fail(self, allowed: str) -> NoReturn:
        """Raise an `InputError` that names file, field and value, and says what is allowed."""
        raise InputError(f"{self.source}: {self.path} is {quoted(self.value)}; {allowed}")

    def fields(self, required: Collection[str], optional: Collection[str] = ()) -> "dict[str, JsonPlace]":
        """The members of an object that has all `required` names, perhaps `optional` ones, and no others."""
        if not isinstance(self.value, dict):
            self.fail(f"must be an object with the fields {', '.join(required)}")
        for name in required:
            if name not in self.value:
                raise InputError(f"{self.source}: {self.path} lacks the field {name!r}; it needs {', '.join(required)}")
        known = [*required, *optional]
        for name in self.value:
            if name not in known:
                near = difflib.get_close_matches(str(name), known, n=1)
                hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(known)}"
                raise InputError(f"{self.source}: {self.path} has an unknown field {quoted(name)}; {hint}")
        return {name: JsonPlace(self.source, f"{self.path}.{name}", item) for name, item in self.value.items()}

    def items(self, most: int) -> "Iterator[JsonPlace]":
        """The items of a list with at most `most` of them."""
        if not isinstance(self.value, list):
            self.fail("must be a list")
        if len(self.value) > most:
            raise InputError(f"{self.source}: {self.path} has {len(self.value)} items; at most {most} are allowed")
        for i, item in enumerate(self.value):
            yield JsonPlace(self.source, f"{self.path}[{i}]", item)

    def number(self, low: float, high: float, *, above: bool = False) -> float:
        """A finite number in [low, high], or in (low, high] with `above`."""
        value = self.value
        bounds = f"must be a number {'above' if above else 'from'} {low:g} {'and at most' if above else 'to'} {high:g}"
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            self.fail(bounds)
        if not low <= value <= high or (above and value == low):
            self.fail(bounds)
        return float(value)

    def vector(self, size: int, low: float, high: float, *, above: bool = False) -> list[float]:
        """A list of exactly `size` numbers, each as in `number`."""
        if not isinstance(self.value, list) or len(self.value) != size:
            self.fail(f"must be a list of {size} numbers")
        return [item.number(low, high, above=above) for item in self.items(size)]

    def text(self, most: int, *, least: int = 0) -> str:
        """A string of `least` to `most` characters."""
        if not isinstance(self.value, str) or not least <= len(self.value) <= most:
            self.fail(f"must be a text of {least} to {most} characters")
        return str(self.value)

    def constant(self, expected: str | int) -> None:
        """Exactly this text or number."""
        if isinstance(self.value, bool) or self.value != expected:
            self.fail(f"must be {json.dumps(expected)}")


def quoted(value: object) -> str:
    """A value as JSON, cut to a length fit for one line."""
    try:
        text = json.dumps(value)
    except (TypeError, ValueError, RecursionError):
        text = f"of type {type(value).__name__}"
    return text if len(text) <= _SHOWN else text[:_SHOWN] + "…"


def read_json(path: Path, most_bytes: int) -> Any:
    """The JSON document in a file of at most `most_bytes` bytes; raises `InputError`."""
    try:
        size = path.stat().st_size
        if size > most_bytes:
            raise InputError(f"{path}: the file has {size} bytes; at most {most_bytes} are allowed")
        text = path.read_bytes()[:most_bytes].decode("utf-8-sig")
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: byte {error.start} is not UTF-8 text; save the file as UTF-8") from error
    return parse_json(text, str(path))


def parse_json(text: str, source: str) -> Any:
    """The JSON document in a text: no duplicate names, no NaN, no endless nesting; raises `InputError`."""

    def members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for name, value in pairs:
            if name in found:
                raise InputError(f"{source}: the field {quoted(name)} stands twice in one object; keep one of them")
            found[name] = value
        return found

    try:
        return json.loads(text, object_pairs_hook=members, **NUMBERS)
    except json.JSONDecodeError as error:
        raise InputError(f"{source}: line {error.lineno}, column {error.colno}: not JSON: {error.msg}") from error
    except RecursionError:
        raise InputError(f"{source}: nested too deeply; five levels are enough") from None
    except InputError:
        raise
    except ValueError as error:
        raise InputError(f"{source}: {error}") from error
