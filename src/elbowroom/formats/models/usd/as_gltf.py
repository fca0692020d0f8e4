"""A place in USD as glTF: a node for each prim that shows something, below nodes with the names of those above it."""

from pathlib import Path
from typing import Any

import numpy as np

from elbowroom.errors import InputError
from elbowroom.formats.glb_draft import GlbDraft
from elbowroom.formats.gltf import Gltf, parse_gltf
from elbowroom.formats.models.matt import matt
from elbowroom.formats.models.said import Said
from elbowroom.formats.models.usd.opening import opened_stage
from elbowroom.formats.models.usd.pieces import PrimPiece, pieces_of

_FARTHEST = 1e7  # units


def parse_usd_scene(data: bytes, name: str, folder: Path | None) -> tuple[Gltf, Said]:
    """The model in the file's own axes and units, and what it says of them; raises `InputError`."""
    with opened_stage(data, name, folder) as stage:
        from pxr import UsdGeom

        pieces = list(pieces_of(stage, name))
        said = Said(str(UsdGeom.GetStageUpAxis(stage)).lower(), float(UsdGeom.GetStageMetersPerUnit(stage)))
    if not pieces:
        raise InputError(f"{name}: it shows no triangles (a motion is read from USD in text: .usda)")
    if said.up not in ("y", "z") or not 1e-6 < said.metre < 1e6:
        raise InputError(f"{name}: says that {said.up} is up and a unit is {said.metre:g} m")
    return parse_gltf(_drawn(pieces, name), name), said


def _drawn(pieces: list[PrimPiece], name: str) -> bytes:
    draft, nodes = GlbDraft(), dict[tuple[str, ...], int]()
    materials: dict[tuple[float, float, float] | None, int] = {}
    for piece in pieces:
        if not (np.abs(piece.points) < _FARTHEST).all():
            raise InputError(f"{name}: /{'/'.join(piece.path)} is too far away")
        middle = 0.5 * (piece.points.min(axis=0) + piece.points.max(axis=0))
        primitive: dict[str, Any] = {
            "attributes": {"POSITION": draft.add_vertices(piece.points - middle, bounds=True)},
            "indices": draft.add_indices(piece.faces),
        }
        if piece.colour is not None:
            if piece.colour not in materials:
                materials[piece.colour] = draft.add("materials", matt(piece.colour))
            primitive["material"] = materials[piece.colour]
        mesh = draft.add("meshes", {"primitives": [primitive]})
        parent = _node(draft, nodes, piece.path[:-1])
        draft.add_node(piece.path[-1], parent, translation=middle, mesh=mesh)
    return draft.finish()


def _node(draft: GlbDraft, nodes: dict[tuple[str, ...], int], path: tuple[str, ...]) -> int | None:
    """The node of a prim that shows nothing itself."""
    if not path:
        return None
    if path not in nodes:
        nodes[path] = draft.add_node(path[-1], _node(draft, nodes, path[:-1]))
    return nodes[path]
