"""The avatar held in a pose: place and limbs stay, and the legs come to a stand, where that touches nothing."""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.key_frame_queue import Playback
from elbowroom.planning.stillness import is_still

Floats = NDArray[np.float64]

_SETTLE = 0.06  # seconds: time constant with which the legs come to a stand, or lead over to the next motion
_STILL = 0.02  # m/s and rad/s: slower is standing


class Holding:
    """Whether the avatar is held, and what is left of the stride in which its legs were held.

    The stride follows from the root's velocity. A motion that begins where the avatar was held begins at rest; so that
    the legs do not jump, what they had is added to its velocity and fades: the stance (3,).
    """

    def __init__(self) -> None:
        self.active = False
        self.stance = np.zeros(3)

    def settle(self, shown: Playback, dt: float) -> Playback:
        """The pose that is shown, `dt` seconds later: the legs a little nearer to standing."""
        root = shown.root.copy()
        root[3:6] = _faded(root[3:6], dt)
        return Playback(root, shown.upper, np.zeros_like(shown.upper))

    def start(self, shown: Playback) -> Playback:
        """What a motion starts from: without the stance; at rest where the avatar is held."""
        if self.active:
            self.stance = shown.root[3:6].copy()
        root = shown.root.copy()
        root[3:6] -= self.stance
        return shown._replace(root=root)

    def over(self, played: Playback, dt: float) -> list[tuple[Playback, Floats]]:
        """How a motion can be shown, best first, and the stance that is left: less; all of it, where that touches."""
        if is_still(self.stance):
            return [(played, self.stance)]
        return [(_in_stance(played, stance), stance) for stance in (_faded(self.stance, dt), self.stance)]

    def end(self, stance: Floats) -> None:
        """The motion goes on, with what is left of the stance."""
        self.active, self.stance = False, stance


def _faded(velocity: Floats, dt: float) -> Floats:
    faded: Floats = velocity * math.exp(-dt / _SETTLE)
    faded[np.abs(faded) < _STILL] = 0.0
    return faded


def _in_stance(playback: Playback, stance: Floats) -> Playback:
    root = playback.root.copy()
    root[3:6] += stance
    return playback._replace(root=root)
