"""Back the way one came: for who stays where he is in mid-stride, and whose legs do not come to a stand there.

And for who stands on steep treads or is on the way to a place, wants to go on, and has found no way from there for
long: it may be that none leads back either that begins standing.

All that was shown was free, and so was the way from each pose to the next: it is free the other way round too, as long
as nothing moves.
"""

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from elbowroom.body.root import RISES, ROOT_STATE, SHOWN
from elbowroom.control.key_frame_queue import Playback
from elbowroom.planning.stillness import SAME, SAME_TIME, is_still
from elbowroom.world.ground.ground import STEP

_REMEMBERED = 5.0  # seconds that were shown
_PATIENCE, _LONG = 0.5, 3.0  # seconds in which legs come to a stand, where they can; in which a way is found
_BACK = 0.4  # seconds that one goes back at first; each time that this was not enough as much more
_HERE = 0.005  # metres, radians: who has moved no farther is where he was
_ALIKE, _EACH = 1e-4, 8  # metres, radians: poses that are taken for one; poses until it is looked for one again
_ELSEWHERE = 0.5  # metres from where one has gone back from


class Past(NamedTuple):
    """What was shown."""

    pose: Playback
    clearance: float  # metres
    seconds: float  # for how long


class Retracing:
    """What one avatar has shown last, and how long it has been in mid-stride where it is."""

    def __init__(self) -> None:
        self._trail = deque[Past]()  # latest last
        self._length = 0.0  # seconds
        self._place, self._stays, self._waits = (math.inf, math.inf, 0.0), 0.0, 0.0
        self._left = self._spare = 0.0  # seconds to go back from here; how long what is shown was shown again
        self._from, self._times = (math.inf, math.inf), 0  # where one has gone back from, and how often

    @property
    def goes_back(self) -> bool:
        """Whether one is on the way back."""
        return self._left > 0.0 and bool(self._trail)

    def show(self, before: Past, shown: Playback) -> None:
        """After what was shown another pose is shown now, or the same."""
        seconds = before.seconds
        if _differ(before.pose, shown):
            self._trail.append(before)
            self._length += seconds
            while self._length > _REMEMBERED:
                self._length -= self._trail.popleft().seconds
        x, z, heading = shown.root[:3].tolist()
        away = max(math.dist((x, z), self._place[:2]), abs(heading - self._place[2]))
        if away > _HERE:
            self._place, self._waits = (x, z, heading), 0.0
        else:
            self._cut_loop(shown)
        self._stays = 0.0 if away > _HERE or is_still(shown.root[3:6]) else self._stays + seconds
        if self._stays > _PATIENCE:
            self._turn_back(x, z)

    def _cut_loop(self, shown: Playback) -> None:
        """Forget what led from a pose to the same again: who dithers on the spot has got nowhere, and came otherwise.

        It is looked for now and then; the last number of a root tells how long ago it began to breathe.
        """
        if not self._trail or len(self._trail) % _EACH > 0:
            return
        roots = np.array([past.pose.root for past in self._trail])[:, : SHOWN - 1]
        uppers = np.array([past.pose.upper for past in self._trail])
        apart = np.abs(roots - shown.root[: SHOWN - 1]).max(axis=1), np.abs(uppers - shown.upper).max(axis=1)
        alike = np.flatnonzero(np.maximum(*apart) < _ALIKE)
        while len(alike) and len(self._trail) > alike[0]:
            self._length -= self._trail.pop().seconds

    def wait(self, shown: Playback, seconds: float, *, on_the_way: bool) -> None:
        """There is no way on for who pushes; only where feet stand more than a step apart from the ground there.

        Anywhere for who is `on_the_way` to a place. Before a wall a user stands as long as he likes.
        """
        far = on_the_way or np.abs(shown.root[RISES:ROOT_STATE:2]).max() > STEP
        self._waits += seconds if far else 0.0
        if self._waits > _LONG:
            self._turn_back(float(shown.root[0]), float(shown.root[1]))

    def _turn_back(self, x: float, z: float) -> None:
        if math.dist((x, z), self._from) > _ELSEWHERE:
            self._from, self._times = (x, z), 0
        self._times += 1
        self._left, self._spare, self._stays, self._waits = _BACK * self._times, 0.0, 0.0, 0.0

    def before(self, dt: float) -> Past | None:
        """What was shown before what is shown, on the way back, for another `dt` seconds; None where that stays."""
        self._spare += dt
        due = self._trail and self._spare > self._trail[-1].seconds - SAME_TIME
        return self._trail[-1] if due else None

    def went(self) -> None:
        """One has gone back to what was shown `before`."""
        pose, _, seconds = self._trail.pop()
        self._length, self._spare = self._length - seconds, max(self._spare - seconds, 0.0)
        x, z, heading = pose.root[:3].tolist()
        if max(math.dist((x, z), self._place[:2]), abs(heading - self._place[2])) > _HERE:
            self._left -= seconds

    def give_up(self) -> None:
        """There is no way back now."""
        self._left = self._stays = self._waits = 0.0

    def forget(self) -> None:
        """What was shown is no way back: it was not free, or something else stands there now."""
        self._trail.clear()
        self._length = self._left = 0.0


def _differ(one: Playback, other: Playback) -> bool:
    both = zip(one[:2], other[:2], strict=True)
    return any(np.abs(before - after).max() > SAME for before, after in both)
