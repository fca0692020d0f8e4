"""What stands in a place and can be moved: parts of the size of furniture that hang together; and made-up pieces."""

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.gauntlet.draw import Draw, Range
from elbowroom.world.obstacles.shapes import Box, Cylinder, Mesh, Shape
from elbowroom.world.places.place import Part, Place

Floats = NDArray[np.float64]

_TOUCH = 0.02  # metres: parts so near to each other are one piece
_WIDEST, _LOWEST, _HIGHEST = 2.2, 0.3, 2.1  # metres: a piece is no wider, and its top between these
_LEAF, _UPRIGHT = 0.08, 1.2  # metres: what is thinner and higher is a door or a panel
_SUNK, _RAISED = 0.3, 0.1  # metres that it may reach below its floor, and begin above it
_MOST_PARTS = 2000  # of the size of furniture; a place with more of them is a heap of splinters


class Furniture(NamedTuple):
    """One piece of furniture, about the middle of its box."""

    name: str
    shape: Shape
    half: Floats  # (3,) metres, of the box that holds it
    height: float  # of its middle over the floor, metres


class _MadeUp(NamedTuple):
    """A kind of furniture, metres."""

    name: str
    wide: Range
    deep: Range
    high: Range
    round: bool = False


_MADE_UP = (
    _MadeUp("chair", (0.4, 0.55), (0.4, 0.55), (0.8, 1.0)),
    _MadeUp("table", (0.7, 1.4), (0.6, 0.9), (0.7, 0.78)),
    _MadeUp("sideboard", (0.8, 1.4), (0.35, 0.5), (0.75, 1.1)),
    _MadeUp("shelf", (0.6, 1.0), (0.25, 0.4), (1.6, 2.0)),
    _MadeUp("crate", (0.35, 0.6), (0.35, 0.6), (0.35, 0.7)),
    _MadeUp("plant", (0.3, 0.5), (0.3, 0.5), (0.9, 1.7), round=True),
    _MadeUp("floor lamp", (0.12, 0.2), (0.12, 0.2), (1.3, 1.8), round=True),
)


def furniture_of(place: Place, floor: float) -> tuple[tuple[Furniture, ...], Place]:
    """The pieces of furniture in a place whose floor is at that height, and the place without them."""
    pieces, moved = list[Furniture](), set[int]()
    for group in _groups(place.parts):
        parts = [place.parts[k] for k in group]
        least = np.min([part.vertices.min(axis=0) for part in parts], axis=0)
        most = np.max([part.vertices.max(axis=0) for part in parts], axis=0)
        size, bottom, top = most - least, least[1] - floor, most[1] - floor
        stands = -_SUNK <= bottom <= _RAISED and _LOWEST <= top <= _HIGHEST
        leaf = min(size[0], size[2]) < _LEAF and top > _UPRIGHT
        if stands and not leaf and max(size[0], size[2]) <= _WIDEST:
            pieces.append(_piece(parts, least, most, floor))
            moved.update(group)
    left = tuple(part for number, part in enumerate(place.parts) if number not in moved)
    return (tuple(pieces), replace(place, parts=left)) if left else ((), place)


def made_up(draw: Draw) -> Furniture:
    """A piece that no place has."""
    kind = draw.one_of(_MADE_UP)
    wide, deep, high = draw.between(kind.wide), draw.between(kind.deep), draw.between(kind.high)
    shape = Cylinder(0.5 * wide, high) if kind.round else Box((wide, high, deep))
    return Furniture(kind.name, shape, 0.5 * np.array([wide, high, wide if kind.round else deep]), 0.5 * high)


def _piece(parts: list[Part], least: Floats, most: Floats, floor: float) -> Furniture:
    middle = 0.5 * (least + most)
    starts = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    faces = np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=True)])
    vertices = np.concatenate([part.vertices for part in parts]) - middle
    mesh = Mesh(vertices.astype(np.float32).astype(np.float64), faces)
    return Furniture(parts[0].name, mesh, 0.5 * (most - least), float(middle[1]) - floor)


def _groups(parts: tuple[Part, ...]) -> Iterator[list[int]]:
    """The numbers of small parts that hang together by their boxes, those of one piece together."""
    low = np.array([part.vertices.min(axis=0) for part in parts])
    high = np.array([part.vertices.max(axis=0) for part in parts])
    stands = np.array([part.stands for part in parts])
    small = np.flatnonzero(stands & ((high - low)[:, [0, 2]].max(axis=1) <= _WIDEST))
    left = set(small.tolist()) if len(small) <= _MOST_PARTS else set[int]()
    while left:
        group, open_ends = list[int](), [min(left)]
        left.discard(open_ends[0])
        while open_ends:
            one = open_ends.pop()
            group.append(one)
            others = np.array(sorted(left), np.int64)
            apart = np.maximum(low[others] - high[one], low[one] - high[others]).max(axis=1, initial=-np.inf)
            near = others[apart <= _TOUCH].tolist()
            open_ends += near
            left.difference_update(near)
        yield sorted(group)
