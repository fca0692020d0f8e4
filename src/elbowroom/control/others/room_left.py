"""Room that is left to others, so that nobody touches whoever does something else than was told.

Two who are shown at once know of each other where each was shown last, and where each said that it would be now. Who
finds no way on stays where it was, or thinks of something new: then the other, who took its word, may meet it. So each
promises to be near one of these two bodies of its own, and keeps as far from both of the other's: a share of the room
between the two pairs, as both know it. Whatever both do, they do not meet.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.others.neighbour import Neighbour

Floats = NDArray[np.float64]

_WAS = 0.25  # of the room between where both were shown: so far each may be from there, and so near to the other
_SAID = 0.5  # of the room between where both said that they would be
_FAR = 0.5  # metres between two bodies that do not meet in a frame


def leaves_room(told: Neighbour, other: Neighbour, was: Floats, shown: Floats, time: float) -> bool:
    """Whether a body whose axes `was` (C, 6) may be `shown` (C, 6) at a `time`, both in the world.

    `told` is what the other knows of it. To stay is always allowed, and not asked about here.
    """
    room = _between(told, other, was, -np.inf)
    if room > _FAR:
        return True
    said = told.at(time)
    later = max(_between(told, other, said, time), 0.0)
    stays, keeps_word = _away(was, shown) <= _WAS * room, later > 0.0 and _away(said, shown) <= _SAID * later
    if not (stays or keeps_word):
        return False
    return _between(told, other, shown, -np.inf) >= _WAS * room and _between(told, other, shown, time) >= _SAID * later


def in_world(axes: NDArray[np.float32], root: Floats) -> Floats:
    """Axes (C, 6, 1) about a root's place, in the world, (C, 6)."""
    x, z = root[:2].tolist()
    world: Floats = axes[:, :, 0] + np.array([x, 0.0, z, x, 0.0, z])
    return world


def _between(own: Neighbour, other: Neighbour, axes: Floats, time: float) -> float:
    """Metres between one's own body at `axes` (C, 6) and another's at a time of its."""
    x, _, z = axes[0, :3].tolist()
    near = (axes - np.array([x, 0.0, z, x, 0.0, z])).astype(np.float32)[:, :, None]
    return other.clearance(np.ascontiguousarray(near), own.radii.astype(np.float32), np.array([x, z]), time)


def _away(one: Floats, another: Floats) -> float:
    """Metres that no point of a body is farther away in another pose: axes (C, 6)."""
    ends = (one - another).reshape(-1, 3)
    return float(np.linalg.norm(ends, axis=1).max(initial=0.0))
