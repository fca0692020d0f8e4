"""A user who walks forward, and when stuck backs up a little and tries again (paper, section 6.1)."""

from collections.abc import Callable

import numpy as np

from elbowroom.body.root import RootState
from elbowroom.planning.command import Command

User = Callable[[RootState, bool, float], Command]  # the command for so many seconds, where the avatar is, stuck or not

FORWARD = Command(forward=1.0)
BACK = Command(forward=-1.0)
_NOTICES = 0.3  # seconds until the user notices that the avatar is stuck
_BACKS_UP = (0.4, 0.9)  # seconds, drawn for each try


class ScriptedUser:
    """Decides on the next command from what the last frame showed."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng
        self._stuck_for = 0.0  # seconds
        self._back_for = 0.0  # seconds still to back up

    def command(self, stuck: bool, dt: float) -> Command:
        """The command for the next `dt` seconds; `stuck` is what the last frame said."""
        if self._back_for > 0.0:
            self._back_for -= dt
            return BACK
        self._stuck_for = self._stuck_for + dt if stuck else 0.0
        if self._stuck_for > _NOTICES:
            self._stuck_for = 0.0
            self._back_for = self._rng.uniform(*_BACKS_UP)
        return FORWARD
