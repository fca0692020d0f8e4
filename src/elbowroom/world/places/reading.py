"""Reads the model of a place: names of its parts, what is left out, unit and axis."""

import hashlib
from collections.abc import Callable, Iterator
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.hidden_nodes import hidden_nodes
from elbowroom.formats.models.model import Model, parse_model, read_model
from elbowroom.formats.nodes import NodeTree, read_nodes
from elbowroom.formats.triangles import MeshBounds, TriangleMesh, triangle_parts
from elbowroom.world.places.axes import ModelAxes, axes_of
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.place import Part, Place

Floats = NDArray[np.float64]
Progress = Callable[[str, float], None]  # what is done, and which share of it

BOUNDS = MeshBounds(vertices=6_000_000, triangles=2_000_000, primitives=20_000)
_LONGEST_NAME = 100  # characters
_FARTHEST = 10_000.0  # metres
_MOST_EXTENSIONS = 100
_READ = (
    "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_mesh_quantization",
    "KHR_node_visibility", "EXT_mesh_gpu_instancing",
)  # fmt: skip
_LOOKS = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "EXT_lights_")  # these change no shape
_EMPTY = "there are no triangles in it"
_OPTIONS = PlaceOptions()


def _silent(_what: str, _share: float) -> None:
    pass


def read_place(path: Path, options: PlaceOptions = _OPTIONS, progress: Progress = _silent) -> Place:
    """The place in a file, with what the file names beside it; raises `InputError`."""
    progress("Reading", 0.0)
    return _place(read_model(path), path.name, options, progress)


def parse_place(data: bytes, name: str, options: PlaceOptions = _OPTIONS, progress: Progress = _silent) -> Place:
    """The same for bytes that were sent to us: they must not name other files."""
    progress("Reading", 0.0)
    return _place(parse_model(data, name), name, options, progress)


def _place(model: Model, name: str, options: PlaceOptions, progress: Progress) -> Place:
    tree = read_nodes(model.gltf)
    names = _names(tree)
    dropped, passable, notes = _chosen(tree, options)
    hidden = hidden_nodes(model.gltf, tree)
    dropped, notes = dropped | hidden, (*notes, *_told(model.gltf, tree, hidden))
    shown = list(_shown(model, tree, dropped, name, progress))
    if not shown:
        raise InputError(f"{name}: {_EMPTY}" + (", or all are dropped" if dropped else ""))
    axes = _axes(shown, model, options)
    to_metres = np.eye(4)
    to_metres[:3, :3] = axes.metre * axes.turn
    parts = tuple(
        Part(names[node], node, points @ to_metres[:3, :3].T, faces, node not in passable)
        for node, points, faces in shown
    )
    found = Place(
        name=name,
        digest=hashlib.sha256(model.data).hexdigest(),
        model=model,
        options=options,
        parts=parts,
        to_metres=to_metres,
        metre=axes.metre,
        up=axes.up,
        told=axes.told,
        notes=(*model.notes, *notes, *axes.notes),
        dropped=dropped,
    )
    _refuse_too_large(found)
    return found


def _shown(
    model: Model, tree: NodeTree, dropped: frozenset[int], name: str, progress: Progress
) -> Iterator[tuple[int, Floats, NDArray[np.int64]]]:
    """For each node that shows triangles: the node, its vertices (V, 3) in the file's axes and units, its faces."""
    matrices = tree.world_matrices(tree.rotations)
    together: dict[int, list[tuple[Floats, NDArray[np.int64]]]] = {}
    last = -1
    for node, mesh in triangle_parts(model.gltf, tree, BOUNDS):
        if node != last:
            progress("Reading triangles", node / len(tree))
            last = node
        if node in dropped or not len(mesh.triangles):
            continue
        points = _placed(mesh, matrices)
        if not np.isfinite(points).all():
            raise InputError(f"{name}: node {node}: its vertices are too far away for numbers")
        together.setdefault(node, []).append((points, mesh.triangles))
    for node, pieces in together.items():
        starts = np.cumsum([0, *(len(points) for points, _ in pieces[:-1])])
        faces = np.concatenate([faces + start for (_, faces), start in zip(pieces, starts, strict=True)])
        yield node, np.concatenate([points for points, _ in pieces]), faces


def _placed(mesh: TriangleMesh, matrices: Floats) -> Floats:
    """The vertices (V, 3) where the file's rest pose puts them."""
    points = np.zeros((len(mesh.nodes), 3))
    with np.errstate(all="ignore"):
        for slot in range(mesh.nodes.shape[1]):
            matrix = matrices[mesh.nodes[:, slot]]
            moved = np.einsum("vij,vj->vi", matrix[:, :3, :3], mesh.offsets[:, slot]) + matrix[:, :3, 3]
            points += mesh.weights[:, slot, None] * moved
    return points


def _axes(shown: list[tuple[int, Floats, NDArray[np.int64]]], model: Model, options: PlaceOptions) -> ModelAxes:
    starts = np.cumsum([0, *(len(points) for _, points, _ in shown[:-1])])
    vertices = np.concatenate([points for _, points, _ in shown])
    faces = np.concatenate([faces + start for (_, _, faces), start in zip(shown, starts, strict=True)])
    return axes_of(vertices, faces, model.kind, options, model.said)


def _names(tree: NodeTree) -> tuple[str, ...]:
    """A name for each node: its own, or that of the nearest node above that has one."""
    found = [""] * len(tree)
    for node in map(int, tree.order):
        above = int(tree.parents[node])
        found[node] = tree.names[node] or (found[above] if above >= 0 else "")
    return tuple((name or f"part {node + 1}")[:_LONGEST_NAME] for node, name in enumerate(found))


def _chosen(tree: NodeTree, options: PlaceOptions) -> tuple[frozenset[int], frozenset[int], tuple[str, ...]]:
    """The nodes to leave out, those to pass through, and notes on patterns that match none."""
    notes: list[str] = []
    chosen = []
    for word, patterns in (("drop", options.drop), ("passable", options.passable)):
        own = set[int]()
        for pattern in patterns:
            met = {node for node, name in enumerate(tree.names) if name and fnmatchcase(name, pattern)}
            if not met:
                notes.append(f"{word} {pattern!r} matches no name in the file")
            own |= met
        for node in map(int, tree.order):
            if int(tree.parents[node]) in own:
                own.add(node)
        chosen.append(frozenset(own))
    return chosen[0], chosen[1], tuple(notes)


def _told(gltf: Gltf, tree: NodeTree, hidden: frozenset[int]) -> Iterator[str]:
    """Notes on what nobody sees, and on what is not read."""
    unseen = sum(tree.meshes[node] >= 0 for node in hidden)
    if unseen:
        yield f"nodes left out, since they are hidden or in another scene of the file: {unseen} with a mesh"
    for name in gltf.root.at("extensionsRequired").items(_MOST_EXTENSIONS):
        if name.text() not in _READ and not name.text().startswith(_LOOKS):
            yield f"it needs {name.text()[:_LONGEST_NAME]!r}, which is not read here: something may be missing"


def _refuse_too_large(place: Place) -> None:
    least, most = place.bounds
    farthest = float(np.max(np.abs([least, most])))
    if farthest > _FARTHEST:
        raise InputError(
            f"{place.name}: reaches {farthest:.3g} m from its origin; at most {_FARTHEST:g} m are read (--scale)"
        )
