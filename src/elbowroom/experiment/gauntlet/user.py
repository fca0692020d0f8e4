"""A user who follows the line of a course, and when stuck backs up a little and tries again."""

import numpy as np

from elbowroom.body.root import RootState
from elbowroom.experiment.gauntlet.line import CourseLine
from elbowroom.experiment.scripted_user import FORWARD, ScriptedUser
from elbowroom.planning.command import Command

_LEAD = 0.30  # metres: the avatar answers that much later
_PULL = 2.0  # radians for each metre beside the line
_MOST = 0.5  # radians that the user corrects by


class CourseUser:
    """The scripted user of the crossing test, who can steer."""

    def __init__(self, line: CourseLine, rng: np.random.Generator) -> None:
        self._line = line
        self._walker = ScriptedUser(rng)
        self._way, self._x, self._z = line.table
        self._headings, self._ahead = line.heading(self._way), line.heading(self._way + _LEAD)
        self._around = 0.0  # metres along the line

    def command(self, root: RootState, stuck: bool, dt: float) -> Command:
        """The command for the next `dt` seconds, where the avatar stands at `root`."""
        wish = self._walker.command(stuck, dt)
        if wish != FORWARD or self._line.straight:
            return wish
        here = self._line.place_nearest(root.x, root.z, self._around)
        self._around = float(self._way[here])
        heading = self._headings[here]
        beside = (root.x - self._x[here]) * np.cos(heading) - (root.z - self._z[here]) * np.sin(heading)
        pull = min(max(_PULL * float(beside), -_MOST), _MOST)
        return Command(forward=1.0, direction=float(self._ahead[here]) - pull)
