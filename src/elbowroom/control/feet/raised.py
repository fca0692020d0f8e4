"""Feet on ground that is not a plane, as they are shown: their height over it changes no faster than feet are lifted.

What a swinging foot is raised to follows from where it will land (`footing.py`). That changes as the root speeds up or
turns, and where it comes to lie on another tread the height jumps. So from frame to frame a foot follows it as fast as
a leg is lifted, and arms make way for legs that are not where they were planned, if that touches nothing.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE
from elbowroom.control.feet.arms_beside_legs import ArmsBesideLegs
from elbowroom.control.feet.feet import Moment
from elbowroom.control.key_frame_queue import Playback
from elbowroom.planning.model.footing import Footing

Floats = NDArray[np.float64]

_RATES = (2.25, 4.0)  # m/s up and down: as feet go on stairs, and hastily
_TURNS = 4.0  # radians that a sole may turn for each metre that it may rise
_SAME = 1e-9  # metres and radians
_SKIN = 0.01  # metres: nearly all of a foot's surface is within so much of its capsules (`body/fitting/coverage.py`)


class RaisedFeet:
    """Feet of the walk's cycle, raised to the ground."""

    def __init__(self, footing: Footing, arms: ArmsBesideLegs) -> None:
        self._footing, self._arms = footing, arms

    def standing(self, root: Floats) -> Floats:
        """A root state (ROOT_STATE,) with what the feet stand on."""
        stood: Floats = self._footing.stood(root[None])[0][0]
        return stood

    def are_still(self, before: Floats, shown: Floats) -> bool:
        """Whether feet that are shown in a root state (ROOT_STATE,), after another, have come to what they stand on."""
        return bool(np.abs(shown[RISES:ROOT_STATE] - before[RISES:ROOT_STATE]).max() < _SAME)

    def next(self, moment: Moment, posed: Playback) -> Playback:
        """How a pose is shown next, if that is free."""
        return next(self.settling(moment, posed))

    def under(self, moment: Moment, played: Sequence[tuple[Playback, Floats]]) -> Iterator[tuple[Playback, Floats]]:
        """Poses that could be shown next, each with its stance (3,): best first."""
        return ((each, stance) for posed, stance in played for each in self.settling(moment, posed))

    def settling(self, moment: Moment, held: Playback) -> Iterator[Playback]:
        """How a pose could be shown next, held or not: best first.

        Skin may be a little outside the capsules, so legs that have less room than that come last; then arms as they
        were planned.
        """
        close, as_planned = list[Playback](), list[Playback]()
        for root in raised(moment.shown.root, self.standing(held.root), moment.dt):
            upper = self._arms.apart(root, held.upper)
            if upper is not held.upper:
                as_planned.append(held._replace(root=root))
            pose = held._replace(root=root, upper=upper)
            if moment.look(root, upper).room < _SKIN:
                close.append(pose)
            else:
                yield pose
        yield from close
        yield from as_planned

    def resting(self, moment: Moment) -> Playback:
        """What is shown: who rests here does not live yet."""
        return moment.shown


def raised(before: Floats, stood: Floats, dt: float) -> Iterator[Floats]:
    """A root state that stands (ROOT_STATE,) as it may be shown `dt` seconds after the one `before`: best first.

    Feet go slowly to what they stand on, or faster, or are there at once; or stay as high as they are.
    """
    last = before
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
    for at, limit, carried in ((RISES, most, higher), (RISES + 1, _TURNS * most, 0.0)):
        change = stood[at : at + 4 : 2] - before[at : at + 4 : 2] + carried
        out[at : at + 4 : 2] += np.clip(change, -limit, limit) - change
    return out
