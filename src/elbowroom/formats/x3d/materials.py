"""Appearance nodes as glTF materials."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.glb_draft import GlbDraft
from elbowroom.formats.x3d.files import FilesBeside
from elbowroom.formats.x3d.model import Node, Notes
from elbowroom.formats.x3d.pictures import mime_of, pixel_texture

Floats = NDArray[np.float64]

_GREY = (0.8, 0.8, 0.8)
_BLACK = (0.0, 0.0, 0.0)
_WHITE = (1.0, 1.0, 1.0)
_REPEAT, _CLAMP = 10497, 33071


class Materials:
    """Makes one glTF material for each Appearance and way of use."""

    def __init__(self, draft: GlbDraft, beside: FilesBeside, notes: Notes) -> None:
        self._draft, self._beside, self._notes = draft, beside, notes
        self._made: dict[tuple[int, bool, bool, bool], int] = {}
        self._textures: dict[int, int | None] = {}

    def material(self, appearance: Node | None, coloured: bool, textured: bool, two_sided: bool) -> int:
        """The glTF material of a shape, with colours at its vertices, texture coordinates, both sides shown."""
        key = (id(appearance), coloured, textured, two_sided)
        if key not in self._made:
            self._made[key] = self._draft.add("materials", self._described(appearance, coloured, textured, two_sided))
        return self._made[key]

    def _described(self, appearance: Node | None, coloured: bool, textured: bool, two_sided: bool) -> dict[str, Any]:
        material = appearance.node("material") if appearance else None
        texture = self._texture(appearance.node("texture")) if appearance and textured else None
        colour = np.array(_WHITE) if material is None else _colour(material)
        surface: dict[str, Any] = {"metallicFactor": 0.0, "roughnessFactor": 0.9}
        found: dict[str, Any] = {"pbrMetallicRoughness": surface}
        if material is not None and material.kind == "PhysicalMaterial":
            surface["metallicFactor"] = _share(material.number("metallic", 1.0))
            surface["roughnessFactor"] = _share(material.number("roughness", 1.0))
        elif material is not None:
            surface["roughnessFactor"] = 1.0 - 0.6 * _share(material.number("shininess", 0.2))
            emitted = _linear(material.vector("emissiveColor", _BLACK))
            if emitted.any():
                found["emissiveFactor"] = emitted.tolist()
        if texture is not None:
            surface["baseColorTexture"] = {"index": texture}
            if material is None or material.kind == "Material":
                colour = np.array(_WHITE)  # a texture's colour takes the place of the material's (17.2.2.4)
        opacity = 1.0 - _share(material.number("transparency", 0.0) if material else 0.0)
        surface["baseColorFactor"] = [*([1.0] * 3 if coloured else _linear(colour)), opacity]
        if opacity < 0.995:
            found["alphaMode"] = "BLEND"
        if two_sided:
            found["doubleSided"] = True
        return found

    def _texture(self, node: Node | None) -> int | None:
        if node is None:
            return None
        if id(node) not in self._textures:
            self._textures[id(node)] = self._read_texture(node)
        return self._textures[id(node)]

    def _read_texture(self, node: Node) -> int | None:
        if node.kind == "PixelTexture":
            data = pixel_texture(node)
        elif node.kind == "ImageTexture":
            data = self._beside.picture(node.strings("url"), node)
        else:
            self._notes.add(f"{node.place} is left out: only ImageTexture and PixelTexture are shown")
            return None
        if data is None:
            return None
        mime = mime_of(data)
        if mime is None:
            self._notes.add(f"{node.place} is left out: only PNG and JPEG pictures are shown")
            return None
        wraps = [_REPEAT if node.flag(name, True) else _CLAMP for name in ("repeatS", "repeatT")]
        sampler = self._draft.add("samplers", {"wrapS": wraps[0], "wrapT": wraps[1]})
        picture = self._draft.add_picture(data, mime)
        return self._draft.add("textures", {"source": picture, "sampler": sampler})


def linear_colours(colours: Floats) -> Floats:
    """Vertex colours RGBA (n, 4) as glTF wants them."""
    return np.column_stack([_linear(colours[:, :3]), colours[:, 3]])


def _colour(material: Node) -> Floats:
    if material.kind == "PhysicalMaterial":
        return material.vector("baseColor", _WHITE)
    if material.kind == "UnlitMaterial":
        return material.vector("emissiveColor", _WHITE)
    return material.vector("diffuseColor", _GREY)


def _linear(colour: Floats) -> Floats:
    """sRGB to linear (IEC 61966-2-1): X3D's colours are those of the screen, glTF's are not."""
    c = np.clip(colour, 0.0, 1.0)
    linear: Floats = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    return linear


def _share(value: float) -> float:
    return float(np.clip(value, 0.0, 1.0))
