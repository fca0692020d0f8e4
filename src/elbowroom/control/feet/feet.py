"""What the controller asks of feet, whatever they stand on."""

from collections.abc import Callable, Iterable, Iterator, Sequence
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


class Look(Protocol):
    """How what is about a body is asked for."""

    def __call__(self, root: Floats, upper: Floats, axes: Floats32 | None = None) -> Around:
        """About a root with feet and an upper body, with their `axes` (C, 6, 1) where these are known."""
        ...


RoomAlong = Callable[[Floats, Floats], float]  # metres from legs to what stands: roots with feet (N, WITH_FEET), upper


class Moment(NamedTuple):
    """What is known when feet follow."""

    shown: Playback  # what is shown
    dt: float  # seconds from that to what comes next
    ahead: Floats  # (m, 8) seconds from now and root states that the root is to come to
    room: float  # metres about the whole body as it is shown; negative where that is not looked at
    look: Look
    room_along: RoomAlong


class Feet(Protocol):
    """How one avatar's feet follow what is played; frozen, their state is in the root states that are shown."""

    def standing(self, root: Floats) -> Floats:
        """A root state (ROOT_STATE,) as it is shown standing."""
        ...

    def are_still(self, before: Floats, shown: Floats) -> bool:
        """Whether feet that are shown in a root state, after another, stay as they are while the root rests."""
        ...

    def next(self, moment: Moment, posed: Playback) -> Playback:
        """How a pose is shown next, if that is free."""
        ...

    def under(self, moment: Moment, played: Sequence[tuple[Playback, Floats]]) -> Iterator[tuple[Playback, Floats]]:
        """Poses that could be shown next, each with its stance (3,): best first."""
        ...

    def settling(self, moment: Moment, held: Playback) -> Iterable[Playback]:
        """How a pose that is held could be shown next, as legs come to a stand: best first."""
        ...

    def resting(self, moment: Moment) -> Playback:
        """What who rests may show next: what is shown, if nothing lives."""
        ...
