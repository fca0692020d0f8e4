"""The state of the root: where the body stands, how it moves, where in the stride it is, and what its feet stand on.

Behind it in the same row there may be the state of the feet (`foot_state`): WITH_FEET numbers in all. A row without
feet has those of the walking cycle (`gait`). Behind the feet there may be how hips, chest and head are carried
(`carriage`): SHOWN numbers in all. Without those they are as they are planned.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class RootState(NamedTuple):
    """One root state; as an array it has shape (ROOT_STATE,) in this order. Metres, radians, seconds.

    Kernels take rows of 7 numbers too, which end with the phase: those stand on the plane at height 0. Elsewhere (N, 7)
    stands for root states of either length.
    """

    x: float = 0.0  # metres
    z: float = 0.0  # metres
    heading: float = 0.0  # about +Y, 0 faces +Z, positive turns left (towards +X); never wrapped along a path
    forward: float = 0.0  # velocity along the heading, m/s
    lateral: float = 0.0  # velocity to the left of the heading, m/s
    turn: float = 0.0  # heading rate, rad/s
    phase: float = 0.0  # gait phase in strides (two steps), 0 = left heel strike; never wrapped along a path
    height: float = 0.0  # of the root's frame, metres: that of the ground about it
    climb: float = 0.0  # its rate over some way, m/s
    left_rise: float = 0.0  # of the ground under the left foot above the root's frame, metres
    left_slope: float = 0.0  # of that ground ahead of the foot, radians, positive where it falls
    right_rise: float = 0.0  # the same of the right foot
    right_slope: float = 0.0  # and of the ground ahead of it

    def as_array(self) -> NDArray[np.float64]:
        """The state as an array (ROOT_STATE,)."""
        return np.array(self, dtype=np.float64)

    @classmethod
    def of(cls, row: NDArray[np.float64]) -> "RootState":
        """The root state at the beginning of an array (7 or more,)."""
        return cls(*row[: len(cls._fields)].tolist())


ROOT_STATE = len(RootState._fields)  # number of components of a root state array
HEIGHT = RootState._fields.index("height")  # the first that is 0 on level ground; the climb is the next
RISES = RootState._fields.index("left_rise")  # the first of four: rise and slope of both feet
FOOT = 12  # numbers that say where a foot is and how it goes on, see `foot_state`
_TOLD_OF_FOOT = 9  # the first of them
WITH_FEET = ROOT_STATE + 2 * FOOT  # number of components of a root state array with feet
CARRIAGE = 13  # numbers that say how hips, chest and head are carried, see `carriage`
SHOWN = WITH_FEET + CARRIAGE  # number of components of a root state array as it is shown on the plane
_TOLD = np.concatenate(
    [
        np.arange(ROOT_STATE + _TOLD_OF_FOOT),
        ROOT_STATE + FOOT + np.arange(_TOLD_OF_FOOT),
        np.arange(WITH_FEET, SHOWN),
    ]
)
TOLD = len(_TOLD)  # number of components of a root state array as it is recorded
TOLD_FEET = 2 * _TOLD_OF_FOOT  # and of those of the feet in it, behind the root's own


def told(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """What is recorded (..., TOLD) of root states (..., SHOWN or less): all but how fast feet rise and roll.

    That says how they go on. Numbers that the rows are without are 0.
    """
    whole = np.zeros((*rows.shape[:-1], SHOWN))
    whole[..., : rows.shape[-1]] = rows
    return whole[..., _TOLD]


def as_told(recorded: NDArray[np.float64]) -> NDArray[np.float64]:
    """Root states (..., SHOWN) of which (..., TOLD) is recorded, with feet that neither rise nor roll."""
    rows = np.zeros((*recorded.shape[:-1], SHOWN))
    rows[..., _TOLD] = recorded
    return rows
