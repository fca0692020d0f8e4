"""What a command means for the root: a line of travel to keep to, a speed along it, or velocities to hold."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root_motion import RootMotionSettings

Floats = NDArray[np.float64]


class TravelLine(NamedTuple):
    """The straight line that a held command asks for; a way round leads back to it."""

    asked: tuple[float, ...]  # what the command says about the direction; the line lives while it stays the same
    x: float
    z: float
    heading: float  # direction of travel
    facing: float  # heading of the body
    turns: bool  # whether the body turns to where it goes

    def coordinates(self, x: float, z: float) -> tuple[float, float]:
        """Metres ahead and to the left of the line's first point."""
        sine, cosine = math.sin(self.heading), math.cos(self.heading)
        dx, dz = x - self.x, z - self.z
        return dx * sine + dz * cosine, dx * cosine - dz * sine

    def point(self, ahead: float, left: float = 0.0) -> tuple[float, float]:
        """The place on the ground with these coordinates."""
        sine, cosine = math.sin(self.heading), math.cos(self.heading)
        return self.x + ahead * sine + left * cosine, self.z + ahead * cosine - left * sine


def new_line(start: RootState, command: Command, motion: RootMotionSettings) -> TravelLine:
    """The line of travel that a command begins here."""
    asked = asked_direction(command)
    if command.direction is not None:
        return TravelLine(asked, start.x, start.z, command.direction, command.direction, True)
    facing = start.heading + 0.5 * start.turn * abs(start.turn) / motion.turn_acceleration  # where a turn comes to rest
    way = facing + math.atan2(command.strafe, command.forward)
    return TravelLine(asked, start.x, start.z, way, facing, command.forward > 0.0 and command.strafe == 0.0)


def asked_direction(command: Command) -> tuple[float, ...]:
    """What a command says about the direction of travel, speed aside."""
    if command.direction is not None:
        return (command.direction,)
    return (round(math.atan2(command.strafe, command.forward), 3), 0.0)


def wanted_speed(command: Command, motion: RootMotionSettings) -> float:
    """The wanted speed along the line of travel: the ellipse through forward, backward and sideways speeds."""
    ahead = motion.run_speed if command.run else motion.walk_speed
    if command.direction is not None:
        return ahead * min(max(command.forward, 0.0), 1.0)
    along = (ahead if command.forward > 0.0 else motion.back_speed) * min(max(command.forward, -1.0), 1.0)
    return math.hypot(along, motion.strafe_speed * min(max(command.strafe, -1.0), 1.0))


def wanted_velocities(command: Command, motion: RootMotionSettings) -> Floats:
    """Wanted velocities forward, to the left, and heading rate, of a command that turns."""
    ahead = motion.run_speed if command.run else motion.walk_speed
    along = ahead if command.forward > 0.0 else motion.back_speed
    wanted = np.array([command.forward, command.strafe, command.turn])
    velocities: Floats = np.clip(wanted, -1.0, 1.0) * np.array([along, motion.strafe_speed, motion.turn_rate])
    return velocities
