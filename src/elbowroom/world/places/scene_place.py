"""What a scene knows of the model that it was made of, and its parts packed so that a scene document needs no file."""

import base64
import binascii
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Mesh
from elbowroom.world.places.floor_area import FloorArea
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.place import Place

Floats = NDArray[np.float64]

_MOST_BYTES = 128 * 2**20  # of unpacked parts
MOST_PARTS = 20_000


@dataclass(frozen=True, eq=False)
class ScenePlace:
    """The model of a place that a scene shows; its parts are the first of the scene's obstacles."""

    file: str  # name
    sha256: str  # of the file
    options: PlaceOptions  # the ground's height included
    parts: int  # so many obstacles
    place: Place | None = None  # as it was read; None where the scene came without the file, or nobody needs it now
    glb: Path | None = None  # a file of what a viewer shows, in the scene's metres and axes
    notes: tuple[str, ...] = ()
    floor: FloorArea | None = None  # None: one walks all round, or nobody knows


def standing_parts(place: Place, ground: float) -> Obstacles:
    """What stands in the way in a place whose ground at that height becomes height 0."""
    names, shapes, centers = [], [], []
    for part in place.parts:
        least, most = part.vertices.min(axis=0), part.vertices.max(axis=0)
        if not part.stands:
            continue
        middle = 0.5 * (least + most)
        names.append(part.name)
        shapes.append(Mesh((part.vertices - middle).astype(np.float32).astype(np.float64), part.faces))
        centers.append(middle - [0.0, ground, 0.0])
    turns = np.tile([0.0, 0.0, 0.0, 1.0], (len(shapes), 1))
    return Obstacles(tuple(shapes), np.array(centers).reshape(-1, 3), turns, tuple(names))


def packed_parts(obstacles: Obstacles, count: int) -> dict[str, Any]:
    """The first `count` obstacles, meshes that are not turned, as `parts` and `data` of a document."""
    rows, pieces = [], []
    for number, (name, shape, center, _) in enumerate(obstacles):
        if number >= count:
            break
        assert isinstance(shape, Mesh)
        rows.append([name, len(shape.vertices), len(shape.faces), *center.tolist()])
        pieces += [shape.vertices.astype("<f4").tobytes(), shape.faces.astype("<u4").tobytes()]
    return {"parts": rows, "data": base64.b64encode(zlib.compress(b"".join(pieces), 6)).decode()}


def unpacked_parts(rows: list[tuple[str, int, int, Floats]], data: str, place: str) -> Obstacles:
    """What `packed_parts` wrote: names, numbers of vertices and faces, centres; raises `InputError`."""
    needed = sum(12 * vertices + 12 * faces for _, vertices, faces, _ in rows)
    if needed > _MOST_BYTES:
        raise InputError(f"{place}: its parts have more than {_MOST_BYTES >> 20} MB")
    try:
        stream = zlib.decompressobj()
        raw = stream.decompress(base64.b64decode(data, validate=True), needed + 1)
    except (binascii.Error, ValueError, zlib.error):
        raise InputError(f"{place}.data: is damaged: it must be as it was written") from None
    if len(raw) != needed:
        raise InputError(f"{place}.data: holds {len(raw)} bytes; its parts need {needed}")
    names, shapes, centers, at = [], [], [], 0
    for name, vertices, faces, center in rows:
        points = np.frombuffer(raw, "<f4", 3 * vertices, at).reshape(-1, 3).astype(np.float64)
        corners = np.frombuffer(raw, "<u4", 3 * faces, at + 12 * vertices).reshape(-1, 3).astype(np.int64)
        at += 12 * (vertices + faces)
        names.append(name)
        shapes.append(Mesh(points, corners))
        centers.append(center)
    turns = np.tile([0.0, 0.0, 0.0, 1.0], (len(shapes), 1))
    return Obstacles(tuple(shapes), np.array(centers).reshape(-1, 3), turns, tuple(names))


def with_more(first: Obstacles, more: Obstacles) -> Obstacles:
    """Both, those of `first` first; what moves is that of `more`."""
    return Obstacles(
        first.shapes + more.shapes,
        np.concatenate([first.centers, more.centers]),
        np.concatenate([first.rotations, more.rotations]),
        first.standing_names + more.standing_names,
        more.moving,
    )
