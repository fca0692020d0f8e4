"""What the file of a model says of its axes and units."""

from typing import NamedTuple


class Said(NamedTuple):
    """The axis that points up, and the unit."""

    up: str  # "y" or "z"
    metre: float  # metres in a unit
