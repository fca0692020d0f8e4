"""The manner in which a body walks: how much of what published gait has, and how its trunk leans."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import (
    AHEAD,
    ASIDE,
    CHEST_BEND,
    CHEST_LIST,
    CHEST_TURN,
    HEAD_NOD,
    LIST,
    POSING,
    TURN,
    UP,
)
from elbowroom.body.root import WITH_FEET
from elbowroom.errors import InputError

Floats = NDArray[np.float64]

_MOST = 3.0  # times what published gait has
_LEANS = (-0.2, 0.35)  # radians, back and forth


@dataclass(frozen=True)
class Manner:
    """How hips and chest are carried (`living`): 1 is as published gait has it, 0 not at all.

    Raises `InputError` for what no body could show.
    """

    sway: float = 1.0  # of the hips from side to side
    bob: float = 1.0  # of the hips up and down, beside what is planned
    ripple: float = 1.0  # of the hips ahead and back
    turn: float = 1.0  # of the hips about the vertical
    list: float = 1.0  # of the hips to the side that swings, and of the chest against it
    chest: float = 1.0  # of the chest about the vertical
    nods: float = 1.0  # of chest and head
    lean: float = 0.0  # of the chest ahead, radians

    def __post_init__(self) -> None:
        for name, value in asdict(self).items():
            low, high = _LEANS if name == "lean" else (0.0, _MOST)
            if not (math.isfinite(value) and low <= value <= high):
                raise InputError(f"{name}: {value:g} is not between {low:g} and {high:g}")

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> "Manner":
        """Read what `asdict` made; raises KeyError, TypeError, ValueError or `InputError`."""
        return cls(**{field.name: float(data[field.name]) for field in fields(cls)})

    def amounts(self) -> Floats:
        """What each number of the carriage is multiplied by, (POSING,), and behind these the lean."""
        row = np.ones(POSING + 1)
        of = {ASIDE: self.sway, UP: self.bob, AHEAD: self.ripple, TURN: self.turn, LIST: self.list}
        of |= {CHEST_TURN: self.chest, CHEST_LIST: self.list, CHEST_BEND: self.nods, HEAD_NOD: self.nods}
        for at, amount in of.items():
            row[at - WITH_FEET] = amount
        row[POSING] = self.lean
        return row


PLAIN = Manner()
