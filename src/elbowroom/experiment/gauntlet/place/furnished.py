"""The model of a place whose furniture is moved."""

from dataclasses import dataclass, field
from pathlib import Path

from elbowroom.errors import InputError
from elbowroom.world.places.options import PlaceOptions

MARGIN = 0.05  # metres that the proof of a course keeps from everything
MOST_PIECES = 100


@dataclass(frozen=True)
class FurnishedPlace:
    """The model of a place, and how many pieces of furniture are put beside each way through it."""

    path: Path
    sha256: str  # of the file
    options: PlaceOptions = field(default_factory=PlaceOptions)
    pieces: int = 8

    def __post_init__(self) -> None:
        if not 1 <= self.pieces <= MOST_PIECES:
            raise InputError(f"pieces: {self.pieces} is not a whole number from 1 to {MOST_PIECES}")
