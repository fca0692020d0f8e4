"""The user's intent in one moment."""

from dataclasses import dataclass

_NOTHING = 1e-6  # share of full speed: less asks for nothing


@dataclass(frozen=True)
class Command:
    """What the user asks for, in the avatar's own axes; each component lies in [-1, 1].

    With `direction` given (a heading in radians, world axes), the avatar walks towards it and turns to face it: this
    is how camera-relative steering arrives. Otherwise `forward`, `strafe` and `turn` are taken as they are.
    """

    forward: float = 0.0  # 1 walks at full speed, negative walks backwards
    strafe: float = 0.0  # positive to the avatar's left
    turn: float = 0.0  # positive turns left
    direction: float | None = None  # desired heading in the world; then `forward` is the wanted share of full speed
    run: bool = False  # faster

    @property
    def idle(self) -> bool:
        """Whether the user has let go."""
        return abs(self.forward) < _NOTHING and abs(self.strafe) < _NOTHING and abs(self.turn) < _NOTHING
