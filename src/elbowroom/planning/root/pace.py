"""How fast a command means to go."""

from dataclasses import replace
from functools import lru_cache

from elbowroom.planning.command import Command
from elbowroom.planning.root.settings import RootMotionSettings

_MOTION = RootMotionSettings()


@lru_cache(maxsize=256)  # a command is held for many frames
def at_speed(command: Command, walk_speed: float) -> Command:
    """The command that makes the root planner, which has speeds of its own, walk at `walk_speed` m/s or run faster."""
    factor = walk_speed * (_MOTION.run_speed / _MOTION.walk_speed if command.run else 1.0)
    speed = max(command.forward, 0.0) * factor
    share = min(factor / _MOTION.walk_speed, 1.0)  # of what goes back and sideways
    runs = speed > _MOTION.walk_speed
    ahead = min(speed / (_MOTION.run_speed if runs else _MOTION.walk_speed), 1.0)
    forward = ahead if command.forward > 0.0 else command.forward * share
    return replace(command, forward=forward, strafe=command.strafe * share, run=runs)
