"""The VRM extensions of a glTF file: humanoid bones, meta data, and the nodes that swing by themselves.

Sources: VRM 0.x schema (github.com/vrm-c/vrm-specification, specification/0.0) and VRM 1.0 (`VRMC_vrm`,
`VRMC_springBone`). VRM 0.x called the thumb's three bones Proximal, Intermediate and Distal; 1.0 calls them
Metacarpal, Proximal and Distal.
"""

import math
from dataclasses import dataclass, field

from elbowroom.errors import InputError
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf

VRM_0, VRM_1 = "VRM 0.x", "VRM 1.0"

_OLD_THUMB = {
    f"{side}Thumb{old}": f"{side}Thumb{new}"
    for side in ("left", "right")
    for old, new in (("Proximal", "Metacarpal"), ("Intermediate", "Proximal"), ("Distal", "Distal"))
}


@dataclass(frozen=True)
class Vrm:
    """What a VRM file says beyond glTF."""

    version: str  # "VRM 0.x" or "VRM 1.0"
    bones: dict[str, int]  # VRM 1.0 bone name -> node; names are not checked here
    spring_nodes: frozenset[int]  # nodes (roots of chains in 0.x) that spring simulation moves: hair, skirts
    title: str = ""
    authors: tuple[str, ...] = ()
    licence: str = ""
    meta: dict[str, str | bool] = field(default_factory=dict)  # all texts and flags of the meta data

    @property
    def facing(self) -> float:
        """The heading in radians that the figure faces in its file: VRM 0.x looks along -Z, 1.0 along +Z."""
        return math.pi if self.version == VRM_0 else 0.0


def read_vrm(gltf: Gltf, nodes: int) -> Vrm | None:
    """The VRM extension, or None for a plain glTF; `nodes` is the number of nodes. Raises `InputError`."""
    extensions = gltf.root.at("extensions")
    if extensions.at("VRMC_vrm").present:
        return _read_1(extensions, nodes)
    if extensions.at("VRM").present:
        return _read_0(extensions.at("VRM"), nodes)
    return None


def _read_1(extensions: Field, nodes: int) -> Vrm:
    vrm = extensions.at("VRMC_vrm")
    human_bones = vrm.at("humanoid").at("humanBones")
    references = [(name, human_bones.at(name).at("node")) for name in human_bones.names(1000)]
    if any(name.endswith("ThumbIntermediate") for name, _ in references):  # files of the 1.0 beta
        references = [(_OLD_THUMB.get(name, name), reference) for name, reference in references]
    meta = vrm.at("meta")
    springs = extensions.at("VRMC_springBone").at("springs").items()
    moved = {joint.at("node").integer(0, nodes - 1) for spring in springs for joint in spring.at("joints").items()}
    return Vrm(
        version=VRM_1,
        bones=_nodes_of(references, human_bones, nodes),
        spring_nodes=frozenset(moved),
        title=meta.at("name").text(),
        authors=tuple(author.text() for author in meta.at("authors").items(100)),
        licence=meta.at("licenseUrl").text(),
        meta=_said(meta),
    )


def _read_0(vrm: Field, nodes: int) -> Vrm:
    human_bones = vrm.at("humanoid").at("humanBones")
    named = [(bone.at("bone").text(), bone.at("node")) for bone in human_bones.items(1000)]
    references = [(_OLD_THUMB.get(name, name), node) for name, node in named if node.value != -1]
    meta = vrm.at("meta")
    groups = vrm.at("secondaryAnimation").at("boneGroups").items()
    moved = {bone.integer(-1, nodes - 1) for group in groups for bone in group.at("bones").items()} - {-1}
    author = meta.at("author").text()
    return Vrm(
        version=VRM_0,
        bones=_nodes_of(references, human_bones, nodes),
        spring_nodes=frozenset(moved),
        title=meta.at("title").text(),
        authors=(author,) if author else (),
        licence=meta.at("licenseName").text(),
        meta=_said(meta),
    )


def _said(meta: Field) -> dict[str, str | bool]:
    """The members of the meta data that are texts or flags."""
    fields = {name: meta.at(name) for name in meta.names(200)}
    return {
        name: value.value if isinstance(value.value, bool) else value.text()
        for name, value in fields.items()
        if isinstance(value.value, str | bool)
    }


def _nodes_of(references: list[tuple[str, Field]], place: Field, nodes: int) -> dict[str, int]:
    bones: dict[str, int] = {}
    for name, reference in references:
        node = reference.integer(0, nodes - 1)
        if name in bones:
            raise InputError(f"{place.place} names the bone {name!r} twice (nodes {bones[name]} and {node})")
        if node in bones.values():
            other = next(bone for bone, used in bones.items() if used == node)
            raise InputError(f"{place.place}: node {node} is both {other!r} and {name!r}")
        bones[name] = node
    return bones


def read_vrm_animation(gltf: Gltf, nodes: int) -> dict[str, int] | None:
    """The bones (VRM 1.0 names -> node) of a VRM animation, or None for any other glTF; its rest pose is the T-pose.

    Source: `VRMC_vrm_animation` 1.0 (github.com/vrm-c/vrm-specification). Raises `InputError`.
    """
    extension = gltf.root.at("extensions").at("VRMC_vrm_animation")
    if not extension.present:
        return None
    human_bones = extension.at("humanoid").at("humanBones")
    references = [(name, human_bones.at(name).at("node")) for name in human_bones.names(1000)]
    return _nodes_of(references, human_bones, nodes)
