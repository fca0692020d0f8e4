"""The file: glTF 2.0 binary with the VRMC_vrm 1.0 extension."""

import json
import struct
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bones import PARENTS
from make_stock_avatar.fields import Array
from make_stock_avatar.polygonise import Mesh
from make_stock_avatar.rest import BONES, INDEX, POSITIONS

Json = dict[str, Any]
_FLOAT, _U16, _U8 = 5126, 5123, 5121
_GRID = 2.0**-17  # metres; positions are rounded to it, so that the last bits of the mathematics library do not show


@dataclass(frozen=True)
class Material:
    """A plain PBR material."""

    name: str
    colour: tuple[float, float, float]  # linear RGB
    roughness: float = 0.8
    glow: float = 0.0  # share of the colour that shows in full shade, as light that scatters below skin
    double_sided: bool = False


@dataclass(frozen=True, eq=False)
class Part:
    """One primitive: a mesh with its material, colours, weights and shapes."""

    mesh: Mesh
    material: Material
    colours: Array  # (V, 3) linear RGB, multiplied with the material's
    joints: NDArray[np.uint8]  # (V, 4)
    weights: NDArray[np.uint8]  # (V, 4) in 1/255
    targets: dict[str, Array] = field(default_factory=dict)  # name -> (V, 3)


@dataclass(frozen=True, eq=False)
class Figure:
    """What goes into the file: named meshes of parts; the parts of one mesh have the same targets."""

    meshes: dict[str, tuple[Part, ...]]
    vrm: Json  # the VRMC_vrm extension without its humanoid


class _Buffer:
    """Accessors over one growing binary chunk."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[Json] = []
        self.accessors: list[Json] = []

    def add(self, array: NDArray[Any], kind: str, component: int, target: int | None = None, **extra: Any) -> int:
        view: Json = {"buffer": 0, "byteOffset": len(self.data), "byteLength": array.nbytes}
        if target is not None:
            view["target"] = target
        self.data += np.ascontiguousarray(array).tobytes()
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append(view)
        self.accessors.append(
            {
                "bufferView": len(self.views) - 1,
                "componentType": component,
                "count": array.size if kind == "SCALAR" else len(array),
                "type": kind,
                **extra,
            }
        )
        return len(self.accessors) - 1

    def vectors(self, points: Array, bounded: bool) -> int:
        rounded = (np.round(points / _GRID) * _GRID + 0.0).astype("<f4")
        bounds = {"min": rounded.min(axis=0).tolist(), "max": rounded.max(axis=0).tolist()} if bounded else {}
        return self.add(rounded, "VEC3", _FLOAT, 34962, **bounds)

    def directions(self, unit: Array) -> int:
        rounded = np.round(unit * 2.0**12) / 2.0**12
        rounded /= np.linalg.norm(rounded, axis=1, keepdims=True)
        return self.add((rounded + 0.0).astype("<f4"), "VEC3", _FLOAT, 34962)


def glb(figure: Figure) -> bytes:
    """The bytes of the VRM file."""
    buffer = _Buffer()
    materials = _materials(figure)
    meshes = [_mesh(buffer, name, parts, materials) for name, parts in figure.meshes.items()]
    inverse = np.tile(np.eye(4), (len(BONES), 1, 1))
    inverse[:, 3, :3] = [[-v for v in POSITIONS[bone]] for bone in BONES]  # column-major translation
    matrices = buffer.add(inverse.astype("<f4").reshape(len(BONES), 16), "MAT4", _FLOAT)
    document = {
        "asset": {"version": "2.0", "generator": "Elbowroom make_stock_avatar"},
        "extensionsUsed": ["VRMC_vrm"],
        "scene": 0,
        "scenes": [{"nodes": [0, *range(len(BONES), len(BONES) + len(meshes))]}],
        "nodes": [*_joint_nodes(), *_mesh_nodes(figure)],
        "meshes": meshes,
        "skins": [{"joints": list(range(len(BONES))), "inverseBindMatrices": matrices, "skeleton": 0}],
        "materials": [_material(m) for m in materials],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
        "extensions": {"VRMC_vrm": {"specVersion": "1.0", **figure.vrm, "humanoid": _humanoid()}},
    }
    return _container(document, bytes(buffer.data))


def _joint_nodes() -> list[Json]:
    nodes: list[Json] = []
    for bone in BONES:
        parent = PARENTS[bone]
        while parent is not None and parent not in INDEX:
            parent = PARENTS[parent]
        origin = np.zeros(3) if parent is None else np.array(POSITIONS[parent])
        local = np.round(np.array(POSITIONS[bone]) - origin, 6) + 0.0
        nodes.append({"name": bone, "translation": local.tolist()})
        if parent is not None:
            nodes[INDEX[parent]].setdefault("children", []).append(INDEX[bone])
    return nodes


def _mesh_nodes(figure: Figure) -> list[Json]:
    return [{"name": name, "mesh": i, "skin": 0} for i, name in enumerate(figure.meshes)]


def mesh_node(figure_meshes: list[str], name: str) -> int:
    """The node that shows a mesh."""
    return len(BONES) + figure_meshes.index(name)


def _humanoid() -> Json:
    return {"humanBones": {bone: {"node": INDEX[bone]} for bone in BONES}}


def _materials(figure: Figure) -> list[Material]:
    return list(dict.fromkeys(part.material for parts in figure.meshes.values() for part in parts))


def _material(material: Material) -> Json:
    document: Json = {
        "name": material.name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*material.colour, 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": material.roughness,
        },
    }
    if material.glow:
        document["emissiveFactor"] = [
            round(material.glow * c * w, 5) for c, w in zip(material.colour, (1.0, 0.8, 0.72), strict=True)
        ]
    if material.double_sided:
        document["doubleSided"] = True
    return document


def _mesh(buffer: _Buffer, name: str, parts: tuple[Part, ...], materials: list[Material]) -> Json:
    names = sorted(parts[0].targets)
    primitives = [_primitive(buffer, part, names, materials) for part in parts]
    document: Json = {"name": name, "primitives": primitives}
    if names:
        document["weights"] = [0.0] * len(names)
        document["extras"] = {"targetNames": names}
    return document


def _primitive(buffer: _Buffer, part: Part, names: list[str], materials: list[Material]) -> Json:
    mesh = part.mesh
    colours = np.full((len(mesh.points), 4), 255, np.uint8)
    colours[:, :3] = np.round(np.clip(part.colours, 0.0, 1.0) * 255.0)
    document: Json = {
        "attributes": {
            "POSITION": buffer.vectors(mesh.points, bounded=True),
            "NORMAL": buffer.directions(mesh.normals),
            "COLOR_0": buffer.add(colours, "VEC4", _U8, 34962, normalized=True),
            "JOINTS_0": buffer.add(part.joints, "VEC4", _U8, 34962),
            "WEIGHTS_0": buffer.add(part.weights, "VEC4", _U8, 34962, normalized=True),
        },
        "indices": buffer.add(mesh.triangles.astype("<u2").ravel(), "SCALAR", _U16, 34963),
        "material": materials.index(part.material),
    }
    if names:
        document["targets"] = [{"POSITION": buffer.vectors(part.targets[name], bounded=True)} for name in names]
    return document


def _container(document: Json, binary: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    length = 12 + 8 + len(text) + 8 + len(binary)
    head = struct.pack("<4sII", b"glTF", 2, length)
    return head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
