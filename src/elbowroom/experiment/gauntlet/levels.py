"""What makes a course harder: the five levels."""

from dataclasses import dataclass

from elbowroom.errors import InputError

# What a passage asks of the body, by the groups that must leave their natural motion.
ONE_ARM, BOTH_ARMS, BEND, TWIST, BEND_ARMS, TWIST_ARMS, BEND_TWIST = (
    "one arm",
    "both arms",
    "bend",
    "twist",
    "bend, arms",
    "twist, arms",
    "bend, twist, arms",
)


@dataclass(frozen=True)
class Level:
    """The settings of one level. Metres, radians."""

    number: int
    passages: tuple[int, int]  # how many there are, least and most
    gap: tuple[float, float]  # way between the end of one passage and the beginning of the next
    hold: tuple[float, float]  # length of a short passage
    margin: float  # clearance that the certificate motion keeps at least
    asks: tuple[str, ...]  # what a passage may ask of the body
    obstacles: tuple[int, int]  # in a passage, least and most
    long_passages: int  # how many of the passages are long
    long_hold: tuple[float, float]  # length of a long passage
    surely: str | None  # what one short passage asks at least
    turn: float  # greatest turn of the line between two passages; 0: the course is straight


_LONG = (3.2, 3.8)
_SIMPLE = (ONE_ARM, BOTH_ARMS, BEND)
_MIXED = (*_SIMPLE, TWIST, BEND_ARMS, TWIST_ARMS)
_HARD = (BOTH_ARMS, TWIST, BEND_ARMS, TWIST_ARMS, BEND_TWIST)

LEVELS = {
    level.number: level
    for level in (
        Level(1, (2, 3), (1.8, 2.4), (0.4, 0.7), 0.06, _SIMPLE, (1, 1), 0, _LONG, None, 0.0),
        Level(2, (3, 4), (1.6, 2.1), (0.4, 0.7), 0.05, _SIMPLE, (1, 2), 0, _LONG, None, 0.0),
        Level(3, (4, 5), (1.4, 1.8), (0.4, 0.8), 0.04, _MIXED, (1, 2), 0, _LONG, None, 0.35),
        Level(4, (5, 6), (1.2, 1.6), (0.4, 0.9), 0.03, (*_MIXED, BEND_TWIST), (2, 3), 1, _LONG, BEND_TWIST, 0.45),
        Level(5, (6, 8), (1.0, 1.4), (0.4, 1.0), 0.02, _HARD, (2, 3), 2, _LONG, BEND_TWIST, 0.55),
    )
}


def level_of(number: int) -> Level:
    """The level of this number; raises `InputError` if there is none."""
    if number not in LEVELS:
        raise InputError(f"level: {number} is not a whole number from {min(LEVELS)} to {max(LEVELS)}")
    return LEVELS[number]
