"""What is shown, among things that say themselves how near they are."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from elbowroom.body.dof import LOCAL
from elbowroom.body.root import SHOWN
from elbowroom.control.key_frame_queue import Playback
from elbowroom.control.shown.showing import Showing

DT = 1 / 60


def pose(arms: float, along: float = 0.0, speed: float = 0.0) -> Playback:
    """All of the upper body alike, a place, and a speed."""
    root = np.zeros(SHOWN)
    root[1], root[3] = along, speed
    return Playback(root, np.full(LOCAL, arms), np.zeros(LOCAL))


def showing(shown: Playback, *, straight: bool = True) -> Showing:
    """It shows a pose, and anything else is free; so is the `straight` way between any two."""
    check: Any = SimpleNamespace(
        footing=SimpleNamespace(plain=True),
        restless=False,
        accompanied=False,
        standing=lambda root: root,
        clearance=lambda *_: 1.0,
        shown_clearance=lambda *_: 1.0,
        leaves_room=lambda _: True,
        free_between=lambda _: straight,
        between=lambda _: None,
    )
    own_body = SimpleNamespace(free_between=lambda *_: True)
    around: Any = SimpleNamespace(check=check, own_body=own_body, feet=SimpleNamespace(standing=lambda root: root))
    made = Showing(around, np.zeros(SHOWN), assist=True)
    made._show(shown, 1.0)
    return made


def gone_back(straight: bool) -> list[Playback]:
    """Who came, has dithered on the spot for 5 s, and finds no way on: what he shows on the way back."""
    made, now = showing(pose(0.0, 0.0, 0.6), straight=straight), 0.0
    came = [pose(0.0, 0.6 * DT * k, 0.6) for k in range(1, 60)]
    spot = [pose(0.1 + 0.1 * np.sin(0.1 * k) + 1e-3 * np.sin(k), came[-1].root[1]) for k in range(300)]
    for each in (*came, pose(0.0, came[-1].root[1]), *spot):
        now += DT
        made._now = now
        made._show(each, 1.0)
    for _ in range(80):
        made.wait(DT, on_the_way=True)
        if made.goes_back:
            break
    shown = [made.pose]
    while made.goes_back:
        now += DT
        made.hold(now, DT)
        shown.append(made.pose)
    return shown


def test_arms_go_straight_to_where_they_were_when_one_came() -> None:
    shown = gone_back(straight=True)
    arms, along = np.array([(each.upper[0], each.root[1]) for each in shown]).T
    assert np.abs(np.diff(arms)).max() <= 1.5 * DT + 1e-9
    assert along[0] - along[-1] == pytest.approx(0.6 * 0.4, abs=0.02)
    assert len(shown) * DT < 0.4 + 0.2 / 1.5 + 3 * DT


def test_where_they_cannot_one_stays_rather_than_to_show_what_is_not_proven() -> None:
    shown = gone_back(straight=False)
    assert np.ptp([each.root[1] for each in shown]) == 0.0
    assert 50 < len(shown) < 70, "the last second is gone back through"
