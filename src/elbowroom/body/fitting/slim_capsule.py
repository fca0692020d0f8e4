"""The slimmest capsule round some points.

The volume of the capsule that holds the wanted share of the points is minimised over its two ends (Nelder & Mead
1965). A capsule is convex, so one that holds the vertices of a mesh holds the triangles between them.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.fitting.nelder_mead import Ends, PointsToHold, least_volume, volume

Floats = NDArray[np.float64]


class SlimSettings(NamedTuple):
    """What a capsule must hold."""

    share: float  # of the points
    slack: float  # metres that a point may be outside and counts as held
    evaluations: int = 300  # of the search


class Slim(NamedTuple):
    """A capsule."""

    start: Floats  # (3,)
    end: Floats  # (3,)
    radius: float

    @property
    def volume(self) -> float:
        """Cubic metres."""
        length = float(np.linalg.norm(self.end - self.start))
        return math.pi * self.radius**2 * (length + 4.0 / 3.0 * self.radius)

    @property
    def turned(self) -> "Slim":
        """The same from its end to its start."""
        return Slim(self.end, self.start, self.radius)

    def outside(self, points: Floats) -> Floats:
        """How far each of the points (P, 3) is outside, metres; negative inside."""
        return distances(points, self.start, self.end) - self.radius


def slimmest(points: Floats, start: Floats, end: Floats, wanted: SlimSettings) -> Slim:
    """The slimmest capsule that holds the points (P, 3) as `wanted`, found from several first guesses.

    One of them runs along the axis from `start` to `end`.
    """
    rank = int(np.ceil(wanted.share * (len(points) - 1)))
    held = PointsToHold(np.ascontiguousarray(points, np.float64), rank, wanted.slack)
    found = [_search(held, guess, wanted.evaluations) for guess in _first_guesses(points, start, end)]
    best = min(found, key=lambda both: volume(both, held))
    away = np.quantile(distances(points, best[:3], best[3:]), wanted.share)
    return Slim(best[:3], best[3:], max(float(away) - wanted.slack, 0.0))


def distances(points: Floats, start: Floats, end: Floats) -> Floats:
    """Distances (P,) of points (P, 3) from segments given by their ends, each (3,) or (P, 3)."""
    along = end - start
    squared = np.maximum(np.sum(along * along, axis=-1), 1e-18)
    where = np.clip(np.sum((points - start) * along, axis=-1) / squared, 0.0, 1.0)
    away: Floats = np.linalg.norm(points - start - where[:, None] * along, axis=-1)
    return away


def _first_guesses(points: Floats, start: Floats, end: Floats) -> list[Floats]:
    """Capsules through the middle of the points, along the average proportions' axis and along their longest extent."""
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    _, _, axes = np.linalg.svd(points - middle, full_matrices=False)
    along = (end - start) / max(float(np.linalg.norm(end - start)), 1e-9)
    return [np.concatenate([middle - half, middle + half]) for half in (_half(points, d) for d in (along, axes[0]))]


def _half(points: Floats, direction: Floats) -> Floats:
    """Half the axis of a capsule in this direction that is as long and as thick as the points reach."""
    lengths = points @ direction
    across = points - lengths[:, None] * direction
    thickness = float(np.linalg.norm(np.ptp(across, axis=0))) / np.sqrt(2.0)
    half: Floats = 0.5 * max(float(np.ptp(lengths)) - thickness, 0.0) * direction
    return half


def _search(held: PointsToHold, first: Floats, evaluations: int) -> Floats:
    step = 0.1 * float(np.ptp(held.points, axis=0).max()) + 1e-6
    simplex = first + np.vstack([np.zeros(6), step * np.eye(6)])
    return least_volume(simplex, held, Ends(evaluations, 1e-4, 1e-8))
