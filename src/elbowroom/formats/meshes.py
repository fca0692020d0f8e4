"""The surface of an asset as points, each riding rigidly on one node: the joint with the greatest weight."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.accessors import read_accessor
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.nodes import NodeTree
from elbowroom.formats.primitives import Primitive, morphs_of

_MAX_POINTS = 5_000_000
_MAX_PRIMITIVES = 100_000


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Vertices in the axes and units of the nodes that carry them, so they are known in every pose."""

    nodes: NDArray[np.int64]  # (P,) node that carries the point
    offsets: NDArray[np.float64]  # (P, 3) in the axes of that node
    skinned: NDArray[np.bool_]  # (P,) False for a mesh that hangs on its node as a whole


@dataclass(frozen=True, eq=False)
class Skin:
    """The joints of a skin, and where they were when the mesh was bound to them."""

    joints: NDArray[np.int64]  # (S,) node of each slot
    inverse_binds: NDArray[np.float64]  # (S, 4, 4), maybe more than slots


def surface_points(gltf: Gltf, tree: NodeTree) -> SurfacePoints:
    """All vertices of all meshes that nodes show; vertices shared by several primitives are taken once."""
    skins: dict[int, Skin] = {}
    parts: list[tuple[NDArray[np.int64], NDArray[np.float64], bool]] = []
    total = 0
    for node, field in _shown(gltf, tree):
        primitive = Primitive(gltf, field, morphs_of(gltf, node, int(tree.meshes[node])))
        points = primitive.positions()
        total += len(points)
        if total > _MAX_POINTS:
            raise InputError(f"{gltf.name}: the meshes have more than {_MAX_POINTS} vertices")
        index = int(tree.skins[node])
        if index < 0:
            parts.append((np.full(len(points), node, dtype=np.int64), points, False))
            continue
        if index not in skins:
            skins[index] = read_skin(gltf, index, len(tree))
        parts.append((*_skinned(primitive, points, skins[index]), True))
    return SurfacePoints(
        nodes=np.concatenate([np.zeros(0, np.int64), *(nodes for nodes, _, _ in parts)]),
        offsets=np.concatenate([np.zeros((0, 3)), *(offsets for _, offsets, _ in parts)]),
        skinned=np.concatenate([np.zeros(0, bool), *(np.full(len(n), skinned) for n, _, skinned in parts)]),
    )


def skin_joints(gltf: Gltf, tree: NodeTree) -> set[int]:
    """The nodes that are joints of any skin."""
    return {
        joint.integer(0, len(tree) - 1) for skin in gltf.root.at("skins").items() for joint in skin.at("joints").items()
    }


def _shown(gltf: Gltf, tree: NodeTree) -> Iterator[tuple[int, Field]]:
    """Each node with each primitive it shows; those that share their vertices only once."""
    meshes = gltf.root.at("meshes")
    seen: set[tuple[object, ...]] = set()
    examined = 0
    for node in map(int, np.flatnonzero(tree.meshes >= 0)):
        for primitive in meshes.pick(Field(int(tree.meshes[node]), gltf.name)).at("primitives").items():
            examined += 1
            if examined > _MAX_PRIMITIVES:
                raise InputError(f"{gltf.name}: the nodes show more than {_MAX_PRIMITIVES} primitives")
            attributes = primitive.at("attributes")
            key = (node, *(str(attributes.at(name).value) for name in ("POSITION", "JOINTS_0", "WEIGHTS_0")))
            if key not in seen and attributes.at("POSITION").present:
                seen.add(key)
                yield node, primitive


def read_skin(gltf: Gltf, index: int, nodes: int) -> Skin:
    """The skin `index` of a file with that many nodes."""
    skin = gltf.root.at("skins").pick(Field(index, gltf.name))
    joints = np.array([joint.integer(0, nodes - 1) for joint in skin.at("joints").items(nodes)], dtype=np.int64)
    field = skin.at("inverseBindMatrices")
    if not field.present:
        return Skin(joints, np.tile(np.eye(4), (len(joints), 1, 1)))
    matrices = read_accessor(gltf, field, "MAT4").reshape(-1, 4, 4).transpose(0, 2, 1)
    if len(matrices) < len(joints):
        raise InputError(f"{field.place} has {len(matrices)} matrices for {len(joints)} joints")
    return Skin(joints, matrices)


def _skinned(
    primitive: Primitive, points: NDArray[np.float64], skin: Skin
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The nodes (P,) of the joints with the greatest weight, and the points in their axes."""
    slots, weights = primitive.influences(len(points), len(skin.joints))
    slot = np.take_along_axis(slots, np.argmax(weights, axis=1)[:, None], axis=1)[:, 0]
    bind = skin.inverse_binds[slot]
    with np.errstate(all="ignore"):
        offsets = np.einsum("pij,pj->pi", bind[:, :3, :3], points) + bind[:, :3, 3]
    return skin.joints[slot], offsets
