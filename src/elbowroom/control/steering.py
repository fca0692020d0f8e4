"""How much a command differs from the one that the motion in the queue was planned for."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.planning.command import Command

Floats = NDArray[np.float64]

_BENT = math.radians(20.0)  # a change of walking direction that is worth a plan of its own
_REVERSED = math.radians(90.0)
_SHARE = 0.25  # the same for shares of full speed and of full turning
_TREMOR = 0.01  # radians: what a hand on a stick does not mean, and
_TREMOR_SHARE = 0.02  # of shares


def checked(command: Command) -> Command:
    """The command with its shares clipped to [-1, 1]; raises `InputError` where a component is no number."""
    shares = (command.forward, command.strafe, command.turn)
    if not all(math.isfinite(share) for share in (*shares, command.direction or 0.0)):
        raise InputError(f"command: {command} holds a value that is no finite number")
    if max(map(abs, shares)) <= 1.0:
        return command
    forward, strafe, turn = (max(-1.0, min(1.0, share)) for share in shares)
    return replace(command, forward=forward, strafe=strafe, turn=turn)


def steady(held: Command, command: Command) -> Command:
    """The command, or the one held until now while they differ by no more than a stick trembles: its plan is good."""
    if (held.idle, held.run, held.direction is None) != (command.idle, command.run, command.direction is None):
        return command
    pairs = ((held.forward, command.forward), (held.strafe, command.strafe), (held.turn, command.turn))
    trembles = max(abs(a - b) for a, b in pairs) <= _TREMOR_SHARE and _angle(held, command) <= _TREMOR
    return held if trembles else command


def changed(planned: Command, command: Command) -> bool:
    """Whether the user asks for something else: waiting for the next key frame would feel late."""
    if planned == command:
        return False
    if (planned.idle, planned.run, planned.direction is None) != (command.idle, command.run, command.direction is None):
        return True
    share = abs(_speed(planned) - _speed(command)) > _SHARE or abs(planned.turn - command.turn) > _SHARE
    return share or _angle(planned, command) > _BENT


def overturned(planned: Command, command: Command) -> bool:
    """Whether what was planned is not wanted any more at all: the user has let go, or turned back."""
    if planned == command:
        return False
    if command.idle:
        return not planned.idle
    return not planned.idle and _angle(planned, command) > _REVERSED


def direction(command: Command, heading: float) -> Floats:
    """Where to a command wants an avatar to go that faces `heading`: (2,) of length 1, x and z; zero for nowhere."""
    if _speed(command) < _TREMOR_SHARE:
        return np.zeros(2)
    way = command.direction
    if way is None:
        way = heading + math.atan2(command.strafe, command.forward)
    return np.array([math.sin(way), math.cos(way)])


def _speed(command: Command) -> float:
    return abs(command.forward) if command.direction is not None else math.hypot(command.forward, command.strafe)


def _angle(a: Command, b: Command) -> float:
    """The angle between two walking directions, in the world if both say so, else in the avatar's axes."""
    if a.direction is not None and b.direction is not None:
        return abs(math.remainder(a.direction - b.direction, math.tau))
    if min(_speed(a), _speed(b)) < _TREMOR_SHARE or a.direction is not None or b.direction is not None:
        return 0.0
    return abs(math.remainder(math.atan2(a.strafe, a.forward) - math.atan2(b.strafe, b.forward), math.tau))
