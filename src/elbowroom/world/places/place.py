"""A place as it was read: its parts in metres, Y up, and what was recognised on the way."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.models.model import Model
from elbowroom.world.places.options import PlaceOptions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Part:
    """What one node of the file shows."""

    name: str
    node: int  # of the model's glTF
    vertices: Floats  # (V, 3) metres, Y up
    faces: Ints  # (F, 3) into the vertices
    stands: bool  # False: one may pass through it


@dataclass(frozen=True, eq=False)
class Place:
    """The model of a place."""

    name: str  # of its file
    digest: str  # SHA-256 of the file
    model: Model
    options: PlaceOptions
    parts: tuple[Part, ...]
    to_metres: Floats  # (4, 4) from the frame of the model's glTF to that of the parts
    metre: float  # metres in a unit of the file
    up: str  # the file's axis that points up
    told: tuple[str, ...]  # sentences on unit and axis: recognised or told, and why
    notes: tuple[str, ...]  # what was left out or is odd
    dropped: frozenset[int]  # nodes of the glTF that are left out

    @property
    def triangles(self) -> int:
        """How many there are."""
        return sum(len(part.faces) for part in self.parts)

    @property
    def bounds(self) -> tuple[Floats, Floats]:
        """The least and the greatest corner (3,), metres."""
        least = np.min([part.vertices.min(axis=0) for part in self.parts], axis=0)
        most = np.max([part.vertices.max(axis=0) for part in self.parts], axis=0)
        return least, most
