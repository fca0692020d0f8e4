"""Feet that glide on ground that is not a plane: their height over it changes no faster than feet are lifted.

What a swinging foot is raised to follows from where it will land (`footing.py`). That changes as the root speeds up or
turns, and where it comes to lie on another tread the height jumps. So from frame to frame a foot follows it as fast as
a leg is lifted.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE
from elbowroom.control.feet.treading import HASTY, TURNS

Floats = NDArray[np.float64]

_RATES = (2.25, HASTY)  # m/s up and down: as feet go on stairs, and hastily
_SAME = 1e-9  # metres and radians


def raised(before: Floats, stood: Floats, dt: float) -> Iterator[Floats]:
    """A root state that is `stood` (ROOT_STATE,) as it may be shown `dt` seconds after the one `before`: best first.

    Feet go slowly to what they stand on, or faster, or are there at once; or stay as high as they are.
    """
    last = before[:ROOT_STATE]
    for rate in _RATES:
        root = _followed(before, stood, rate * dt)
        if np.abs(root - stood).max() > _SAME and np.abs(root - last).max() > _SAME:
            yield root
        last = root
    yield stood
    stays = _followed(before, stood, 0.0)
    if np.abs(stays - stood).max() > _SAME:
        yield stays


def _followed(before: Floats, stood: Floats, most: float) -> Floats:
    """A root state that stands, no foot more than `most` metres higher or lower than `before`."""
    out, higher = stood.copy(), stood[HEIGHT] - before[HEIGHT]
    for at, limit, carried in ((RISES, most, higher), (RISES + 1, TURNS * most, 0.0)):
        change = stood[at : at + 4 : 2] - before[at : at + 4 : 2] + carried
        out[at : at + 4 : 2] += np.clip(change, -limit, limit) - change
    return out
