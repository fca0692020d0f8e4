"""The message schema: round trips, refusals, and the TypeScript that is made from it."""

import json
import re
import types
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import pytest
from hypothesis import given
from hypothesis import strategies as st

from elbowroom.errors import InputError
from elbowroom.server.schema.bounds import Length, Range
from elbowroom.server.schema.commands import Configure, Input
from elbowroom.server.schema.progress import Notice
from elbowroom.server.wire import typescript
from elbowroom.server.wire.codec import decode_client, decode_server, encode, tag
from elbowroom.server.wire.messages import ClientMessage, ServerMessage

GENERATED = Path(__file__).parents[2] / "web" / "src" / "generated" / "messages.ts"


def values_of(annotation: Any) -> st.SearchStrategy[Any]:
    origin, arguments = get_origin(annotation), get_args(annotation)
    if is_dataclass(annotation) and isinstance(annotation, type):
        hints = get_type_hints(annotation, include_extras=True)
        return st.builds(annotation, **{f.name: values_of(hints[f.name]) for f in fields(annotation)})
    if origin is Annotated:
        return bounded(arguments[0], arguments[1])
    if origin in (Union, types.UnionType):
        return st.one_of(*(st.none() if argument is types.NoneType else values_of(argument) for argument in arguments))
    if origin is Literal:
        return st.sampled_from(arguments)
    if origin is list:
        return st.lists(values_of(arguments[0]), max_size=3)
    if origin is tuple:
        return st.tuples(*(values_of(argument) for argument in arguments))
    simple = {float: st.floats(allow_nan=False, allow_infinity=False), int: st.integers(), bool: st.booleans()}
    return simple.get(annotation, st.text(max_size=20))


def bounded(kind: type, bound: Any) -> st.SearchStrategy[Any]:
    if isinstance(bound, Length):
        return st.text(max_size=bound.most)
    assert isinstance(bound, Range)
    if kind is int:
        return st.integers(int(bound.low), int(bound.high))
    return st.floats(bound.low, bound.high)


CLIENT = st.one_of(*(values_of(kind) for kind in get_args(ClientMessage)))
SERVER = st.one_of(*(values_of(kind) for kind in get_args(ServerMessage)))


@given(message=CLIENT)
def test_client_messages_survive_the_wire(message: ClientMessage) -> None:
    assert decode_client(encode(message)) == message


@given(message=SERVER)
def test_server_messages_survive_the_wire(message: ServerMessage) -> None:
    assert decode_server(encode(message)) == message


def test_names_on_the_wire_are_camel_case() -> None:
    assert json.loads(encode(Configure(queue_size=4)))["queueSize"] == 4
    assert {tag(kind) for kind in get_args(ClientMessage)} == {
        "input", "configure", "clock", "reset", "goto", "push", "overlays", "ping",
    }  # fmt: skip


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=10),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=10), inner, max_size=4),
    max_leaves=10,
)
FIELD_NAMES = st.sampled_from(["type", "seq", "forward", "direction", "scene", "queueSize", "steps", "t", "plan"])
TYPES = st.sampled_from(["input", "configure", "clock", "reset", "overlays", "ping", "hello"])


def decoded_or_said(text: str) -> ClientMessage | str:
    try:
        return decode_client(text)
    except InputError as error:
        said = str(error)
    assert "\n" not in said
    assert len(said) < 400
    return said


@given(fields=st.dictionaries(FIELD_NAMES, JSON, max_size=5), kind=TYPES)
def test_whatever_comes_is_a_message_or_an_input_error_in_one_line(fields: dict[str, Any], kind: str) -> None:
    assert isinstance(decoded_or_said(json.dumps({**fields, "type": kind})), (str, *get_args(ClientMessage)))


@given(text=st.text(max_size=50))
def test_junk_is_an_input_error(text: str) -> None:
    with pytest.raises(InputError):
        decode_client(text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[" * 100_000, "message: "),
        ("1", "not an object"),
        ("{}", "type null is unknown"),
        ('{"type": ["input"]}', "unknown"),
        ('{"type": "input"}', "input: field seq is missing"),
        ('{"type": "input", "seq": 1.5}', "input.seq: 1.5 is not a whole number"),
        ('{"type": "input", "seq": true}', "input.seq: true is not a whole number"),
        ('{"type": "input", "seq": -1}', "input.seq: -1 is not from 0"),
        ('{"type": "input", "seq": 1, "forward": 2}', "input.forward: 2 is not from -1 to 1"),
        ('{"type": "input", "seq": 1, "forward": NaN}', "NaN is not a JSON number"),
        ('{"type": "input", "seq": 1, "forward": 1e999}', "not a finite number"),
        ('{"type": "input", "seq": 1, "forward": ' + "9" * 400 + "}", "input.forward"),
        ('{"type": "input", "seq": 1, "sideways": 1}', 'input: field "sideways" is unknown; allowed are seq, forward'),
        ('{"type": "configure", "scene": "' + "x" * 300 + '"}', "at most 128 long"),
        ('{"type": "configure", "queueSize": 3.5}', "configure.queueSize: 3.5 is not a whole number"),
        ('{"type": "reset", "hard": true}', "allowed are none"),
        ('{"type": "clock", "steps": "1"}', 'clock.steps: "1" is not a whole number'),
    ],
)
def test_wrong_messages_name_field_value_and_what_is_allowed(text: str, said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        decode_client(text)


def test_what_is_left_out_has_a_default() -> None:
    assert decode_client('{"type": "input", "seq": 7}') == Input(seq=7)
    assert decode_client('{"type": "configure"}') == Configure()


def test_an_infinite_number_is_not_sent() -> None:
    with pytest.raises(ValueError, match="JSON"):
        encode(Input(seq=1, direction=float("inf")))


def test_text_is_sent_as_it_is() -> None:
    assert "後ろへ" in encode(Notice("info", "後ろへ"))


@pytest.mark.skipif(not GENERATED.is_file(), reason="the client's sources are not here")
def test_the_generated_typescript_is_up_to_date() -> None:
    assert GENERATED.read_text(encoding="utf-8") == typescript.generate(), (
        "the schema has changed: run `python -m elbowroom.server.wire.typescript web/src/generated/messages.ts`"
    )


def test_the_generator_writes_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    typescript.main([str(tmp_path / "messages.ts")])
    typescript.main([])
    assert (tmp_path / "messages.ts").read_text(encoding="utf-8") == capsys.readouterr().out
