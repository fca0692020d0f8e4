"""Which meetings of two avatars there are."""

from dataclasses import dataclass
from enum import StrEnum

from elbowroom.errors import InputError

WIDTHS = (0.95, 0.97, 1.0, 1.1, 1.2, 1.35, 1.45, 1.55, 1.6)  # metres
_NARROWEST, _WIDEST, _MOST = 0.8, 10.0, 10_000


class MeetingKind(StrEnum):
    """What the other does."""

    WALKS = "both walk"
    STANDS = "one stands"


@dataclass(frozen=True)
class MeetingSettings:
    """Which meetings there are. Meeting k has the seed `seed + k`. Raises `InputError` for what is out of range."""

    widths: tuple[float, ...] = WIDTHS  # metres, of the corridors
    starts: int = 20  # in each, of each kind
    seed: int = 0
    kinds: tuple[MeetingKind, ...] = tuple(MeetingKind)
    live: bool = False  # plans are made beside playback, as in a session: their answers come as late as they really are

    def __post_init__(self) -> None:
        for width in self.widths:
            if not _NARROWEST <= width <= _WIDEST:
                raise InputError(f"width {width:g}: allowed are {_NARROWEST:g} to {_WIDEST:g} metres")
        if not self.widths:
            raise InputError("widths: at least one is needed")
        if not 1 <= self.starts <= _MOST:
            raise InputError(f"starts: {self.starts} is not a whole number from 1 to {_MOST}")
        if not 0 <= self.seed < 2**32:
            raise InputError(f"seed: {self.seed} is not a whole number from 0 to {2**32 - 1}")

    @property
    def count(self) -> int:
        """How many meetings there are."""
        return len(self.kinds) * len(self.widths) * self.starts
