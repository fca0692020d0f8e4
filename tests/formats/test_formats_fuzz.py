"""Whatever bytes come in: a humanoid or one line that says what is wrong, and nothing else."""

import copy
from typing import Any

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from avatar_builder import Recipe, build, json_of
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.errors import InputError
from elbowroom.formats.packing import write_glb

SMALL = build(Recipe(vrm="1", points=2, spin=True))
MESHED = build(Recipe(vrm="0", points=2, heading=np.pi))
JSON_SIZE = int.from_bytes(MESHED[12:16], "little")
CALM = settings(max_examples=20, deadline=None, suppress_health_check=list(HealthCheck))
WRONG: list[Any] = [None, -1, 0, 1, 2**40, 1.5, 1e300, "x", [], {}, [[]], True, [1e9] * 3, [0] * 4]


def _load(data: bytes) -> None:
    try:
        humanoid = load_humanoid_bytes(data, "fuzz.vrm")
    except InputError as error:
        message = str(error)
    else:
        message = ""
        assert np.isfinite(humanoid.skeleton.positions).all()
        assert np.isfinite(humanoid.capsules.radii).all()
    assert "\n" not in message
    assert len(message) < 600


@CALM
@given(st.lists(st.tuples(st.integers(0, len(SMALL) - 1), st.integers(0, 255)), max_size=4), st.integers(0, 40))
def test_changed_bytes(changes: list[tuple[int, int]], cut: int) -> None:
    data = bytearray(SMALL)
    for at, value in changes:
        data[at] = value
    _load(bytes(data[: len(data) - (cut if cut < 20 else 0)]))


@CALM
@given(st.integers(0, len(SMALL)))
def test_cut_off_files(length: int) -> None:
    _load(SMALL[:length])


@settings(CALM, max_examples=12)
@given(st.data())
def test_a_wrong_value_anywhere_in_the_json(data: st.DataObject) -> None:
    content = copy.deepcopy(json_of(MESHED))
    place: Any = content
    while True:
        keys = sorted(place) if isinstance(place, dict) else range(len(place))
        key: Any = data.draw(st.sampled_from(list(keys)))
        if not place[key] or not isinstance(place[key], dict | list) or data.draw(st.integers(0, 5)) == 0:
            break
        place = place[key]
    place[key] = data.draw(st.sampled_from(WRONG))
    _load(write_glb(content, MESHED[28 + JSON_SIZE :]))
