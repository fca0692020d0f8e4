"""While nothing moves, at most two frames a second are on the wire; what is new goes out at once."""

from dataclasses import fields
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from elbowroom.server.sessions.standstill import SELDOM, UNSEEN, Standstill
from elbowroom.server.wire.pose_frame import PoseFrame, pack

RATE = 60


def frame(i: int, x: float = 0.0, acknowledged: int = 0, clearance: float = 0.3) -> bytes:
    numbers: dict[str, Any] = dict.fromkeys((field.name for field in fields(PoseFrame)), 0)
    numbers |= {"index": i, "time": i / RATE, "sim_time": i / RATE, "x": x, "acknowledged": acknowledged}
    numbers["clearance"] = clearance
    numbers |= {"rotations": np.zeros((3, 4), np.float32), "capsules": np.zeros((0, 6), np.float32)}
    return pack(PoseFrame(**numbers))


CLEARANCES = [0.3, np.inf]  # something is near; nothing is


@pytest.mark.parametrize("clearance", CLEARANCES)
def test_who_stands_still_costs_two_frames_a_second(clearance: float) -> None:
    watch = Standstill()
    sent = [watch.worth_sending(frame(i, clearance=clearance), i / RATE, restless=False) for i in range(20 * RATE)]
    assert all(sent[: RATE // 2])
    assert sum(sent[2 * RATE :]) <= 18 / SELDOM + 1
    assert sum(sent[2 * RATE :]) >= 18 / SELDOM - 2


@pytest.mark.parametrize("clearance", CLEARANCES)
def test_who_breathes_costs_as_many_frames_as_one_can_see(clearance: float) -> None:
    watch, sent = Standstill(), []
    for i in range(20 * RATE):
        x = 0.005 * float(np.sin(i / RATE))
        if watch.worth_sending(frame(i, x=x, clearance=clearance), i / RATE, restless=False):
            sent.append((i / RATE, x))
    late = [x for time, x in sent if time > 2.0]
    assert len(late) < 18 * 8
    assert max(abs(a - b) for a, b in pairwise(late)) < 1.5 * UNSEEN


def test_what_is_new_goes_out_at_once() -> None:
    watch = Standstill()
    for i in range(5 * RATE):
        watch.worth_sending(frame(i), i / RATE, restless=False)
    assert watch.worth_sending(frame(300, acknowledged=1), 5.0, restless=False)
    walking = [
        watch.worth_sending(frame(i, x=i * 0.01, acknowledged=1), i / RATE, restless=False) for i in range(301, 360)
    ]
    assert all(walking)


def test_where_something_else_moves_no_frame_is_left_out() -> None:
    watch = Standstill()
    assert all(watch.worth_sending(frame(i), i / RATE, restless=True) for i in range(5 * RATE))
