"""How far ahead to plan where plans take their time, and how fast to play where they are late."""

import math

_LIKELY = 0.03  # seconds that a plan takes until one has been waited for
_SPARE = 0.02  # seconds
_FORGET = 0.7  # of what is expected, with every plan that was quicker
_BRAKING = 0.4  # seconds in which playback slows down to a stand, or comes back to its full speed


class Foresight:
    """Learns how long plans take, in seconds of playback; knows nothing of clocks.

    A motion slowed down shows the same poses, so it is as free as it was planned: where no plan has come, playback
    slows down and stands before the motion ends.
    """

    def __init__(self, immediate: bool) -> None:
        self._immediate = immediate
        self._expected = {False: _LIKELY, True: _LIKELY}  # by whether they are in a hurry
        self.rate = 1.0  # of playback

    def lead(self, *, hurry: bool) -> float:
        """Seconds from now at which a plan that is asked for now should start."""
        return 0.0 if self._immediate else self._expected[hurry] + _SPARE

    def waited(self, seconds: float, *, hurry: bool) -> None:
        """A plan took so long."""
        self._expected[hurry] = max(seconds, _FORGET * self._expected[hurry])

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
