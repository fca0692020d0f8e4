"""Models of places made on the spot: named boxes as GLB, and rooms with walls and doors made of them."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from elbowroom.formats.glb_draft import GlbDraft

# Middle and whole lengths of a box, metres.
Boxes = Mapping[str, tuple[ArrayLike, ArrayLike]]

_CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_QUADS = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
TRIANGLES = _QUADS[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3).astype(np.int64)

# Two rooms, 4 x 4 m each, with a door of 0.8 m between them in the wall across Z at 4; a table in the first.
TWO_ROOMS: Boxes = {
    "Floor": ((0, -0.1, 4), (4.4, 0.2, 8.4)),
    "Wall_west": ((-2.1, 1.25, 4), (0.2, 2.5, 8.4)),
    "Wall_east": ((2.1, 1.25, 4), (0.2, 2.5, 8.4)),
    "Wall_south": ((0, 1.25, -0.1), (4.4, 2.5, 0.2)),
    "Wall_north": ((0, 1.25, 8.1), (4.4, 2.5, 0.2)),
    "Between_west": ((-1.2, 1.25, 4), (1.6, 2.5, 0.2)),
    "Between_east": ((1.2, 1.25, 4), (1.6, 2.5, 0.2)),
    "Door_1": ((0, 1.0, 4), (0.8, 2.0, 0.05)),
    "Table": ((1.5, 0.4, 1.0), (0.8, 0.8, 0.8)),
    "Ceiling": ((0, 2.6, 4), (4.4, 0.2, 8.4)),
}


def glb(boxes: Boxes, z_up: bool = False) -> bytes:
    """Each box as a node of its own; with Z up in a format that says Y."""
    draft = GlbDraft()
    for name, (middle, size) in boxes.items():
        points = np.asarray(middle, np.float64) + _CORNERS * np.asarray(size, np.float64)
        if z_up:
            points = points[:, [2, 0, 1]]  # x, y, z here are y, z, x there
        attributes = {"POSITION": draft.add_vertices(points, bounds=True)}
        primitive = {"attributes": attributes, "indices": draft.add_indices(TRIANGLES)}
        draft.add_node(name, mesh=draft.add("meshes", {"primitives": [primitive]}))
    return draft.finish()


def write_place(path: Path, boxes: Boxes = TWO_ROOMS, z_up: bool = False) -> Path:
    """The same as a file."""
    path.write_bytes(glb(boxes, z_up))
    return path
