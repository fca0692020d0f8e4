"""What fields may hold, and the limits of a session."""

from dataclasses import dataclass
from typing import Annotated, Literal

from elbowroom.control import settings

PROTOCOL = 2  # raised with every change that an older client would misread
MAX_MESSAGE = 64 * 1024  # bytes in a client's text message
MAX_UPLOAD = 64 * 1024 * 1024  # bytes in an avatar file dropped on the page
MAX_SCENE = 512 * 1024  # bytes in a scene that was built on the page
QUEUE_SIZES = tuple(settings.QUEUE_SIZES)
WALK_SPEEDS = (0.2, 2.0)  # m/s, slowest and fastest
INPUT_TIMEOUT = 1.0  # seconds without any message after which the keys count as released


@dataclass(frozen=True)
class Range:
    """Bounds of a number, both included."""

    low: float
    high: float


@dataclass(frozen=True)
class Length:
    """The most characters of a text or items of a list."""

    most: int


Heading = Annotated[float, Range(-1e4, 1e4)]
Coordinate = Annotated[float, Range(-1e6, 1e6)]  # metres
Share = Annotated[float, Range(-1.0, 1.0)]
Sequence = Annotated[int, Range(0, 2**32 - 1)]
Name = Annotated[str, Length(128)]
Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
GroupName = Annotated[str, Length(32)]  # the label of a group of degrees of freedom
PhaseName = Literal["plan", "play", "reset"]
Reason = Literal["noPosture", "outOfReach", "motion"]
