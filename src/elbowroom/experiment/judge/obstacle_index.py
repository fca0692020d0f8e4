"""What of very many obstacles is near: the boxes round them along the world's axes are asked first."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.judge.obstacles import Obstacle, distance_between

Floats = NDArray[np.float64]


class ObstacleIndex:
    """Obstacles that keep their places to each other."""

    def __init__(self, obstacles: Sequence[Obstacle]) -> None:
        self._obstacles = obstacles
        self._centers = np.array([obstacle.center for obstacle in obstacles]).reshape(-1, 3)
        self._reaches = np.array([obstacle.reach for obstacle in obstacles]).reshape(-1, 3)

    def nearest_first(self, low: Floats, high: Floats) -> Iterator[tuple[float, Obstacle]]:
        """All of them in the order of how far they are at least from a box with corners `low`, `high` (3,); and that.

        Metres.
        """
        distance = distance_between(low, high, self._centers, self._reaches)
        for which in np.argsort(distance, kind="stable"):
            yield float(distance[which]), self._obstacles[which]
