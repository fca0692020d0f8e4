"""A glTF asset under construction, piece by piece, until it is written as one GLB."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.formats.packing import write_glb
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_KINDS = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}
_COMPONENTS = {"<f4": 5126, "<u4": 5125, "<u2": 5123}
_VERTICES, _INDICES = 34962, 34963


class GlbDraft:
    """Collects nodes, meshes, skins, materials and pictures; every `add_` returns the index of what it added."""

    def __init__(self) -> None:
        self.nodes: list[dict[str, Any]] = []
        self._content: dict[str, list[Any]] = {}
        self._roots: list[int] = []
        self._binary = bytearray()

    def add_node(
        self,
        name: str = "",
        parent: int | None = None,
        translation: ArrayLike = (0.0, 0.0, 0.0),
        rotation: ArrayLike = (0.0, 0.0, 0.0, 1.0),
        scale: ArrayLike = (1.0, 1.0, 1.0),
        **rest: Any,
    ) -> int:
        """A node below `parent` (None: a root); `rest` are further members, like `mesh`."""
        node: dict[str, Any] = {"name": name} if name else {}
        for key, value, neutral in (
            ("translation", translation, np.zeros(3)),
            ("rotation", rotation, quaternion.IDENTITY),
            ("scale", scale, np.ones(3)),
        ):
            if not np.array_equal(np.asarray(value), neutral):
                node[key] = np.asarray(value, np.float64).tolist()
        self.nodes.append(node | rest)
        index = len(self.nodes) - 1
        if parent is None:
            self._roots.append(index)
        else:
            self.nodes[parent].setdefault("children", []).append(index)
        return index

    def add(self, collection: str, item: Any) -> int:
        """Another element of `meshes`, `materials`, `skins` and the like."""
        items = self._content.setdefault(collection, [])
        items.append(item)
        return len(items) - 1

    def add_vertices(self, values: NDArray[Any], stored: str = "<f4", bounds: bool = False) -> int:
        """An accessor of vertex attributes or matrices; POSITION needs its `bounds`."""
        return self._accessor(values, stored, None if values.ndim == 3 else _VERTICES, bounds)

    def add_indices(self, triangles: NDArray[np.int64]) -> int:
        """An accessor of the vertices of triangles."""
        return self._accessor(triangles.reshape(-1), "<u4", _INDICES, False)

    def add_picture(self, data: bytes, mime: str) -> int:
        """An image inside the file."""
        return self.add("images", {"bufferView": self._view(data, None), "mimeType": mime})

    def finish(self, extensions: Mapping[str, Any] | None = None) -> bytes:
        """The GLB, with extensions of the whole asset by their names."""
        content: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "Elbowroom"},
            "scene": 0,
            "scenes": [{"nodes": self._roots}],
            "nodes": self.nodes,
            **self._content,
        }
        if extensions:
            content |= {"extensions": dict(extensions), "extensionsUsed": list(extensions)}
        if self._binary:
            content["buffers"] = [{"byteLength": len(self._binary)}]
        return write_glb(content, bytes(self._binary))

    def _accessor(self, values: NDArray[Any], stored: str, target: int | None, bounds: bool) -> int:
        written = np.ascontiguousarray(values, dtype=stored)
        accessor = {
            "bufferView": self._view(written.tobytes(), target),
            "componentType": _COMPONENTS[stored],
            "count": len(written),
            "type": _KINDS[written.shape[1:]],
        }
        if bounds:
            accessor |= {"min": written.min(axis=0).tolist(), "max": written.max(axis=0).tolist()}
        return self.add("accessors", accessor)

    def _view(self, data: bytes, target: int | None) -> int:
        self._binary.extend(b"\x00" * (-len(self._binary) % 4))
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(data)}
        self._binary.extend(data)
        return self.add("bufferViews", view if target is None else view | {"target": target})
