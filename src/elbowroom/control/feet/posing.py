"""How feet can follow one pose in one moment: each way is made when it is first asked for, and once."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.feet.feet import Moment
from elbowroom.control.feet.following import Followed
from elbowroom.control.key_frame_queue import Playback

Floats32 = NDArray[np.float32]

Following = Callable[[Moment, Playback, int], Followed]  # how a pose is followed in a moment, in one of the ways


class Posing:
    """A pose that is to be shown in a moment, and what is known of how feet follow it."""

    def __init__(self, moment: Moment, posed: Playback, following: Following) -> None:
        self.moment, self.posed = moment, posed
        self._following, self._made = following, dict[int, Followed]()

    def made(self, how: int) -> Followed:
        """The pose on feet that follow in one of the ways."""
        if how not in self._made:
            self._made[how] = self._following(self.moment, self.posed, how)
        return self._made[how]

    def gaps(self, pose: Playback) -> Floats32 | None:
        """How much nearer arms may come to legs in a pose (2, 1), if it is one that was made, arms as they were."""
        same = (each.gaps for each in self._made.values() if each.root is pose.root)
        return next(same, None) if pose.upper is self.posed.upper else None
