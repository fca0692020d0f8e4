"""The ways that were walked along in a run, as recordings keep them: rows where a command names another than before."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.command import Command
from elbowroom.planning.root.line.way_ahead import Corners

WAY = np.dtype(
    [
        ("step", "<u4"),  # counted from 0 over the whole recording: from this one on
        ("corner", "<f8", 2),  # x, z; not a number where no way is named any more
    ]
)

Ways = NDArray[np.void]


class WayLog:
    """Notes the ways of commands."""

    def __init__(self) -> None:
        self._last: Corners = ()
        self._rows: list[tuple[Any, ...]] = []

    def note(self, step: int, command: Command) -> None:
        """What is new in this step."""
        if command.way != self._last:
            self._last = command.way
            self._rows += [(step, corner) for corner in command.way or ((np.nan, np.nan),)]

    def taken(self) -> Ways:
        """All that was noted since this was called last."""
        rows, self._rows = np.array(self._rows, WAY), []
        return rows


def way_from(ways: Ways, step: int, before: Corners) -> Corners:
    """The way that the command of a step names, `before` it another one."""
    corners = ways["corner"][ways["step"] == step].tolist()
    return tuple((x, z) for x, z in corners if not np.isnan(x)) if corners else before
