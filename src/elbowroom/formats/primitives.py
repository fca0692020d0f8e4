"""A primitive's vertices and triangles, however they are stored."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.accessors import WIDTHS, read_accessor, scaled
from elbowroom.formats.draco import EXTENSION, DracoMesh, read_draco
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_SETS = 2  # of JOINTS_n / WEIGHTS_n that are read: eight joints for a vertex
_TRIANGLES, _STRIP, _FAN = 4, 5, 6  # primitive modes with a surface
_MOST_TARGETS = 10_000  # morph targets of a mesh
_MOST_MORPHS = 16  # that are on at once; of more those with the greatest weights count
_UNMOVED: Mapping[int, float] = MappingProxyType({})


def morphs_of(gltf: Gltf, node: int, mesh: int) -> dict[int, float]:
    """The morph targets that the file has on for the mesh of a node, and their weights; raises `InputError`."""
    weights = gltf.root.at("nodes").pick(Field(node, gltf.name)).at("weights")
    if not weights.present:
        weights = gltf.root.at("meshes").pick(Field(mesh, gltf.name)).at("weights")
    values = weights.vector(len(weights.items(_MOST_TARGETS))) if weights.present else np.zeros(0)
    greatest = np.argsort(-np.abs(values), kind="stable")[:_MOST_MORPHS]
    return {int(number): float(values[number]) for number in greatest if values[number]}


class Primitive:
    """Reads one primitive; Draco's data is decoded once, when it is first asked for."""

    def __init__(self, gltf: Gltf, field: Field, morphs: Mapping[int, float] = _UNMOVED) -> None:
        self.field = field
        self._morphs = morphs
        self.attributes = field.at("attributes")
        self._gltf = gltf
        self._packed = field.at("extensions").at(EXTENSION)
        self._draco: DracoMesh | None = None

    def positions(self) -> Floats:
        """Vertices (V, 3), moved by the morph targets that are on; raises `InputError`."""
        points = self._attribute("POSITION", "VEC3")
        targets = self.field.at("targets").items(_MOST_TARGETS) if self._morphs else []
        for number, weight in self._morphs.items():
            moves = targets[number].at("POSITION") if number < len(targets) else None
            if moves is None or not moves.present:
                continue
            moved = read_accessor(self._gltf, moves, "VEC3")
            if len(moved) != len(points):
                raise InputError(f"{moves.place} has {len(moved)} vertices: {len(points)} are needed")
            points = points + weight * moved
        return points

    def triangles(self, count: int) -> Ints:
        """Vertex indices (T, 3) of a primitive with `count` vertices; raises `InputError`."""
        if self._packed.present:
            return self._checked(self._decoded().faces.reshape(-1), count).reshape(-1, 3)
        field = self.field.at("indices")
        order = np.arange(count)
        if field.present:
            order = self._checked(read_accessor(self._gltf, field, "SCALAR")[:, 0].astype(np.int64), count)
        mode = self.field.at("mode").optional_integer(0, 6, _TRIANGLES)
        if mode == _STRIP:
            return np.stack([order[:-2], order[1:-1], order[2:]], axis=1)
        if mode == _FAN:
            return np.stack([np.full(max(len(order) - 2, 0), order[0]), order[1:-1], order[2:]], axis=1)
        return order[: len(order) // 3 * 3].reshape(-1, 3)

    def influences(self, count: int, joints: int) -> tuple[Ints, Floats]:
        """Slots (V, K) of a skin with `joints` of them, and weights that sum to 1; raises `InputError`.

        A vertex without weight goes with its first joint.
        """
        slots, weights = [], []
        for index in range(_SETS):
            if not self.attributes.at(f"JOINTS_{index}").present:
                break
            slots.append(self._attribute(f"JOINTS_{index}", "VEC4"))
            weights.append(self._attribute(f"WEIGHTS_{index}", "VEC4"))
        if not slots or any(len(values) != count for values in slots + weights):
            place = self.attributes.place
            raise InputError(f"{place}: JOINTS_n and WEIGHTS_n are needed for each of the {count} vertices")
        weight, every = np.maximum(np.concatenate(weights, axis=1), 0.0), np.concatenate(slots, axis=1)
        slot = np.where(weight > 0.0, every, every[:, :1]).astype(np.int64)
        if slot.min() < 0 or slot.max() >= joints:
            raise InputError(f"{self.attributes.place}.JOINTS_0 points to joint {slot.max()} of {joints}")
        weight[weight.sum(axis=1) <= 0.0, 0] = 1.0
        return slot, weight / weight.sum(axis=1, keepdims=True)

    def _attribute(self, name: str, kind: str) -> Floats:
        field = self.attributes.at(name)
        if not self._packed.present or name not in self._decoded().attributes:
            return read_accessor(self._gltf, field, kind)
        values = self._decoded().attributes[name]
        values = values.reshape(len(values), -1)
        if values.shape[1] != WIDTHS[kind] or not len(values):
            raise InputError(f"{self._packed.place}: {name} has {values.shape[1]} components, not {WIDTHS[kind]}")
        return scaled(values, self._gltf.root.at("accessors").pick(field))

    def _decoded(self) -> DracoMesh:
        if self._draco is None:
            self._draco = read_draco(self._gltf, self._packed)
        return self._draco

    def _checked(self, order: Ints, count: int) -> Ints:
        if len(order) and (order.min() < 0 or order.max() >= count):
            raise InputError(f"{self.field.at('indices').place} points to vertex {order.max()} of {count}")
        return order
