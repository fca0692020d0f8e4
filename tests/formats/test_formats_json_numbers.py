"""Numbers in JSON from outside: however they are written, a finite one comes, or one short line."""

import math
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from elbowroom.dataset.spec import DatasetSpec
from elbowroom.errors import InputError
from elbowroom.formats.fields import parse_json as parse_format
from elbowroom.server.wire.codec import decode_client
from elbowroom.world.json_place import parse_json as parse_scene

LONGEST = 300  # characters of a message

NUMBERS = st.builds(
    lambda sign, digit, count, rest: f"{sign}{digit * count}{rest}",
    st.sampled_from(["", "-"]),
    st.sampled_from("123456789"),
    st.integers(1, 6000),
    st.sampled_from(["", ".5", "e3", "e-3", "e999", "E+400"]),
)
DOORS: dict[str, Callable[[str], Any]] = {
    "format": lambda number: parse_format(f'{{"seed": {number}}}'.encode(), "file")["seed"],
    "scene": lambda number: parse_scene(f'{{"seed": {number}}}', "file")["seed"],
    "dataset": lambda number: DatasetSpec.of(parse_scene(f'{{"seconds": {number}}}', "file")).seconds,
    "message": lambda number: decode_client(f'{{"type": "ping", "t": {number}}}').t,  # type: ignore[union-attr]
}


def read_or_refused(door: str, number: str) -> float | str:
    try:
        return float(DOORS[door](number))
    except InputError as error:
        return str(error)


@pytest.mark.parametrize("door", DOORS)
@given(number=NUMBERS)
@example(number="1" * 400)
@example(number="9" * 5000)
def test_it_is_finite_or_refused_in_a_line(door: str, number: str) -> None:
    found = read_or_refused(door, number)
    if isinstance(found, str):
        assert "\n" not in found
        assert len(found) < LONGEST
    else:
        assert math.isfinite(found)
