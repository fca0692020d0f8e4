"""The user's intent in one moment."""

import math
from dataclasses import dataclass

_NOTHING = 1e-6  # share of full speed: less asks for nothing
_TREMOR = 0.02  # share of full speed: slower has no direction
BENT = math.radians(20.0)  # a change of walking direction that is worth a plan of its own
_SHARE = 0.25  # the same for shares of full speed and of full turning
_TREMBLING = math.radians(2.0)  # a hand that holds a direction holds it no better
_UNSTEADY = 0.02  # the same of shares of full speed and of full turning


@dataclass(frozen=True)
class Command:
    """What the user asks for, in the avatar's own axes; each component lies in [-1, 1].

    With `direction` given (a heading in radians, world axes), the avatar walks towards it and turns to face it, or
    walks there backwards: this is how camera-relative steering arrives. Otherwise `forward`, `strafe` and `turn` are
    taken as they are.

    With a `way` too it walks along that, round its corners, and stands at its end; `direction` is where it begins.
    """

    forward: float = 0.0  # 1 walks at full speed, negative walks backwards
    strafe: float = 0.0  # positive to the avatar's left
    turn: float = 0.0  # positive turns left
    direction: float | None = None  # where to in the world; then `forward` is the wanted share of full speed
    run: bool = False  # faster
    way: tuple[tuple[float, float], ...] = ()  # the corners (x, z) of a way, both ends included
    led: bool = False  # to a place, by who knows the way there
    may_climb: bool = True  # over what is too high for a step, where there is no other way

    @property
    def idle(self) -> bool:
        """Whether the user has let go."""
        return abs(self.forward) < _NOTHING and abs(self.strafe) < _NOTHING and abs(self.turn) < _NOTHING

    @property
    def turns(self) -> bool:
        """Whether the user turns the body by hand."""
        return self.direction is None and abs(self.turn) >= _NOTHING

    @property
    def straight(self) -> bool:
        """Whether the user goes where the body faces."""
        return self.direction is None and self.forward >= _NOTHING and abs(self.strafe) < _NOTHING

    @property
    def speed(self) -> float:
        """The share of full speed, in whatever direction."""
        return abs(self.forward) if self.direction is not None else math.hypot(self.forward, self.strafe)


def angle_between(a: Command, b: Command) -> float:
    """The angle between two walking directions, in the world if both say so, else in the avatar's axes."""
    if a.direction is not None and b.direction is not None:
        return abs(math.remainder(a.direction - b.direction, math.tau))
    if min(a.speed, b.speed) < _TREMOR or a.direction is not None or b.direction is not None:
        return 0.0
    return abs(math.remainder(math.atan2(a.strafe, a.forward) - math.atan2(b.strafe, b.forward), math.tau))


def changed(planned: Command, command: Command) -> bool:
    """Whether the user asks for something else: waiting for the next key frame would feel late."""
    if planned == command:
        return False
    if (planned.idle, planned.run, planned.direction is None) != (command.idle, command.run, command.direction is None):
        return True
    if planned.way != command.way or (planned.direction is not None and planned.forward * command.forward < 0.0):
        return True
    share = abs(planned.speed - command.speed) > _SHARE or abs(planned.turn - command.turn) > _SHARE
    return share or angle_between(planned, command) > BENT


def trembles(planned: Command, command: Command) -> bool:
    """Whether a command differs from the one before by no more than a hand trembles that means the same."""
    if changed(planned, command) or angle_between(planned, command) > _TREMBLING:
        return False
    return abs(planned.speed - command.speed) < _UNSTEADY and abs(planned.turn - command.turn) < _UNSTEADY
