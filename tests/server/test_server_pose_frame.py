"""The binary layout of a pose."""

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from elbowroom.server.wire import pose_frame
from elbowroom.server.wire.pose_frame import PoseFrame, offsets, pack, parse

UNSIGNED = {"B": 8, "H": 16, "I": 32}
CODES = {name: code for name, code, _ in pose_frame.HEAD}
NAMES = [name for name in CODES if name not in ("kind", "layout", "joint_count", "capsule_count", "reserved")]


def number(code: str) -> st.SearchStrategy[float]:
    if code in UNSIGNED:
        return st.integers(0, 2 ** UNSIGNED[code] - 1)
    return st.floats(width=32 if code == "f" else 64, allow_nan=False)


def floats(columns: int) -> st.SearchStrategy[np.ndarray]:
    return arrays.arrays(
        np.float32, st.tuples(st.integers(0, 60), st.just(columns)), elements=st.floats(-1, 1, width=32)
    )


FRAMES = st.builds(PoseFrame, **{name: number(CODES[name]) for name in NAMES}, rotations=floats(4), capsules=floats(6))


@given(frame=FRAMES)
def test_frames_survive_the_wire(frame: PoseFrame) -> None:
    back = parse(pack(frame))
    assert [getattr(back, name) for name in NAMES] == [getattr(frame, name) for name in NAMES]
    np.testing.assert_array_equal(back.rotations, frame.rotations)
    np.testing.assert_array_equal(back.capsules, frame.capsules)


@given(frame=FRAMES)
def test_fields_lie_where_the_offsets_say(frame: PoseFrame) -> None:
    data, at = pack(frame), offsets()
    for name in NAMES:
        assert struct.unpack_from("<" + CODES[name], data, at[name]) == (getattr(frame, name),)
    assert at["rotations"] == pose_frame.HEAD_SIZE
    assert len(data) == pose_frame.HEAD_SIZE + 16 * len(frame.rotations) + 24 * len(frame.capsules)


def test_numbers_are_aligned() -> None:
    sizes = {"B": 1, "H": 2, "I": 4, "f": 4, "d": 8}
    for name, place in offsets().items():
        assert place % sizes[CODES.get(name, "f")] == 0, name


@given(data=st.binary(max_size=300))
def test_junk_is_refused(data: bytes) -> None:
    with pytest.raises(ValueError, match="pose frame"):
        parse(data)


@given(frame=FRAMES)
def test_flags_are_read_by_name(frame: PoseFrame) -> None:
    assert sum(bit for name, bit in pose_frame.FLAGS.items() if frame.flag(name)) == frame.flags & 127
