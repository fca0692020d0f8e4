"""A GLB taken apart so that things can be added to it: its JSON, and its own buffer to append to."""

import base64
import copy
from typing import Any

from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.packing import write_glb


class OpenGlb:
    """The content of a GLB, free to be changed until it is `closed`."""

    def __init__(self, glb: bytes) -> None:
        gltf = parse_gltf(glb, "glb")
        self.content: dict[str, Any] = copy.deepcopy(gltf.root.value)  # the JSON
        buffers = self.content.setdefault("buffers", [])
        self._apart = bool(buffers) and (
            "uri" in buffers[0] or gltf.buffers[0] is None
        )  # only the first can be the GLB's own
        self.buffer = len(buffers) if self._apart else 0  # the number of the buffer that is appended to
        self.data = bytearray(gltf.buffers[0] or b"" if buffers and not self._apart else b"")  # what is in it
        if self.buffer == len(buffers):
            buffers.append({})

    def append(self, data: bytes | bytearray) -> int:
        """Add data to the buffer, on a border of four bytes; returns where it starts."""
        self.data.extend(b"\x00" * (-len(self.data) % 4))
        start = len(self.data)
        self.data.extend(data)
        return start

    def roots(self) -> list[int]:
        """The nodes at the top of the scene that is shown, to be changed."""
        nodes = self.content["nodes"]
        below = {child for node in nodes for child in node.get("children", [])}
        whole = [{"nodes": [node for node in range(len(nodes)) if node not in below]}]
        scene = self.content.setdefault("scenes", whole)[self.content.setdefault("scene", 0)]
        found: list[int] = scene.setdefault("nodes", [])
        return found

    def closed(self) -> bytes:
        """The GLB as it is now."""
        if not self.data:
            del self.content["buffers"][self.buffer :]
            if not self.content["buffers"]:
                del self.content["buffers"]
            return write_glb(self.content, b"")
        buffer = self.content["buffers"][self.buffer]
        buffer["byteLength"] = len(self.data)
        if not self._apart:
            return write_glb(self.content, bytes(self.data))
        buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        return write_glb(self.content, b"")
