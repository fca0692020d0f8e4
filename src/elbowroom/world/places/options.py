"""What a user may tell about the model of a place."""

import math
from dataclasses import dataclass
from typing import Any

from elbowroom.errors import InputError

AXES = ("x", "y", "z", "-x", "-y", "-z")
_LEAST_SCALE, _MOST_SCALE = 1e-6, 1e6
_MOST_PATTERNS, _LONGEST_PATTERN = 100, 200
_FARTHEST = 10_000.0  # metres


@dataclass(frozen=True)
class PlaceOptions:
    """How to read a place; what is None is recognised. Raises `InputError` for what cannot be."""

    scale: float | None = None  # metres in a unit of the file
    up: str | None = None  # the file's axis that points up, of `AXES`
    ground: float | None = None  # height of the ground to walk on, metres in the turned and scaled place
    drop: tuple[str, ...] = ()  # patterns of names: these nodes, and what hangs on them, are left out
    passable: tuple[str, ...] = ()  # these are shown and in nobody's way

    def __post_init__(self) -> None:
        if self.scale is not None and not _LEAST_SCALE <= self.scale <= _MOST_SCALE:
            raise InputError(f"scale {self.scale:g}: must be a number of metres in a unit of the file, such as 0.01")
        if self.up is not None and self.up not in AXES:
            raise InputError(f"up {self.up[:20]!r}: must be one of {', '.join(AXES)}")
        if self.ground is not None and not (math.isfinite(self.ground) and abs(self.ground) <= _FARTHEST):
            raise InputError(f"ground {self.ground:g}: must be a height in metres")
        lists: dict[str, object] = {"drop": self.drop, "passable": self.passable}
        for name, patterns in lists.items():
            if isinstance(patterns, str):
                raise InputError(f"{name} {patterns[:40]!r}: must be a tuple of patterns, such as ({patterns[:40]!r},)")
        for pattern in (*self.drop, *self.passable):
            if not 0 < len(pattern) <= _LONGEST_PATTERN:
                raise InputError(f"the pattern {pattern[:20]!r} has no character or more than {_LONGEST_PATTERN}")
        if len(self.drop) + len(self.passable) > _MOST_PATTERNS:
            raise InputError(f"more than {_MOST_PATTERNS} patterns of names are given; use * and ?")

    def to_dict(self) -> dict[str, Any]:
        """Those that are told, as in the `place` of a scene file."""
        told = {"scale": self.scale, "up": self.up, "ground": self.ground}
        lists = {"drop": list(self.drop), "passable": list(self.passable)}
        return {name: value for name, value in told.items() if value is not None} | {
            name: value for name, value in lists.items() if value
        }
