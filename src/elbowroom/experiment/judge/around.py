"""What of very many obstacles is near: the boxes round them along the world's axes are asked first."""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.judge.obstacles import Obstacle

Floats = NDArray[np.float64]


class Around:
    """Obstacles that keep their places to each other."""

    def __init__(self, obstacles: Sequence[Obstacle]) -> None:
        self._obstacles = obstacles
        self._centers = np.array([obstacle.center for obstacle in obstacles]).reshape(-1, 3)
        reaches = [np.abs(obstacle.to_box.T) @ obstacle.half_size for obstacle in obstacles]
        self._reaches = np.array(reaches).reshape(-1, 3)

    def nearest_first(self, low: Floats, high: Floats) -> Iterator[tuple[float, Obstacle]]:
        """All of them in the order of how far they are at least from a box with corners `low`, `high` (3,); and that.

        Metres.
        """
        gap = np.maximum(np.maximum(low - self._centers, self._centers - high) - self._reaches, 0.0)
        distance = np.linalg.norm(gap, axis=1)
        for which in np.argsort(distance, kind="stable"):
            yield float(distance[which]), self._obstacles[which]
