"""Back the way one came: for who stays where he is in mid-stride, and whose legs do not come to a stand there.

And for who stands on steep treads or is on the way to a place, wants to go on, and has found no way from there for
long: it may be that none leads back either that begins standing.

All that was shown was free, and so was the way from each pose to the next: it is free the other way round too, as long
as nothing moves. Who dithers on the spot moves his arms alone: most of that is forgotten, and none of it is shown again
where arms can go straight from what is shown to the pose in which one came there.
"""

import math
from collections import deque
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL
from elbowroom.body.gait.carriage import POSING
from elbowroom.body.gait.foot_state import SWING
from elbowroom.body.root import FOOT, HEIGHT, RISES, ROOT_STATE, WITH_FEET
from elbowroom.control.key_frame_queue import Playback
from elbowroom.jit import brief_exact_kernel
from elbowroom.planning.stillness import SAME, SAME_TIME
from elbowroom.world.ground.ground import STEP

Floats = NDArray[np.float64]

_REMEMBERED = 10.0  # seconds that were shown
_PATIENCE = 0.5  # seconds in which legs come to a stand, where they can
_LONG, _ON_THE_WAY = 3.0, 1.2  # seconds in which a way is found, by who steers; by who is on the way to a place
_BACK = 0.4  # seconds that one goes back at first; each time that this was not enough twice as long
_STRIDING = 0.02  # m/s, rad/s: who is slower stands, or is about to, and trembles at most
_HERE = 0.005  # metres, radians: who has moved no farther is where he was
_ELSEWHERE = 0.5  # metres from where one has gone back from
_DITHERED = 1.0  # seconds on one spot that are remembered, besides the pose in which one came there
_POSED = np.r_[
    [0, 1, 2, HEIGHT],
    RISES : ROOT_STATE + SWING,
    ROOT_STATE + FOOT : ROOT_STATE + FOOT + SWING,
    WITH_FEET : WITH_FEET + POSING,
]  # of a root state as it is shown, what poses the body
_ARMS = 1.5  # rad/s, metres a second: how fast arms go straight to where they were
_AT_REST = np.zeros(LOCAL)  # the velocity of an upper body as it is remembered: it is shown again pose by pose


class Past(NamedTuple):
    """What was shown."""

    pose: Playback  # at rest where it is remembered
    seconds: float  # for how long
    joined: bool = True  # whether what is remembered next was shown next


class Retracing:
    """What one avatar has shown last, and how long it has been in mid-stride where it is."""

    def __init__(self) -> None:
        self._trail = deque[Past]()  # latest last
        self._length = 0.0  # seconds
        self._here, self._dithered = 0, 0.0  # how many of these were shown on the spot where one is, and for how long
        self._place, self._stays, self._waits = (math.inf, math.inf, 0.0), 0.0, 0.0
        self._left = self._spare = 0.0  # seconds to go back from here; how long what is shown was shown again
        self._from, self._times = (math.inf, math.inf), 0  # where one has gone back from, and how often

    @property
    def goes_back(self) -> bool:
        """Whether one is on the way back."""
        return self._left > 0.0

    def show(self, before: Past, shown: Playback) -> None:
        """After what was shown another pose is shown now, or the same."""
        seconds = before.seconds
        if _differ(before.pose, shown):
            self._remember(before)
        x, z, heading, *velocity = shown.root[:6].tolist()
        away = max(math.dist((x, z), self._place[:2]), abs(heading - self._place[2]))
        if away > _HERE:
            self._place, self._waits = (x, z, heading), 0.0
        in_stride = max(map(abs, velocity)) > _STRIDING
        self._stays = self._stays + seconds if in_stride and away <= _HERE else 0.0
        if self._stays > _PATIENCE:
            self._turn_back(x, z)

    def _remember(self, past: Past) -> None:
        """Remember what was shown; of who stays on the spot, how he came there and what he has shown last."""
        if self._here and not _stand_alike(self._trail[-self._here].pose, past.pose):
            self._here, self._dithered = 0, 0.0
        (root, upper, _), seconds, joined = past
        self._trail.append(Past(Playback(root, upper, _AT_REST), seconds, joined))
        self._length += seconds
        self._here, self._dithered = self._here + 1, self._dithered + seconds
        while self._dithered > _DITHERED and self._here > 2:
            arrival = len(self._trail) - self._here
            self._trail[arrival] = self._trail[arrival]._replace(joined=False)
            self._forget(arrival + 1)
        while self._length > _REMEMBERED:
            self._forget(0)

    def _forget(self, number: int) -> Past:
        """Forget one pose of the trail."""
        here = number >= len(self._trail) - self._here
        gone = self._trail[number]
        del self._trail[number]
        self._length -= gone.seconds
        if here:
            self._here, self._dithered = self._here - 1, self._dithered - gone.seconds
        return gone

    def wait(self, shown: Playback, seconds: float, *, on_the_way: bool) -> None:
        """There is no way on for who pushes; only where feet stand more than a step apart from the ground there.

        Anywhere for who is `on_the_way` to a place. Before a wall a user stands as long as he likes.
        """
        far = on_the_way or np.abs(shown.root[RISES:ROOT_STATE:2]).max() > STEP
        self._waits += seconds if far else 0.0
        if self._waits > (_ON_THE_WAY if on_the_way else _LONG):
            self._turn_back(float(shown.root[0]), float(shown.root[1]))

    def _turn_back(self, x: float, z: float) -> None:
        if math.dist((x, z), self._from) > _ELSEWHERE:
            self._from, self._times = (x, z), 0
        self._left, self._spare, self._stays, self._waits = _BACK * 2.0**self._times, 0.0, 0.0, 0.0
        self._times += self._left < _REMEMBERED
        self._end_where_it_ends()

    def before(self, dt: float) -> Past | None:
        """What was shown before what is shown, on the way back, for another `dt` seconds; None where that stays."""
        self._spare += dt
        due = self._trail and self._spare > self._trail[-1].seconds - SAME_TIME
        return self._trail[-1] if due else None

    def went(self) -> None:
        """One has gone back to what was shown `before`."""
        pose, seconds, _ = self._forget(len(self._trail) - 1)
        self._spare = max(self._spare - seconds, 0.0)
        x, z, heading = pose.root[:3].tolist()
        if max(math.dist((x, z), self._place[:2]), abs(heading - self._place[2])) > _HERE:
            self._left -= seconds
        self._end_where_it_ends()

    def arrival(self, shown: Playback, dt: float) -> Past | None:
        """The pose in which one came to the spot where one is; None where it is as soon shown by going back to it."""
        found, seconds = None, 0.0
        for past in reversed(self._trail):
            if not _stand_alike(past.pose, shown):
                break
            found, seconds = past, seconds + past.seconds
        if found is None or (seconds < 2.0 * dt * _steps(shown, found.pose, dt) and self._trail[-1].joined):
            return None
        return found

    def go_straight(self, shown: Playback, to: Past, dt: float) -> Past:
        """Remember arms that go straight to those of the `arrival`, in place of all between; what is next on this way.

        It begins with what is `shown`.
        """
        while self._trail[-1] is not to:
            self._forget(len(self._trail) - 1)
        self._forget(len(self._trail) - 1)
        steps = _steps(shown, to.pose, dt)
        for step in range(steps):
            part = step / steps
            root, upper = (old + part * (new - old) for old, new in zip(to.pose[:2], shown[:2], strict=True))
            self._trail.append(Past(Playback(root, upper, _AT_REST), dt))
            self._length += dt
        return self._trail[-1]

    def give_up(self) -> None:
        """There is no way back now."""
        self._left = self._stays = self._waits = 0.0

    def forget(self) -> None:
        """What was shown is no way back: it was not free, or something else stands there now."""
        self._trail.clear()
        self._length = self._left = self._dithered = 0.0
        self._here = 0

    def _end_where_it_ends(self) -> None:
        """Who has come to the end of what is remembered goes on as he likes."""
        if not self._trail:
            self.give_up()


@brief_exact_kernel
def _apart(one: Floats, other: Floats) -> float:
    """The most that two rows of numbers differ by."""
    most = 0.0
    for i in range(len(one)):
        most = max(most, abs(one[i] - other[i]))
    return most


@brief_exact_kernel
def _posed_apart(one: Floats, other: Floats) -> float:
    """The same of what poses the body in root states (SHOWN,)."""
    most = 0.0
    for i in _POSED:
        most = max(most, abs(one[i] - other[i]))
    return most


def _differ(one: Playback, other: Playback) -> bool:
    return _apart(one.root, other.root) > SAME or _apart(one.upper, other.upper) > SAME


def _stand_alike(one: Playback, other: Playback) -> bool:
    """Whether root, feet and what the hips carry are in the same place, whatever they are about to do."""
    return _posed_apart(one.root, other.root) < _HERE


def _steps(one: Playback, other: Playback, dt: float) -> int:
    """In how many steps of `dt` seconds arms go from one pose to another."""
    return max(math.ceil(_apart(one.upper, other.upper) / (_ARMS * dt)), 1)
