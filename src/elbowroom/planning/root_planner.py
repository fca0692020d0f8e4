"""From a command to a short, collision-free root path for what cannot bend: the legs and the pelvis.

Straight where the way is free, round the obstacle where it is not, a stop before it where there is no way. The upper
body is not looked at: what only it would touch diverts nobody.

A path is accepted if the posed legs and the pelvis are free at dense samples of exactly the motion that playback will
show, and if from each of its key frames a stop would be free too. So the next plan always has a way out: to brake.
"""

import time

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root_body import LowerBody
from elbowroom.planning.root_line import TravelLine, asked_direction, new_line, wanted_speed, wanted_velocities
from elbowroom.planning.root_motion import MotionBounds
from elbowroom.planning.root_path import RootPath
from elbowroom.planning.root_plan import RootPlan, RootPlanKind, RootPlannerSettings
from elbowroom.planning.root_query import RootQuery
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]


class RootPlanner:
    """Plans root paths for one humanoid in one scene.

    It remembers one thing between plans: the line of travel of the command that is being held, and where the last path
    led. `reset` forgets it; a start that does not continue the last path does so too.
    """

    def __init__(self, humanoid: Humanoid, scene: Scene, settings: RootPlannerSettings | None = None) -> None:
        self.settings = settings or RootPlannerSettings()
        self.body = LowerBody(humanoid, scene.boxes)
        motion = self.settings.motion
        self.bounds = MotionBounds(motion.turn_rate, motion.acceleration, motion.braking, motion.turn_acceleration)
        self._line: TravelLine | None = None
        self._last: Floats | None = None

    def reset(self) -> None:
        """Forget the line of travel."""
        self._line = self._last = None

    def plan(
        self,
        start: RootState,
        command: Command,
        horizon: int,
        interval: float,
        start_time: float = 0.0,
        pace: float = 1.0,
    ) -> RootPlan:
        """A path of `horizon` key intervals of `interval` seconds that starts exactly in the state `start`.

        It is walked at the share `pace`, above 0 and up to 1, of the speed that the command asks for.
        """
        began = time.perf_counter_ns()
        query = RootQuery(self.settings, self.body, self.bounds, start, horizon, interval)
        if command.idle:
            self._line = None
            states, kind, goal = query.stop(), RootPlanKind.STRAIGHT, (start.x, start.z)
        elif command.turn != 0.0 and command.direction is None:
            self._line = None
            states, kind, goal = query.steered(pace * wanted_velocities(command, self.settings.motion))
        else:
            self._line = self._travel_line(start, command)
            states, kind, goal = query.travelled(self._line, pace * wanted_speed(command, self.settings.motion))
        self._last = states
        path = RootPath(start_time, interval, states)
        return RootPlan(path, kind, goal, query.checks, time.perf_counter_ns() - began)

    def _travel_line(self, start: RootState, command: Command) -> TravelLine:
        """The line that is being followed, or a new one from here if the command or the place has changed."""
        line, asked = self._line, asked_direction(command)
        if line is not None and line.asked == asked and self._continues(start, line):
            return line
        return new_line(start, command, self.settings.motion)

    def _continues(self, start: RootState, line: TravelLine) -> bool:
        """Whether a start goes on from the last path, within the breadth of a way round."""
        if self._last is None or abs(line.coordinates(start.x, start.z)[1]) >= self.settings.widest_detour:
            return False
        return bool(np.min(np.hypot(self._last[:, 0] - start.x, self._last[:, 1] - start.z)) < 0.5)
