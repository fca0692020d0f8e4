"""Where obstacles on tracks will ever be: boxes that hold it, a short piece of their ways in each."""

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.meshes.packed import NOTHING
from elbowroom.world.obstacles.rows import bounds_of, some_of
from elbowroom.world.obstacles.shapes import extents_of
from elbowroom.world.obstacles.tracks.moving import Moving, Repeat, Track

Floats = NDArray[np.float64]

_PIECE, _MOST_PIECES = 0.1, 1000  # metres of a way that is looked at as one, and how many of them


def ways_near(moving: Moving, time: float, least: Floats, most: Floats) -> Nearby:
    """Boxes that hold all that will ever be swept from a time on, of those that may reach into a box.

    That box goes from its least to its greatest coordinates (3,).
    """
    found = []
    for track in moving.tracks:
        moments, pieces = _pieces(track)
        to_come = (moments[1:] >= time) | (track.repeat is not Repeat.ONCE)
        to_come[-1] = True  # there it stays
        found.append(pieces.rows[to_come])
    ways = Nearby(np.concatenate(found), NOTHING)
    low, high = bounds_of(ways)
    reaching: NDArray[np.bool_] = np.all((low <= most) & (high >= least), axis=1)
    return some_of(ways, reaching)


@lru_cache(maxsize=256)
def _pieces(track: Track) -> tuple[Floats, Nearby]:
    """Moments (n+1,), and boxes (n) that hold what a track sweeps from each of them to the next."""
    moments = _moments(track)
    return moments, Nearby(Moving((track,)).swept(moments).rows[:, 0], NOTHING)


def _moments(track: Track) -> Floats:
    """Moments (n+1,) from the first key pose to the last, between which no point of a shape goes far."""
    if len(track.times) == 1:
        return np.repeat(track.times, 2)
    reach = float(np.linalg.norm(extents_of(track.shape)))
    ways = np.linalg.norm(np.diff(track.centers, axis=0), axis=1) + reach * np.abs(np.diff(track.yaws))
    piece = max(_PIECE, float(ways.sum()) / _MOST_PIECES)
    counts = np.maximum(np.ceil(ways / piece), 1.0).astype(np.int64)
    legs = zip(track.times[:-1], track.times[1:], counts, strict=True)
    return np.concatenate([*(np.linspace(a, b, n, endpoint=False) for a, b, n in legs), track.times[-1:]])
