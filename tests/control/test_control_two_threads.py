"""Playback and planning may ask one check at once, each in its thread: both get the answers that they get alone."""

import sys
from types import FrameType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.plans.canned import standing_posture
from elbowroom.control.shown import body_check
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

AVATAR, SCENE = Humanoid.default(), Scene.load("d")
UPPER = standing_posture(RootState().as_array())


def line_of_places(x: float) -> list[Floats]:
    return [RootState(x, z).as_array() for z in np.linspace(0.0, 4.0, 12)]


def answers(check: BodyCheck, roots: list[Floats]) -> list[float]:
    """The clearances of who stands at each root state, and at the first once more."""
    return [check.clearance(root, UPPER, 0.0) for root in (*roots, roots[0])]


def test_what_another_asks_between_any_two_lines_changes_no_answer() -> None:
    mine, theirs = line_of_places(0.0), line_of_places(1.0)
    alone, check, asked = answers(BodyCheck(AVATAR, SCENE), mine), BodyCheck(AVATAR, SCENE), 0

    def at_line(frame: FrameType, event: str, argument: Any) -> Any:
        nonlocal asked
        del argument
        if frame.f_code.co_filename != body_check.__file__:
            return None
        if event == "line":
            sys.settrace(None)
            check.clearance(theirs[asked % len(theirs)], UPPER, 0.0)
            asked += 1
            sys.settrace(at_line)
        return at_line

    before = sys.gettrace()
    sys.settrace(at_line)
    try:
        interrupted = answers(check, mine)
    finally:
        sys.settrace(before)
    assert interrupted == alone
    assert asked > len(mine)
