"""Who hears of every step of a walk."""

from collections.abc import Callable

from elbowroom.control.frame import Frame

Listener = Callable[[Frame, float], None]  # the frame of a step, and how many seconds it took
