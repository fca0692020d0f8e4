"""The surface of an asset as points, each riding rigidly on one node: the joint with the greatest weight."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.accessors import read_accessor
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.nodes import NodeTree

_MAX_POINTS = 5_000_000
_COMPRESSION = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Vertices in the axes and units of the nodes that carry them, so they are known in every pose."""

    nodes: NDArray[np.int64]  # (P,) node that carries the point
    offsets: NDArray[np.float64]  # (P, 3) in the axes of that node
    skinned: NDArray[np.bool_]  # (P,) False for a mesh that hangs on its node as a whole


def compression(gltf: Gltf) -> str | None:
    """The name of a mesh compression that the file uses and we do not read, if there is one."""
    used = {field.text() for key in ("extensionsRequired", "extensionsUsed") for field in gltf.root.at(key).items()}
    return next((name for name in _COMPRESSION if name in used), None)


def surface_points(gltf: Gltf, tree: NodeTree) -> SurfacePoints:
    """All vertices of all meshes that nodes show; vertices shared by several primitives are taken once."""
    meshes, skins = gltf.root.at("meshes").items(), gltf.root.at("skins").items()
    parts: list[tuple[NDArray[np.int64], NDArray[np.float64], bool]] = []
    seen: set[tuple[object, ...]] = set()
    total = 0
    for node in np.flatnonzero(tree.meshes >= 0):
        skin = skins[tree.skins[node]] if tree.skins[node] >= 0 else None
        for primitive in meshes[tree.meshes[node]].at("primitives").items():
            attributes = primitive.at("attributes")
            keys = (int(node), *(str(attributes.at(key).value) for key in ("POSITION", "JOINTS_0", "WEIGHTS_0")))
            if keys in seen or not attributes.at("POSITION").present:
                continue
            seen.add(keys)
            part = _skinned(gltf, attributes, skin, len(tree)) if skin else _rigid(gltf, attributes, int(node))
            parts.append((*part, skin is not None))
            total += len(part[0])
            if total > _MAX_POINTS:
                raise InputError(f"{gltf.name}: the meshes have more than {_MAX_POINTS} vertices")
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


def _rigid(gltf: Gltf, attributes: Field, node: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    points = read_accessor(gltf, attributes.at("POSITION"), "VEC3")
    return np.full(len(points), node, dtype=np.int64), points


def _skinned(gltf: Gltf, attributes: Field, skin: Field, nodes: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    points = read_accessor(gltf, attributes.at("POSITION"), "VEC3")
    slots = _dominant_slots(gltf, attributes, len(points))
    joints = np.array([j.integer(0, nodes - 1) for j in skin.at("joints").items(nodes)], dtype=np.int64)
    if slots.max(initial=0) >= len(joints):
        raise InputError(f"{attributes.place}.JOINTS_0 points to joint {slots.max()} of {len(joints)}")
    offsets = points
    if skin.at("inverseBindMatrices").present:
        matrices = read_accessor(gltf, skin.at("inverseBindMatrices"), "MAT4").reshape(-1, 4, 4).transpose(0, 2, 1)
        if len(matrices) < len(joints):
            raise InputError(f"{skin.place}.inverseBindMatrices has {len(matrices)} matrices for {len(joints)} joints")
        bind = matrices[slots]
        with np.errstate(all="ignore"):
            offsets = np.einsum("pij,pj->pi", bind[:, :3, :3], points) + bind[:, :3, 3]
    return joints[slots], offsets


def _dominant_slots(gltf: Gltf, attributes: Field, count: int) -> NDArray[np.int64]:
    """For every vertex the skin slot with the greatest weight (of all JOINTS_n / WEIGHTS_n sets)."""
    joints, weights = [], []
    for index in range(4):
        slot_field, weight_field = attributes.at(f"JOINTS_{index}"), attributes.at(f"WEIGHTS_{index}")
        if not slot_field.present:
            break
        joints.append(read_accessor(gltf, slot_field, "VEC4"))
        weights.append(read_accessor(gltf, weight_field, "VEC4"))
    if not joints or any(len(values) != count for values in joints + weights):
        raise InputError(f"{attributes.place}: JOINTS_n and WEIGHTS_n are needed for each of the {count} vertices")
    best = np.argmax(np.concatenate(weights, axis=1), axis=1)
    slots = np.take_along_axis(np.concatenate(joints, axis=1), best[:, None], axis=1)[:, 0].astype(np.int64)
    if slots.min(initial=0) < 0:
        raise InputError(f"{attributes.place}.JOINTS_0 has a negative joint")
    return slots
