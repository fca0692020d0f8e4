"""How far ahead to plan where plans take their time, and how fast to play where they are late."""

import math
from enum import Enum

_LIKELY = 0.03  # seconds that a plan takes until one has been waited for
_SPARE = 0.02  # seconds
_BRAKING = 0.4  # seconds in which playback slows down to a stand, or comes back to its full speed


class Haste(Enum):
    """How soon a plan is wanted."""

    NONE = "none"  # the motion goes on meanwhile as the user wants it
    HURRY = "hurry"  # something else is wanted than what is played; coming too late costs more than being early
    AGAIN = "again"  # the last one in a hurry came too late; what it found out is known


_FORGET = {Haste.NONE: 0.7, Haste.HURRY: 0.92, Haste.AGAIN: 0.92}  # of what is expected, with every quicker plan
_LEAST = {Haste.NONE: 0.0, Haste.HURRY: _LIKELY, Haste.AGAIN: _LIKELY}  # seconds that are always expected


class Foresight:
    """Learns how long plans take, in seconds of playback; knows nothing of clocks.

    A motion slowed down shows the same poses, so it is as free as it was planned: where no plan has come, playback
    slows down and stands before the motion ends.
    """

    def __init__(self, immediate: bool) -> None:
        self._immediate = immediate
        self._expected = dict.fromkeys(Haste, _LIKELY)
        self.rate = 1.0  # of playback

    def lead(self, haste: Haste) -> float:
        """Seconds from now at which a plan that is asked for now should start."""
        return 0.0 if self._immediate else self._expected[haste] + _SPARE

    def waited(self, seconds: float, haste: Haste) -> None:
        """A plan took so long; one without haste takes no less."""
        self._expected[haste] = max(seconds, _FORGET[haste] * self._expected[haste], _LEAST[haste])
        self._expected[Haste.NONE] = max(seconds, self._expected[Haste.NONE])

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
