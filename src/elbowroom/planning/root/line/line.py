"""What a command means for the root: a line of travel to keep to, a speed along it, or velocities to hold."""

import math
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.jit import exact_kernel
from elbowroom.planning.command import BENT, Command
from elbowroom.planning.root.settings import RootMotionSettings

Floats = NDArray[np.float64]
Number = TypeVar("Number", float, Floats)

_BESIDE = 1.0  # metres: lines that begin no farther apart may be alike
_SOON, _SLANT = 0.6, 1.5  # metres ahead, and for each metre beside it, after which a route comes to the line
_PARALLEL = math.radians(2.0)
ON_THE_LINE = 0.0  # metres beside it


class TravelLine(NamedTuple):
    """The straight line that a held command asks for; a detour leads back to it."""

    asked: tuple[float, float]  # what the command says about the direction; the line lives while it stays the same
    x: float
    z: float
    heading: float  # direction of travel
    facing: float  # heading of the body
    turns: bool  # whether the body turns to where it goes, or its back, as it faces on the line

    def is_like(self, other: "TravelLine") -> bool:
        """Whether another leads in much the same direction, from much the same place."""
        return self.leads_like(other) and math.dist((self.x, self.z), (other.x, other.z)) < _BESIDE

    def leads_like(self, other: "TravelLine") -> bool:
        """Whether another leads in much the same direction."""
        bent = abs(math.remainder(other.heading - self.heading, math.tau))
        bent = max(bent, abs(math.remainder(other.facing - self.facing, math.tau))) if self.turns else bent
        return self.turns == other.turns and bent < BENT

    def is_parallel(self, other: "TravelLine") -> bool:
        """Whether both lead in the same direction, for a walker."""
        return abs(math.remainder(other.heading - self.heading, math.tau)) < _PARALLEL

    def coordinates(self, x: Number, z: Number) -> tuple[Number, Number]:
        """Metres ahead and to the left of the line's first point, of one place or of many."""
        sine, cosine = math.sin(self.heading), math.cos(self.heading)
        dx, dz = x - self.x, z - self.z
        return dx * sine + dz * cosine, dx * cosine - dz * sine

    def point(self, ahead: Number, left: Number) -> tuple[Number, Number]:
        """The place on the ground with these coordinates, or the places."""
        sine, cosine = math.sin(self.heading), math.cos(self.heading)
        return self.x + ahead * sine + left * cosine, self.z + ahead * cosine - left * sine


def new_line(start: RootState, command: Command, motion: RootMotionSettings) -> TravelLine:
    """The line of travel that a command begins here."""
    asked, x, z = asked_direction(command), float(start.x), float(start.z)
    if command.direction is not None:
        heading = float(command.direction)
        return TravelLine(asked, x, z, heading, faced(heading, command), True)
    facing = start.heading + 0.5 * start.turn * abs(start.turn) / motion.turn_acceleration  # where a turn comes to rest
    going = facing + math.atan2(command.strafe, command.forward)
    return TravelLine(asked, x, z, going, facing, command.straight)


def faced(heading: float, command: Command) -> float:
    """Where one faces who walks in a direction in the world as a command says: there, or backwards."""
    return heading + math.pi if command.forward < 0.0 else heading


def asked_direction(command: Command) -> tuple[float, float]:
    """What a command says about the direction, speed aside: radians in the world and 1, or milliradians aside and 0.

    Backwards in the world it is -1.
    """
    if command.direction is not None:
        return float(command.direction), -1.0 if command.forward < 0.0 else 1.0
    return float(round(1e3 * math.atan2(command.strafe, command.forward))), 0.0


@exact_kernel
def joining(left: float) -> float:
    """Metres along a line after which a route comes to it from a place so many metres to its left."""
    return max(_SOON, _SLANT * abs(left))


@exact_kernel
def straight_route(x: float, z: float, line: TravelLine, sight: float) -> Floats:
    """The corner points (3, 2), x and z, of a route from a place to a line of travel and along it, to the end of sight.

    It comes to the line at 34 degrees, and nowhere nearer than 0.6 m.
    """
    sine, cosine = np.sin(line.heading), np.cos(line.heading)
    dx, dz = x - line.x, z - line.z
    ahead, left = dx * sine + dz * cosine, dx * cosine - dz * sine
    back = ahead + joining(left)
    end = max(ahead + sight, back + 0.1)
    route = np.empty((3, 2))
    route[0, 0], route[0, 1] = x, z
    route[1, 0], route[1, 1] = line.x + back * sine, line.z + back * cosine
    route[2, 0], route[2, 1] = line.x + end * sine, line.z + end * cosine
    return route


def wanted_speed(command: Command, motion: RootMotionSettings) -> float:
    """The wanted speed along the line of travel: the ellipse through forward, backward and sideways speeds."""
    ahead = motion.run_speed if command.run else motion.walk_speed
    along = (ahead if command.forward > 0.0 else motion.back_speed) * min(max(command.forward, -1.0), 1.0)
    if command.direction is not None:
        return abs(along)
    return math.hypot(along, motion.strafe_speed * min(max(command.strafe, -1.0), 1.0))


def wanted_velocities(command: Command, motion: RootMotionSettings) -> Floats:
    """Wanted velocities forward, to the left, and heading rate, of a command that turns."""
    ahead = motion.run_speed if command.run else motion.walk_speed
    along = ahead if command.forward > 0.0 else motion.back_speed
    wanted = np.array([command.forward, command.strafe, command.turn])
    velocities: Floats = np.clip(wanted, -1.0, 1.0) * np.array([along, motion.strafe_speed, motion.turn_rate])
    return velocities
