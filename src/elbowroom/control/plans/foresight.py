"""How far ahead to plan where plans take their time, and how fast to play where they are late."""

import math
from collections import deque
from enum import Enum

_LIKELY = 0.03  # seconds that a plan takes until one has been waited for
_SPARE = 0.02  # seconds
_REMEMBERED = 12  # plans in a hurry
_MOSTLY = 0.75  # of these are in time: who waits for the longest waits longer than who asks once more now and then
_BRAKING = 0.4  # seconds in which playback slows down to a stand, or comes back to its full speed


class Haste(Enum):
    """How soon a plan is wanted."""

    NONE = "none"  # the motion goes on meanwhile as the user wants it
    HURRY = "hurry"  # something else is wanted than what is played; coming too late costs more than being early
    AGAIN = "again"  # the last one in a hurry came too late


_FORGET = 0.7  # of what is expected without haste, with every quicker plan


class Foresight:
    """Learns how long plans take, in seconds of playback; knows nothing of clocks.

    A motion slowed down shows the same poses, so it is as free as it was planned: where no plan has come, playback
    slows down and stands before the motion ends.
    """

    def __init__(self, immediate: bool) -> None:
        self._immediate = immediate
        self._usual = _LIKELY  # seconds that a plan takes that nobody hurries
        self._hurried: deque[float] = deque([_LIKELY], maxlen=_REMEMBERED)  # seconds that the last ones took
        self.rate = 1.0  # of playback

    def lead(self, haste: Haste) -> float:
        """Seconds from now at which a plan that is asked for now should start."""
        if self._immediate:
            return 0.0
        if haste is Haste.NONE:
            return self._usual + _SPARE
        taken = sorted(self._hurried)
        return (taken[-1] if haste is Haste.AGAIN else taken[int(_MOSTLY * len(taken))]) + _SPARE

    def waited(self, seconds: float, haste: Haste) -> None:
        """A plan took so long; one without haste takes no less."""
        self._usual = max(seconds, _FORGET * self._usual)
        if haste is not Haste.NONE:
            self._hurried.append(seconds)

    def next_rate(self, left: float, dt: float, *, halting: bool) -> float:
        """The rate for the next `dt` seconds, of `left` seconds of motion; 0 where too little is left to move."""
        if self._immediate:
            return 1.0
        wanted = 0.0 if halting else 1.0
        slowest, fastest = self.rate - dt / _BRAKING, self.rate + dt / _BRAKING
        self.rate = min(max(wanted, slowest), fastest, _rate_to_stop_within(left, dt), 1.0)
        return self.rate


def _rate_to_stop_within(left: float, dt: float) -> float:
    """The fastest rate in the next `dt` seconds from which playback can still slow down to a stand within `left`.

    It plays rate dt, and then rate^2 T / 2 more while it slows down in a time T from full speed.
    """
    return max((math.sqrt(dt * dt + 2.0 * _BRAKING * max(left, 0.0)) - dt) / _BRAKING, 0.0)
