"""Which trials the paper's experiment consists of."""

from dataclasses import dataclass
from pathlib import Path

from elbowroom.errors import InputError
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.planning.names import FIGURE6

MAX_SEEDS = 10_000


@dataclass(frozen=True)
class Table1Settings:
    """Which trials the experiment consists of. Seeds are 1 to `seeds`: seed 0 would start just as the scene says."""

    planners: tuple[str, ...] = (FIGURE6,)
    scenes: tuple[str, ...] = ("a", "b", "c", "d")  # names of stock scenes, or scene files
    queues: tuple[int, ...] = (3, 4, 5, 6, 7)
    seeds: int = 20
    limit: float = 30.0  # seconds that the user has
    avatar: Path | None = None  # the stock avatar
    live: bool = False  # plans are made beside playback

    def __post_init__(self) -> None:
        if not 1 <= self.seeds <= MAX_SEEDS:
            raise InputError(f"seeds: {self.seeds} is not between 1 and {MAX_SEEDS}")
        CrossingSettings(limit=self.limit)
        for name in ("planners", "scenes", "queues"):
            values = getattr(self, name)
            if not values or len(set(values)) < len(values):
                raise InputError(f"{name}: {', '.join(map(str, values)) or 'nothing'} (give each once)")
