"""What a crossing trial varies."""

from dataclasses import dataclass

from elbowroom.errors import InputError
from elbowroom.planning.names import DEFAULT_PLANNER

LONGEST_LIMIT = 3600.0  # seconds


@dataclass(frozen=True)
class CrossingSettings:
    """What a crossing trial varies; raises `InputError` for what is out of range."""

    planner: str = DEFAULT_PLANNER
    queue_size: int = 5
    seed: int = 0  # of the planner's chance, the start and the user's patience
    limit: float = 30.0  # seconds that the user has
    live: bool = False  # plans are made beside playback, as in a session: their answers come as late as they really are

    def __post_init__(self) -> None:
        if self.seed < 0:
            raise InputError(f"seed: {self.seed} is negative")
        if not 0.0 < self.limit <= LONGEST_LIMIT:
            raise InputError(f"limit: {self.limit} is not between 0 and {LONGEST_LIMIT:g} seconds")
