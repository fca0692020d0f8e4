"""The surface of an asset as triangles, with every joint that moves each vertex: for linear blend skinning."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.instances import instances_of
from elbowroom.formats.nodes import NodeTree
from elbowroom.formats.primitives import Primitive, morphs_of
from elbowroom.formats.skins import Skin, read_skin

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_TRIANGLES = 4  # the first of the primitive modes with a surface


@dataclass(frozen=True)
class MeshBounds:
    """How much of a file is read."""

    vertices: int = 2_000_000
    triangles: int = 4_000_000
    primitives: int = 10_000


_BOUNDS = MeshBounds()


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Triangles whose vertices ride on K nodes each; unused places have weight 0."""

    triangles: Ints  # (T, 3) into the vertices
    nodes: Ints  # (V, K) nodes of the file
    weights: Floats  # (V, K) sum 1
    offsets: Floats  # (V, K, 3) the vertex in the axes and units of each of its nodes
    skinned: NDArray[np.bool_]  # (V,) False for a mesh that hangs on its node as a whole


def triangle_mesh(gltf: Gltf, tree: NodeTree) -> TriangleMesh:
    """All triangles that nodes show; points and lines are left out. Raises `InputError`."""
    return _joined([part for _, part in triangle_parts(gltf, tree)])


def triangle_parts(gltf: Gltf, tree: NodeTree, bounds: MeshBounds = _BOUNDS) -> Iterator[tuple[int, TriangleMesh]]:
    """The same as `triangle_mesh` one after the other: each node with a primitive that it shows."""
    skins: dict[int, Skin] = {}
    vertices = triangles = 0
    for node, primitive in _surfaces(gltf, tree, bounds.primitives):
        part, instances = _part(gltf, tree, node, primitive, skins), instances_of(gltf, node)
        times = 1 if instances is None else len(instances)
        vertices, triangles = vertices + times * len(part.nodes), triangles + times * len(part.triangles)
        if vertices > bounds.vertices or triangles > bounds.triangles:
            raise InputError(f"{gltf.name}: more than {bounds.vertices} vertices or {bounds.triangles} triangles")
        yield node, part if instances is None else _repeated(part, instances)


def _surfaces(gltf: Gltf, tree: NodeTree, most: int) -> Iterator[tuple[int, Field]]:
    """Each node with each primitive it shows."""
    meshes, seen = gltf.root.at("meshes"), 0
    for node in map(int, np.flatnonzero(tree.meshes >= 0)):
        for primitive in meshes.pick(Field(int(tree.meshes[node]), gltf.name)).at("primitives").items():
            seen += 1
            if seen > most:
                raise InputError(f"{gltf.name}: the nodes show more than {most} primitives")
            mode = primitive.at("mode").optional_integer(0, 6, _TRIANGLES)
            if mode >= _TRIANGLES and primitive.at("attributes").at("POSITION").present:
                yield node, primitive


def _part(gltf: Gltf, tree: NodeTree, node: int, field: Field, skins: dict[int, Skin]) -> TriangleMesh:
    primitive = Primitive(gltf, field, morphs_of(gltf, node, int(tree.meshes[node])))
    points = primitive.positions()
    triangles = primitive.triangles(len(points))
    index = int(tree.skins[node])
    if index < 0:
        riders = np.full((len(points), 1), node, dtype=np.int64)
        rigid = np.zeros(len(points), bool)
        return TriangleMesh(triangles, riders, np.ones((len(points), 1)), points[:, None], rigid)
    if index not in skins:
        skins[index] = read_skin(gltf, index, len(tree))
    skin = skins[index]
    slots, weights = primitive.influences(len(points), len(skin.joints))
    bind = skin.inverse_binds[slots]
    with np.errstate(all="ignore"):
        offsets = np.einsum("vkij,vj->vki", bind[..., :3, :3], points) + bind[..., :3, 3]
    return TriangleMesh(triangles, skin.joints[slots], weights, offsets, np.ones(len(points), bool))


def _repeated(part: TriangleMesh, instances: Floats) -> TriangleMesh:
    """The same N times over, each moved by one of the transforms (N, 4, 4) in the axes of its nodes."""
    many, count = len(instances), len(part.nodes)
    with np.errstate(all="ignore"):
        offsets = np.einsum("nij,vkj->nvki", instances[:, :3, :3], part.offsets) + instances[:, None, None, :3, 3]
    firsts = count * np.arange(many)[:, None, None]
    return TriangleMesh(
        triangles=(part.triangles + firsts).reshape(-1, 3),
        nodes=np.tile(part.nodes, (many, 1)),
        weights=np.tile(part.weights, (many, 1)),
        offsets=offsets.reshape(many * count, *part.offsets.shape[1:]),
        skinned=np.tile(part.skinned, many),
    )


def _joined(parts: list[TriangleMesh]) -> TriangleMesh:
    """One mesh; the joints of a vertex in order of weight, and no more places than are used."""
    width = max([1, *(part.nodes.shape[1] for part in parts)])
    starts = np.cumsum([0, *(len(part.nodes) for part in parts)])
    empty = TriangleMesh(
        np.zeros((0, 3), np.int64), np.zeros((0, width), np.int64), np.zeros((0, width)), np.zeros((0, width, 3)),
        np.zeros(0, bool),
    )  # fmt: skip
    wide = [empty, *(_widened(part, width) for part in parts)]
    nodes, weights = np.concatenate([p.nodes for p in wide]), np.concatenate([p.weights for p in wide])
    offsets = np.concatenate([p.offsets for p in wide])
    order = np.argsort(-weights, axis=1, kind="stable")
    used = int((weights > 0.0).sum(axis=1).max(initial=1))
    order = order[:, :used]
    return TriangleMesh(
        triangles=np.concatenate(
            [empty.triangles, *(p.triangles + at for p, at in zip(parts, starts[:-1], strict=True))]
        ),
        nodes=np.take_along_axis(nodes, order, axis=1),
        weights=np.take_along_axis(weights, order, axis=1),
        offsets=np.take_along_axis(offsets, order[:, :, None], axis=1),
        skinned=np.concatenate([p.skinned for p in wide]),
    )


def _widened(part: TriangleMesh, width: int) -> TriangleMesh:
    """The same with `width` places for each vertex: the new ones repeat the first joint with weight 0."""
    missing = width - part.nodes.shape[1]
    if missing == 0:
        return part
    return TriangleMesh(
        triangles=part.triangles,
        nodes=np.concatenate([part.nodes, np.repeat(part.nodes[:, :1], missing, axis=1)], axis=1),
        weights=np.pad(part.weights, ((0, 0), (0, missing))),
        offsets=np.concatenate([part.offsets, np.repeat(part.offsets[:, :1], missing, axis=1)], axis=1),
        skinned=part.skinned,
    )
