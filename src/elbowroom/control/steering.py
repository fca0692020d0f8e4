"""How much a command differs from the one that the motion in the queue was planned for."""

import math
from collections.abc import Collection
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.handed_over import is_number
from elbowroom.errors import InputError
from elbowroom.planning.command import Command, angle_between

Floats = NDArray[np.float64]

_REVERSED = math.radians(90.0)
_TREMOR = 0.01  # radians: what a hand on a stick does not mean, and
_TREMOR_SHARE = 0.02  # of shares


def checked(command: Command) -> Command:
    """The command with its shares clipped to [-1, 1]; raises `InputError` where a component is no number."""
    if not isinstance(command, Command):
        raise InputError(f"command: {command!r} is no Command, such as Command(forward=1.0)")
    shares = (command.forward, command.strafe, command.turn)
    direction = 0.0 if command.direction is None else command.direction
    if not all(map(is_number, (*shares, direction))) or not _is_way(command.way):
        raise InputError(f"command: {command} holds a value that is no finite number")
    if max(map(abs, shares)) <= 1.0:
        return command
    forward, strafe, turn = (max(-1.0, min(1.0, share)) for share in shares)
    return replace(command, forward=forward, strafe=strafe, turn=turn)


def _is_way(way: object) -> bool:
    return isinstance(way, Collection) and all(
        isinstance(corner, Collection) and len(corner) == 2 and all(map(is_number, corner)) for corner in way
    )


def steady(held: Command, command: Command) -> Command:
    """The command, or the one held until now while they differ by no more than a stick trembles: its plan is good."""
    if (held.idle, held.run, held.direction is None) != (command.idle, command.run, command.direction is None):
        return command
    pairs = ((held.forward, command.forward), (held.strafe, command.strafe), (held.turn, command.turn))
    trembles = max(abs(a - b) for a, b in pairs) <= _TREMOR_SHARE and angle_between(held, command) <= _TREMOR
    return held if trembles else command


def overturned(planned: Command, command: Command) -> bool:
    """Whether what was planned is not wanted any more at all: the user has let go, or turned back."""
    if planned == command:
        return False
    if command.idle:
        return not planned.idle
    return not planned.idle and angle_between(planned, command) > _REVERSED


def direction(command: Command, heading: float) -> Floats:
    """Where to a command wants an avatar to go that faces `heading`: (2,) of length 1, x and z; zero for nowhere."""
    if command.speed < _TREMOR_SHARE:
        return np.zeros(2)
    way = command.direction
    if way is None:
        way = heading + math.atan2(command.strafe, command.forward)
    return np.array([math.sin(way), math.cos(way)])
