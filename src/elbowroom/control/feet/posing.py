"""How feet can follow one pose in one moment: each way is made when it is first asked for, and once."""

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.living import lively
from elbowroom.control.feet.feet import FeetMoment
from elbowroom.control.feet.following import STEPS, Followed, Gaps
from elbowroom.control.key_frame_queue import Playback

Floats = NDArray[np.float64]

_ASKED = 0.01  # metres: more room about legs is not told apart
NOT_AT_ALL = -1.0  # metres of room in which hips are where they were planned at once

Following = Callable[[FeetMoment, Playback, int], Followed]  # how a pose is followed in a moment, in one of the ways


class Posing:
    """A pose that is to be shown in a moment, and what is known of how feet follow it."""

    def __init__(self, moment: FeetMoment, posed: Playback, following: Following) -> None:
        self.moment, self.posed = moment, posed
        self._following = following
        self._made: dict[int, Followed] = {}

    def made(self, how: int) -> Followed:
        """The pose on feet that follow in one of the ways."""
        if how not in self._made:
            self._made[how] = self._following(self.moment, self.posed, how)
        return self._made[how]

    @cached_property
    def on_planned_hips(self) -> "Posing":
        """The same pose with hips where they were planned; the very same, where nothing lives."""
        if not lively(self.made(STEPS).root):
            return self
        return Posing(self.moment._replace(room=NOT_AT_ALL), self.posed, self._following)

    def room(self, rows: Floats) -> float:
        """Metres from the legs to what stands along root states (N, WITH_FEET), but for the ground under them."""
        return self.moment.room_along(rows, self.posed.upper, _ASKED)

    def gaps(self, pose: Playback) -> Gaps | None:
        """How much nearer arms may come to legs in a pose, if it is one that was made, arms as they were."""
        same = (each.gaps for each in self._made.values() if each.root is pose.root)
        return next(same, None) if pose.upper is self.posed.upper else None
