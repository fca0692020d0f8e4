"""Messages to JSON text and back, checked against their dataclasses."""

import dataclasses
import json
import sys
import types
from collections.abc import Callable
from functools import cache
from typing import Annotated, Any, Literal, NoReturn, Union, cast, get_args, get_origin, get_type_hints

from elbowroom.errors import InputError
from elbowroom.server.schema.bounds import Length, Range
from elbowroom.server.wire.messages import ClientMessage, ServerMessage


def tag(kind: type) -> str:
    """The value of `type` that marks a message on the wire: the class name in camelCase, without "Message"."""
    name = kind.__name__.removesuffix("Message")
    return name[0].lower() + name[1:]


def camel(name: str) -> str:
    """A field's name on the wire."""
    head, *rest = name.split("_")
    return head + "".join(part.capitalize() for part in rest)


def encode(message: ClientMessage | ServerMessage) -> str:
    """A message as JSON text; raises ValueError for a number that is not finite."""
    data = {"type": tag(type(message)), **_plain(message)}
    return json.dumps(data, separators=(",", ":"), allow_nan=False, ensure_ascii=False)


def plain(value: Any) -> Any:
    """A schema object as JSON-ready dicts and lists."""
    return _plain(value)


def decode_client(text: str) -> ClientMessage:
    """Read a client's message; raises `InputError` in one line if anything about it is wrong."""
    return cast(ClientMessage, _decode(text, get_args(ClientMessage)))


def decode_server(text: str) -> ServerMessage:
    """Read a server's message: for clients written in Python, and for tests."""
    return cast(ServerMessage, _decode(text, get_args(ServerMessage)))


def _decode(text: str, kinds: tuple[type, ...]) -> Any:
    data = _parse(text)
    if not isinstance(data, dict):
        raise InputError(f"message: {_show(data)} is not an object with a type")
    name = data.pop("type", None)
    kind = {tag(kind): kind for kind in kinds}.get(name) if isinstance(name, str) else None
    if kind is None:
        allowed = ", ".join(tag(kind) for kind in kinds)
        raise InputError(f"message: type {_show(name)} is unknown; allowed are {allowed}")
    return _reader(kind)(data, tag(kind))


def _parse(text: str) -> Any:
    try:
        return json.loads(text, parse_constant=_reject_constant)
    except RecursionError:
        raise InputError("message: JSON is nested too deeply") from None
    except ValueError as error:
        raise InputError(f"message: not JSON ({error})") from None


def _reject_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a JSON number")


def _plain(value: Any) -> Any:
    kind = type(value)
    if kind in _BARE:
        return value
    if dataclasses.is_dataclass(kind):
        return {wire: _plain(getattr(value, name)) for wire, name in _names(kind)}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return value


@cache
def _names(kind: type) -> tuple[tuple[str, str], ...]:
    """The fields of a message, as they are called on the wire and here."""
    return tuple((camel(field.name), field.name) for field in dataclasses.fields(kind))


_BARE = frozenset((float, int, str, bool, types.NoneType))  # as they are in JSON
_LARGEST = sys.float_info.max  # also of whole numbers, which Python reads at any length

Reader = Callable[[Any, str], Any]


@cache
def _reader(annotation: Any) -> Reader:
    """The function `(value, place) -> checked value` for a type annotation of the schema."""
    if dataclasses.is_dataclass(annotation):
        return _object_reader(cast(type, annotation))
    arguments = get_args(annotation)
    make = _MAKERS.get(get_origin(annotation))
    return make(arguments) if make else _SCALARS[annotation]


def _object_reader(kind: type) -> Reader:
    hints = get_type_hints(kind, include_extras=True)
    fields = {camel(f.name): f for f in dataclasses.fields(kind)}
    readers = {name: _reader(hints[f.name]) for name, f in fields.items()}
    needed = {name for name, f in fields.items() if f.default is dataclasses.MISSING}

    def read(value: Any, place: str) -> Any:
        if not isinstance(value, dict):
            _fail(place, value, "an object")
        for name in value:
            if name not in fields:
                raise InputError(f"{place}: field {_show(name)} is unknown; allowed are {', '.join(fields) or 'none'}")
        for name in needed:
            if name not in value:
                raise InputError(f"{place}: field {name} is missing")
        return kind(**{fields[name].name: readers[name](item, f"{place}.{name}") for name, item in value.items()})

    return read


def _bounded_reader(arguments: tuple[Any, ...]) -> Reader:
    inner, bounds = _reader(arguments[0]), arguments[1:]

    def read(value: Any, place: str) -> Any:
        checked = inner(value, place)
        for bound in bounds:
            if isinstance(bound, Range) and not bound.low <= checked <= bound.high:
                _fail(place, value, f"from {bound.low:g} to {bound.high:g}")
            if isinstance(bound, Length) and len(checked) > bound.most:
                _fail(place, value, f"at most {bound.most} long")
        return checked

    return read


def _optional_reader(arguments: tuple[Any, ...]) -> Reader:
    (inner,) = [_reader(argument) for argument in arguments if argument is not types.NoneType]
    return lambda value, place: None if value is None else inner(value, place)


def _choice_reader(choices: tuple[Any, ...]) -> Reader:
    def read(value: Any, place: str) -> Any:
        if not isinstance(value, str) or value not in choices:
            _fail(place, value, "one of " + ", ".join(choices))
        return value

    return read


def _list_reader(arguments: tuple[Any, ...]) -> Reader:
    item = _reader(arguments[0])

    def read(value: Any, place: str) -> list[Any]:
        if not isinstance(value, list):
            _fail(place, value, "a list")
        return [item(entry, f"{place}[{i}]") for i, entry in enumerate(value)]

    return read


def _tuple_reader(arguments: tuple[Any, ...]) -> Reader:
    items = [_reader(argument) for argument in arguments]

    def read(value: Any, place: str) -> tuple[Any, ...]:
        if not isinstance(value, list) or len(value) != len(items):
            _fail(place, value, f"a list of {len(items)}")
        return tuple(item(entry, f"{place}[{i}]") for i, (item, entry) in enumerate(zip(items, value, strict=True)))

    return read


def _number(value: Any, place: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) <= _LARGEST:
        _fail(place, value, "a finite number")
    return float(value)


def _integer(value: Any, place: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        _fail(place, value, "a whole number")
    return value


def _text(value: Any, place: str) -> str:
    if not isinstance(value, str):
        _fail(place, value, "a text")
    return value


def _switch(value: Any, place: str) -> bool:
    if not isinstance(value, bool):
        _fail(place, value, "true or false")
    return value


_MAKERS: dict[Any, Callable[[tuple[Any, ...]], Reader]] = {
    Annotated: _bounded_reader,
    Union: _optional_reader,
    types.UnionType: _optional_reader,
    Literal: _choice_reader,
    list: _list_reader,
    tuple: _tuple_reader,
}
_SCALARS: dict[Any, Reader] = {float: _number, int: _integer, str: _text, bool: _switch}


def _fail(place: str, value: Any, allowed: str) -> NoReturn:
    raise InputError(f"{place}: {_show(value)} is not {allowed}")


def _show(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=True)
    return text if len(text) <= 60 else text[:57] + "..."
