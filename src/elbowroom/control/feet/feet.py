"""What feet go by as they follow what is played."""

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.key_frame_queue import Playback

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]


class Around(NamedTuple):
    """What is about a body."""

    room: float  # metres from the legs to the nearest obstacle
    lasts: bool  # whether all of it stands and can only stand


class LookAbout(Protocol):
    """How what is about a body is asked for."""

    def __call__(self, root: Floats, upper: Floats, axes: Floats32 | None = None) -> Around:
        """About a root with feet and an upper body, with their `axes` (C, 6, 1) where these are known."""
        ...


# Metres from legs to what stands, no more than some: roots with feet (N, WITH_FEET), upper body, and these.
RoomAlong = Callable[[Floats, Floats, float], float]
RoomAbove = Callable[[Floats, Floats], float]  # metres from all that legs carry to what stands: a root with feet, upper


class FeetMoment(NamedTuple):
    """What is known when feet follow."""

    shown: Playback  # what is shown
    meant: Floats  # (LOCAL,) the upper body that was planned for it
    dt: float  # seconds from that to what comes next
    ahead: Floats  # (m, 8) seconds from now and root states that the root is to come to
    room: float  # metres about the whole body as it is shown; negative where that is not looked at
    look: LookAbout
    room_along: RoomAlong
    room_above: RoomAbove
