"""What `elbowroom bench motion` measures."""

from collections.abc import Sequence
from dataclasses import dataclass

from elbowroom.errors import InputError
from elbowroom.planning.root.settings import RootMotionSettings

STEADY, GAPS = "steady", "gaps"
UNEVEN = ("stair", "ramp", "sill")
SCRIPTED = (
    STEADY,
    *("start", "stop", "turn", "change of direction", "turn in place", "strafe", "back", "circle", "there and back"),
    *("crouch", "doorway", "slalom"),
    *UNEVEN,
)  # `scripts` makes them
SPEEDS = (0.5, 0.8, 1.1, 1.4, 2.0)  # m/s
RATIOS = (0.9, 0.95, 1.0, 1.05, 1.1, 1.2, 1.3, 1.5)  # of a gap to the width of the shoulders


@dataclass(frozen=True)
class MotionSettings:
    """What is measured; raises `InputError` for what is unknown or out of range."""

    cases: tuple[str, ...] = ()  # by name, "gaps" among them; none: all
    speeds: tuple[float, ...] = SPEEDS  # m/s, of the steady walks
    ratios: tuple[float, ...] = RATIOS  # of gaps to the width of the shoulders

    def __post_init__(self) -> None:
        for speed in self.speeds:
            check_speed(speed)
        for ratio in self.ratios:
            if not 0.3 <= ratio <= 4.0:
                raise InputError(f"ratio {ratio:g}: allowed are 0.3 to 4 shoulder widths")
        check_cases(self.cases, (*SCRIPTED, GAPS))

    @property
    def with_gaps(self) -> bool:
        """Whether gaps are walked through."""
        return not self.cases or GAPS in self.cases


def check_cases(names: Sequence[str], known: Sequence[str] = SCRIPTED) -> None:
    """Raises `InputError` if there is no case of such a name."""
    for name in names:
        if name not in known:
            raise InputError(f"case {name[:40]!r}: there are {', '.join(sorted(known))}")


def check_speed(speed: float) -> None:
    """Raises `InputError` if nobody walks or runs so fast, m/s."""
    fastest = RootMotionSettings().run_speed
    if not 0.0 < speed <= fastest:
        raise InputError(f"speed {speed:g}: allowed are more than 0 and up to {fastest:g} m/s")
