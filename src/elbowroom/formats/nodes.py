"""The node tree of a glTF file: who hangs on whom, and where everything is."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MAX_NODES = 20_000
MAX_DEPTH = 256


@dataclass(frozen=True, eq=False)
class NodeTree:
    """All nodes of a file, in the order of the file."""

    names: tuple[str, ...]  # (n,) "" where a node has none
    parents: Ints  # (n,) -1 for a root
    order: Ints  # (n,) node indices, parents before children
    translations: Floats  # (n, 3) in the parent's units
    rotations: Floats  # (n, 4) xyzw, unit
    scales: Floats  # (n, 3)
    meshes: Ints  # (n,) -1 for none
    skins: Ints  # (n,) -1 for none

    def __len__(self) -> int:
        return len(self.names)

    def ancestors(self, node: int) -> list[int]:
        """The nodes above `node`, nearest first."""
        above = []
        while (node := int(self.parents[node])) >= 0:
            above.append(node)
        return above

    def world_matrices(self, rotations: Floats) -> Floats:
        """World transforms (n, 4, 4) for local rotations (n, 4); not finite where the file's numbers overflow."""
        local = np.zeros((len(self), 4, 4))
        local[:, :3, :3] = quaternion.to_matrix(rotations) * self.scales[:, None, :]
        local[:, :3, 3] = self.translations
        local[:, 3, 3] = 1.0
        with np.errstate(all="ignore"):
            for node in self.order:
                if self.parents[node] >= 0:
                    local[node] = local[self.parents[node]] @ local[node]
        return local

    def world_rotations(self, rotations: Floats) -> Floats:
        """World rotations (n, 4) with these local rotations (n, 4): the product of rotations, whatever the scales."""
        world = rotations.copy()
        for node in self.order:
            if self.parents[node] >= 0:
                world[node] = quaternion.multiply(world[self.parents[node]], rotations[node])
        return quaternion.normalize(world)

    def world_scale(self, node: int) -> float:
        """The product of the uniform scales at and above `node` (of the x components, which are the scale there)."""
        return float(np.prod(self.scales[[node, *self.ancestors(node)], 0]))


def read_nodes(gltf: Gltf) -> NodeTree:
    """The node tree; raises `InputError` for cycles, shared children, wrong numbers, too many or too deep nodes."""
    fields = gltf.root.at("nodes").items(MAX_NODES)
    if not fields:
        raise InputError(f"{gltf.name} has no nodes: there is nothing in it")
    parents = _parents(fields)
    transforms = [_transform(field) for field in fields]
    meshes = len(gltf.root.at("meshes").items()) - 1
    skins = len(gltf.root.at("skins").items()) - 1
    return NodeTree(
        names=tuple(field.at("name").text() for field in fields),
        parents=parents,
        order=_order(parents, gltf.name),
        translations=np.array([t for t, _, _ in transforms]).reshape(-1, 3),
        rotations=np.array([r for _, r, _ in transforms]).reshape(-1, 4),
        scales=np.array([s for _, _, s in transforms]).reshape(-1, 3),
        meshes=np.array([f.at("mesh").optional_integer(0, meshes, -1) for f in fields], dtype=np.int64),
        skins=np.array([f.at("skin").optional_integer(0, skins, -1) for f in fields], dtype=np.int64),
    )


def _parents(fields: list[Field]) -> Ints:
    parents = np.full(len(fields), -1, dtype=np.int64)
    for node, field in enumerate(fields):
        for child_field in field.at("children").items():
            child = child_field.integer(0, len(fields) - 1)
            if parents[child] >= 0:
                raise InputError(f"{child_field.place}: node {child} already hangs on node {parents[child]}")
            parents[child] = node
    return parents


def _order(parents: Ints, name: str) -> Ints:
    children: list[list[int]] = [[] for _ in parents]
    for node, parent in enumerate(parents):
        if parent >= 0:
            children[parent].append(node)
    level = [node for node, parent in enumerate(parents) if parent < 0]
    order: list[int] = []
    depth = 0
    while level:
        depth += 1
        if depth > MAX_DEPTH:
            raise InputError(f"{name}: the nodes hang more than {MAX_DEPTH} deep")
        order += level
        level = [child for node in level for child in children[node]]
    if len(order) < len(parents):
        raise InputError(f"{name}: nodes: {len(parents) - len(order)} nodes hang in a circle")
    return np.array(order, dtype=np.int64)


def _transform(field: Field) -> tuple[Floats, Floats, Floats]:
    matrix = field.at("matrix")
    if matrix.present:
        return _decompose(matrix, matrix.vector(16).reshape(4, 4).T)
    translation, rotation, scale = (field.at(key) for key in ("translation", "rotation", "scale"))
    turn = rotation.vector(4) if rotation.present else quaternion.IDENTITY
    length = float(np.linalg.norm(turn))
    if not 0.5 < length < 2.0:
        raise rotation.wrong("a unit quaternion")
    return (
        translation.vector(3) if translation.present else np.zeros(3),
        turn / length,
        scale.vector(3) if scale.present else np.ones(3),
    )


def _decompose(field: Field, matrix: Floats) -> tuple[Floats, Floats, Floats]:
    linear = matrix[:3, :3]
    scale = np.linalg.norm(linear, axis=0)
    if scale.min() < 1e-9:
        raise field.wrong("an invertible transform")
    if np.linalg.det(linear / scale) < 0.0:
        scale[0] = -scale[0]
    axes = linear / scale
    if not np.allclose(axes.T @ axes, np.eye(3), atol=1e-3):
        raise field.wrong("a translation, rotation and scale without shear")
    return matrix[:3, 3].copy(), quaternion.from_matrix(axes), scale
