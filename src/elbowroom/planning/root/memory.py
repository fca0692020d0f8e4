"""What the root planner remembers: the line of travel, where the last path led, and how it left the line."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root.evasion.profile import Profile
from elbowroom.planning.root.line.line import TravelLine, asked_direction, new_line
from elbowroom.planning.root.line.way_ahead import Corners, leg_at
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.planning.root.way_out import WayOut

Floats = NDArray[np.float64]

_TURNED = 0.05  # radians
_PULLED_BACK = math.radians(50.0)  # who is led round something and turns no farther back to the line means the same
_BACK_AFTER = 0.3  # metres: who would be on the line before that wants beyond it
_NEAR = 0.5  # metres: who is farther away than this does not go on from a path


class Evading(NamedTuple):
    """An evasion that is being followed."""

    profile: Profile
    line: TravelLine  # that it leads from
    along: TravelLine  # that the profile belongs to: the same line, or the axis of a gap
    share: float  # of the usual speed, sideways
    whole: bool  # whether it leads past all that was in sight

    def is_meant(self, start: RootState, line: TravelLine) -> bool:
        """Whether who is on it and wants to go along a line still means it: a hand that steers is never still."""
        ahead, left = self.along.coordinates(start.x, start.z)
        at = (ahead - self.profile.first) / self.profile.step
        own = np.interp(at, np.arange(len(self.profile.rows)), self.profile.rows[:, 0])
        return abs(left - float(own)) < _NEAR and self.line.leads_like(line)


class RootMemory(NamedTuple):
    """What is known of the plans before; nothing at first."""

    line: TravelLine | None = None  # of the command that is being held
    last: Floats | None = None  # (n+1, 7) states of the last path
    evading: Evading | None = None
    way_out: WayOut | None = None  # the last one along the line
    aside: bool = False  # whether the last path leaves the line, to get past what stands on it
    way: Corners = ()  # that the command which is being held leads along
    leg: int = 0  # the number of the leg that was reached

    def leg_of(self, way: Corners, start: RootState) -> int:
        """The number of the leg of a way on which a start is."""
        return leg_at(way, start.x, start.z, self.leg if way == self.way else 0)

    def travel_line(self, start: RootState, command: Command, motion: RootMotionSettings, widest: float) -> TravelLine:
        """The line that is being followed, or a new one from here if the command or the place has changed.

        Who is led aside, past what stands on it, and pulls back is led on: else he would be sent to and fro.
        `widest` is the breadth in metres of a detour. Who was turned aside by an evasion still means the way that it
        led from.
        """
        line = self.line
        if line is not None and self._continues(start, line, widest) and self._is_meant(start, line, command):
            return line
        if self.evading is not None and command.direction is None and self.still_turned(start, widest):
            start = start._replace(heading=self.evading.line.facing, turn=0.0)
        return new_line(start, command, motion)

    def _is_meant(self, start: RootState, line: TravelLine, command: Command) -> bool:
        """Whether a command asks for a line, or is only turned back to it on the way past what stands there."""
        return line.asked == asked_direction(command) or (self.aside and _pulls_back(start, line, command))

    def still_turned(self, start: RootState, widest: float) -> bool:
        """Whether the body is turned away from where the user means it to face."""
        if self.evading is None or not self._continues(start, self.evading.line, widest):
            return False
        return abs(math.remainder(start.heading - self.evading.line.facing, math.tau)) > _TURNED

    def _continues(self, start: RootState, line: TravelLine, widest: float) -> bool:
        """Whether a start goes on from the last path, within the breadth of a detour."""
        if self.last is None or abs(line.coordinates(start.x, start.z)[1]) >= widest:
            return False
        places = self.last[:, :2].tolist()
        return any(math.hypot(x - start.x, z - start.z) < _NEAR for x, z in places)


def _pulls_back(start: RootState, line: TravelLine, command: Command) -> bool:
    """Whether a command turns who is beside a line a little towards it, to come to it not at once."""
    if command.direction is None or not line.turns or (command.forward < 0.0) is not (line.asked[1] < 0.0):
        return False
    left = line.coordinates(start.x, start.z)[1]
    bent = math.remainder(command.direction - line.heading, math.tau)
    back = abs(bent) < _PULLED_BACK and bent * left < 0.0
    return back and _BACK_AFTER * math.tan(abs(bent)) < abs(left)
