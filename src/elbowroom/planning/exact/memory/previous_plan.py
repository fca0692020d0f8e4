"""What the last plan had, and asked for, at the key times of the next: so that a plan that is still good is kept.

Less clearance is asked of the motion near an obstacle than far from one, and still less where the avatar stands close
to one already. What a plan was allowed to do at some time stays allowed at that time for the plans to come, else they
would drop it for a margin's sake.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, DofGroup
from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.stillness import SAME

Floats = NDArray[np.float64]

_LITTLE = 0.15  # radians
_GROUPS = len(LOCAL_GROUPS)
_WAIST = DofGroup.WAIST.size  # components, the first of an upper body


class RequiredMargins(NamedTuple):
    """Clearances that a plan asked for, in metres; rows: the groups in the order of their search."""

    margins: Floats  # (G, n+1) of postures around key times
    motion_margins: Floats  # (G, n) of the motion in the key intervals

    def since(self, first: int, horizon: int) -> "RequiredMargins":
        """From the key time `first` on, over `horizon` intervals; infinite where the plan did not reach."""
        margins, motion_margins = self.margins[:, first:], self.motion_margins[:, first:]
        if margins.shape[1] <= horizon:
            beyond = np.full((len(margins), horizon + 1), np.inf)
            margins, motion_margins = (
                np.concatenate([margins, beyond], axis=1),
                np.concatenate([motion_margins, beyond], axis=1),
            )
        return RequiredMargins(margins[:, : horizon + 1], motion_margins[:, :horizon])

    def beside(self, other: "RequiredMargins") -> "RequiredMargins":
        """The lesser of two."""
        return RequiredMargins(
            np.minimum(self.margins, other.margins), np.minimum(self.motion_margins, other.motion_margins)
        )

    def at_most(self, most: list[float]) -> "RequiredMargins":
        """No more than so much for each group."""
        rows = np.array(most)[:, None]
        return RequiredMargins(np.minimum(self.margins, rows), np.minimum(self.motion_margins, rows))

    def then(self, at: int, later: "RequiredMargins") -> "RequiredMargins":
        """These until the key time `at`, and `later` ones, which begin there."""
        margins = np.concatenate([self.margins[:, :at], later.margins], axis=1)
        return RequiredMargins(margins, np.concatenate([self.motion_margins[:, :at], later.motion_margins], axis=1))


class StartState(NamedTuple):
    """Where a motion begins: now, or so many key intervals ahead on a plan that is kept until there."""

    upper: Floats  # (LOCAL,)
    velocity: Floats  # (LOCAL,)
    ahead: int = 0
    harsh: bool = False  # whether it may exceed the limits of speed and acceleration at first, if need be


class PreviousPlan(NamedTuple):
    """The last plan at the key times of a path."""

    keys: Floats  # (n+1, LOCAL) upper bodies; the last one known is repeated
    known: int  # of these key times, those that the last plan reached
    required: RequiredMargins  # infinite elsewhere

    @staticmethod
    def freely(keys: Floats) -> "PreviousPlan":
        """Upper bodies (n+1, LOCAL) of a plan that asked for all clearances."""
        return PreviousPlan(
            keys,
            len(keys),
            RequiredMargins(np.full((_GROUPS, len(keys)), np.inf), np.full((_GROUPS, len(keys) - 1), np.inf)),
        )


def required_margins(settings: ExactSettings, interval: float, count: int) -> RequiredMargins:
    """What is asked for in the next key intervals, so many of `interval` seconds: less soon than later."""
    shares = settings.soon_share + (1.0 - settings.soon_share) * (interval * np.arange(count + 1)) / settings.soon
    row = np.minimum(shares, 1.0)[None].repeat(_GROUPS, axis=0)
    return RequiredMargins(settings.margin * row, settings.motion_margin * row[:, :-1])


@exact_kernel
def jolts(keys: Floats, last: Floats, known: int) -> bool:
    """Whether the waist has left the last plan's way, and some joint by more than a little.

    The last plan had `last` (n+1, LOCAL) where these are the `keys` (n+1, LOCAL), at the first `known` key times.
    """
    left, farthest = False, 0.0
    for t in range(min(known, keys.shape[0])):
        for j in range(keys.shape[1]):
            left = left or (j < _WAIST and abs(keys[t, j] - last[t, j]) > SAME)
            farthest = max(farthest, abs(keys[t, j] - last[t, j]))
    return left and farthest > _LITTLE
