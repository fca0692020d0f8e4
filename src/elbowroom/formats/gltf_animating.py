"""Adds an animation to a GLB: key frames for some of its nodes, at even steps of time (glTF 2.0, 3.11)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.open_glb import OpenGlb

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
    opened = OpenGlb(glb)
    roots, nodes, numbers = opened.roots(), opened.content["nodes"], []
    for stand in reversed(stands):
        node = {"name": stand.name, "children": list(roots), "translation": stand.translation.tolist()}
        nodes.append(node | {"rotation": stand.rotation.tolist(), "scale": [stand.scale] * 3})
        roots[:] = [len(nodes) - 1]
        numbers.append(len(nodes) - 1)
    return opened.closed(), numbers[::-1]


def with_animation(glb: bytes, name: str, frame_time: float, motions: Sequence[NodeMotion]) -> bytes:
    """The GLB with one more animation, before those that it has."""
    opened = OpenGlb(glb)
    tracks = _tracks_of(opened, glb, frame_time, motions)
    animation = {"name": name, "samplers": tracks.samplers, "channels": tracks.channels}
    opened.content["animations"] = [animation, *opened.content.get("animations", [])]
    return opened.closed()


def joined_animation(glb: bytes, frame_time: float, motions: Sequence[NodeMotion]) -> bytes:
    """The GLB whose first animation moves these nodes too; they are none of those that it moves."""
    opened = OpenGlb(glb)
    tracks, first = _tracks_of(opened, glb, frame_time, motions), opened.content["animations"][0]
    shift = len(first["samplers"])
    first["channels"] += [channel | {"sampler": channel["sampler"] + shift} for channel in tracks.channels]
    first["samplers"] += tracks.samplers
    return opened.closed()


def _tracks_of(opened: OpenGlb, glb: bytes, frame_time: float, motions: Sequence[NodeMotion]) -> "_Tracks":
    """The tracks of some nodes, their numbers appended to the GLB, and the nodes made ready to move."""
    tracks, tree = _Tracks(opened), read_nodes(parse_gltf(glb, "glb"))
    for motion in motions:
        node = opened.content["nodes"][motion.node]
        if node.pop("matrix", None) is not None:  # nodes that move have no matrix
            node |= {"scale": tree.scales[motion.node].tolist(), "rotation": tree.rotations[motion.node].tolist()}
            node["translation"] = tree.translations[motion.node].tolist()
        if motion.rotations is not None:
            tracks.add(motion.node, "rotation", continuous(motion.rotations), frame_time)
        if motion.translations is not None:
            tracks.add(motion.node, "translation", motion.translations, frame_time)
    return tracks


def continuous(rotations: Floats) -> Floats:
    """The same rotations (F, 4) with signs such that neighbours lie on the same side: programs that mix them can."""
    opposed = np.sum(rotations[1:] * rotations[:-1], axis=1) < 0.0
    signs = np.concatenate([[1.0], np.where(np.cumsum(opposed) % 2 == 1, -1.0, 1.0)])
    turned: Floats = rotations * signs[:, None]
    return turned


class _Tracks:
    """Collects samplers and channels; their numbers are appended to the GLB."""

    def __init__(self, opened: OpenGlb) -> None:
        self.samplers: list[dict[str, Any]] = []
        self.channels: list[dict[str, Any]] = []
        self._opened, self._times = opened, dict[int, int]()

    def add(self, node: int, path: str, values: Floats, frame_time: float) -> None:
        """A track of a node."""
        keys = values if np.ptp(values, axis=0).max() > _STILL else values[:1]
        if len(keys) not in self._times:
            self._times[len(keys)] = self._accessor(np.arange(len(keys))[:, None] * frame_time, bounds=True)
        sampler = {"input": self._times[len(keys)], "output": self._accessor(keys), "interpolation": "LINEAR"}
        self.channels.append({"sampler": len(self.samplers), "target": {"node": node, "path": path}})
        self.samplers.append(sampler)

    def _accessor(self, values: NDArray[np.floating], bounds: bool = False) -> int:
        data, opened = np.ascontiguousarray(values, "<f4"), self._opened
        views, accessors = (opened.content.setdefault(key, []) for key in ("bufferViews", "accessors"))
        start = opened.append(data.tobytes())
        views.append({"buffer": opened.buffer, "byteOffset": start, "byteLength": data.nbytes})
        accessor: dict[str, Any] = {"bufferView": len(views) - 1, "componentType": _FLOAT, "count": len(data)}
        if bounds:
            accessor |= {"min": data.min(axis=0).tolist(), "max": data.max(axis=0).tolist()}
        accessors.append(accessor | {"type": _KINDS[data.shape[1]]})
        return len(accessors) - 1
