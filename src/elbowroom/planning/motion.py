"""A root path and the upper-body motion on it: what control asks for, and who answers.

The paper's planners dress the root path that they are given. A planner may also choose the path itself, look farther
ahead than the queue holds, and choose how the curve passes its key frames: then it is a `MotionPlanner`.
"""

from collections.abc import Callable
from typing import NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.result import LocalPlan
from elbowroom.planning.root.plan import RootPlan
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.world.obstacles.tracks.moving import Moving

Floats = NDArray[np.float64]


class SupersededError(Exception):
    """Nobody waits for the motion any more."""


GoOn = Callable[[], None]  # called now and then in a search; raises `SupersededError` to call it off


def keep_going() -> None:
    """Nobody calls the search off."""


def _wanted() -> bool:
    return False


class MotionQuery(NamedTuple):
    """What to plan for."""

    time: float  # seconds, of the first key frame
    root: RootState  # there
    upper: Floats  # (LOCAL,) there, radians
    velocity: Floats  # (LOCAL,) of the upper body there, rad/s
    command: Command
    horizon: int  # key frames that the queue holds
    interval: float  # seconds between key frames
    others: Moving = Moving()  # that move, besides the scene's own
    hurry: bool = False  # something else is wanted than what is played: what is found soon, better later
    superseded: Callable[[], bool] = _wanted  # whether nobody waits for the motion any more

    def go_on(self) -> None:
        """Called now and then while planning: raises `SupersededError` if nobody waits for the motion any more."""
        if self.superseded():
            raise SupersededError


class Motion(NamedTuple):
    """What was planned."""

    root: RootPlan
    local: LocalPlan


@runtime_checkable
class MotionPlanner(Protocol):
    """Plans the root path together with the upper body."""

    def plan_motion(self, root_planner: RootPlanner, query: MotionQuery) -> Motion:
        """Motion of at most `query.horizon` key intervals."""
