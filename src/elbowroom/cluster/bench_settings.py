"""What `elbowroom bench cluster` walks, and by how many at once."""

from dataclasses import dataclass

from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.levels import level_of
from elbowroom.experiment.parallel import MAX_JOBS


@dataclass(frozen=True)
class ClusterSettings:
    """What is walked, and by how many at once."""

    address: str = "local"
    workers: tuple[int, ...] = (1, 2, 4)
    level: int = 3
    courses: int = 12

    def __post_init__(self) -> None:
        level_of(self.level)
        if not self.workers or not all(1 <= count <= MAX_JOBS for count in self.workers):
            raise InputError(f"workers {self.workers}: each is 1 to {MAX_JOBS}")
        if not 1 <= self.courses <= 10_000:
            raise InputError(f"courses {self.courses}: 1 to 10000")
