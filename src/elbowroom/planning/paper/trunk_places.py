"""Where the trunk can pass: at which places on the ground some posture of the waist keeps it clear.

The paper's avatar goes round an obstacle where its trunk cannot pass, and adjusts its limbs where it can (section 1).
How the global path knows which is which is not printed. Here a place is passable for the trunk if the activity graph of
the waist holds a posture in which what the waist moves, shoulders and head included, is clear of all that stands, with
the root in that place and the body facing ahead. So a shoulder that a twist saves, or a beam that a bend does, diverts
nobody; a cupboard that no posture gets past does.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import is_empty

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

FARTHEST = 0.25  # metres: greater clearance is not told apart
_AT_ONCE = 20_000  # postures


class TrunkPlaces:
    """The clearances of a trunk among what stands in a scene, the best that any of its postures has."""

    def __init__(self, obstacles: Obstacles, segments: Floats32, radii: Floats32) -> None:
        """`segments` (C, 6, V) are the capsules of all postures, upright first, seen from a root at rest."""
        self._obstacles, self._segments, self._radii = obstacles, segments, radii
        across = segments.reshape(len(segments), 2, 3, -1)[:, :, ::2]
        self._reach = float(np.linalg.norm(across, axis=2).max() + radii.max()) + FARTHEST

    def clearance(self, places: Floats, facing: float) -> Floats32:
        """Metres that the trunk can keep at `places` (N, 2) if the body faces so, at most `FARTHEST`; (N,)."""
        least, most = places.min(axis=0) - self._reach, places.max(axis=0) + self._reach
        near = self._obstacles.near(least, most)
        best = np.full(len(places), FARTHEST, np.float32)
        if is_empty(near):
            return best
        postures = _turned(self._segments, facing)
        upright = clearance(_at(postures[:, :, :1], places), self._radii, near)
        best = np.minimum(best, upright)
        tight, count = np.flatnonzero(best < FARTHEST), max(1, _AT_ONCE // postures.shape[2])
        for first in range(0, len(tight), count):
            some = tight[first : first + count]
            found = clearance(_at(postures, places[some]), self._radii, near).reshape(len(some), -1)
            best[some] = np.minimum(found.max(axis=1, initial=-np.inf), FARTHEST)
        return best


def _turned(segments: Floats32, facing: float) -> Floats32:
    """Capsules (C, 6, V) turned about the root's axis."""
    sine, cosine = np.sin(facing), np.cos(facing)
    ends = segments.reshape(len(segments), 2, 3, -1)
    x, y, z = ends[:, :, 0], ends[:, :, 1], ends[:, :, 2]
    turned = np.stack([x * cosine + z * sine, y, z * cosine - x * sine], axis=2)
    return np.ascontiguousarray(turned.reshape(segments.shape), np.float32)


def _at(segments: Floats32, places: Floats) -> Floats32:
    """Capsules (C, 6, V) at N places, (C, 6, N V): all postures of the first place, of the second ..."""
    moved = np.repeat(segments[:, :, None], len(places), axis=2)
    for end in (0, 3):
        moved[:, end] += places[:, 0, None].astype(np.float32)
        moved[:, end + 2] += places[:, 1, None].astype(np.float32)
    return moved.reshape(len(segments), 6, -1)
