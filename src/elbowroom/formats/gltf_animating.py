"""Adds an animation to a GLB: key frames for some of its nodes, at even steps of time (glTF 2.0, 3.11)."""

import base64
import copy
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.packing import write_glb

Floats = NDArray[np.float64]

_FLOAT = 5126
_KINDS = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}
_STILL = 1e-7  # a track that varies less is one key frame


@dataclass(frozen=True, eq=False)
class NodeMotion:
    """What one node does."""

    node: int
    rotations: Floats | None = None  # (F, 4) local, xyzw
    translations: Floats | None = None  # (F, 3) local


@dataclass(frozen=True, eq=False)
class Stand:
    """A node to be put above all others of the shown scene."""

    name: str
    translation: Floats  # (3,)
    rotation: Floats  # (4,)
    scale: float


def on_stands(glb: bytes, stands: Sequence[Stand]) -> tuple[bytes, list[int]]:
    """The GLB with nodes above the roots of its scene, the first above all; and their numbers."""
    content, binary = _parts(glb)
    nodes = content["nodes"]
    scene = content.setdefault("scenes", [{"nodes": _roots(nodes)}])[content.setdefault("scene", 0)]
    children, numbers = scene.get("nodes", []), []
    for stand in reversed(stands):
        node = {"name": stand.name, "children": children, "translation": stand.translation.tolist()}
        nodes.append(node | {"rotation": stand.rotation.tolist(), "scale": [stand.scale] * 3})
        children = [len(nodes) - 1]
        numbers.append(len(nodes) - 1)
    scene["nodes"] = children
    return write_glb(content, bytes(binary)), numbers[::-1]


def with_animation(glb: bytes, name: str, frame_time: float, motions: Sequence[NodeMotion]) -> bytes:
    """The GLB with one more animation, before those that it has; nodes that move stand where the animation begins."""
    content, binary = _parts(glb)
    writer = _Tracks(content, binary)
    tree = read_nodes(parse_gltf(glb, "glb"))
    for motion in motions:
        node = content["nodes"][motion.node]
        if node.pop("matrix", None) is not None:  # nodes that move have no matrix
            node |= {"scale": tree.scales[motion.node].tolist(), "rotation": tree.rotations[motion.node].tolist()}
            node["translation"] = tree.translations[motion.node].tolist()
        if motion.rotations is not None:
            writer.add(motion.node, "rotation", continuous(motion.rotations), frame_time)
        if motion.translations is not None:
            writer.add(motion.node, "translation", motion.translations, frame_time)
    animation = {"name": name, "samplers": writer.samplers, "channels": writer.channels}
    content["animations"] = [animation, *content.get("animations", [])]
    writer.close()
    return write_glb(content, bytes(binary))


def continuous(rotations: Floats) -> Floats:
    """The same rotations (F, 4) with signs such that neighbours lie on the same side: programs that mix them can."""
    opposed = np.sum(rotations[1:] * rotations[:-1], axis=1) < 0.0
    signs = np.concatenate([[1.0], np.where(np.cumsum(opposed) % 2 == 1, -1.0, 1.0)])
    turned: Floats = rotations * signs[:, None]
    return turned


class _Tracks:
    """Collects samplers and channels; their numbers go to the end of the GLB's own buffer, or to one more."""

    def __init__(self, content: dict[str, Any], binary: bytearray) -> None:
        self.samplers: list[dict[str, Any]] = []
        self.channels: list[dict[str, Any]] = []
        self._content, self._times = content, dict[int, int]()
        buffers = content.setdefault("buffers", [])
        self._apart = bool(buffers) and "uri" in buffers[0]  # only the first buffer can be the GLB's own
        self._buffer = len(buffers) if self._apart or not buffers else 0
        self._data = bytearray() if self._apart else binary
        if self._buffer == len(buffers):
            buffers.append({})

    def add(self, node: int, path: str, values: Floats, frame_time: float) -> None:
        """A track of a node."""
        keys = values if np.ptp(values, axis=0).max() > _STILL else values[:1]
        if len(keys) not in self._times:
            self._times[len(keys)] = self._accessor(np.arange(len(keys))[:, None] * frame_time, bounds=True)
        sampler = {"input": self._times[len(keys)], "output": self._accessor(keys), "interpolation": "LINEAR"}
        self.channels.append({"sampler": len(self.samplers), "target": {"node": node, "path": path}})
        self.samplers.append(sampler)

    def close(self) -> None:
        """Tell how long the buffer has become."""
        buffer = self._content["buffers"][self._buffer]
        buffer["byteLength"] = len(self._data)
        if self._apart:
            buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(self._data).decode()

    def _accessor(self, values: NDArray[np.floating], bounds: bool = False) -> int:
        data = np.ascontiguousarray(values, "<f4")
        self._data.extend(b"\x00" * (-len(self._data) % 4))
        views, accessors = (self._content.setdefault(key, []) for key in ("bufferViews", "accessors"))
        views.append({"buffer": self._buffer, "byteOffset": len(self._data), "byteLength": data.nbytes})
        self._data.extend(data.tobytes())
        accessor: dict[str, Any] = {"bufferView": len(views) - 1, "componentType": _FLOAT, "count": len(data)}
        if bounds:
            accessor |= {"min": data.min(axis=0).tolist(), "max": data.max(axis=0).tolist()}
        accessors.append(accessor | {"type": _KINDS[data.shape[1]]})
        return len(accessors) - 1


def _parts(glb: bytes) -> tuple[dict[str, Any], bytearray]:
    """The JSON and the binary chunk of a GLB, free to be changed."""
    gltf = parse_gltf(glb, "glb")
    own = gltf.root.at("buffers").items()
    inside = bool(own) and not own[0].at("uri").present and gltf.buffers[0] is not None
    return copy.deepcopy(gltf.root.value), bytearray(gltf.buffers[0] or b"" if inside else b"")


def _roots(nodes: list[dict[str, Any]]) -> list[int]:
    below = {child for node in nodes for child in node.get("children", [])}
    return [node for node in range(len(nodes)) if node not in below]
