"""H-Anim humanoids as glTF with known bones: named, stood upright, and given a head where a robot has none."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import AvatarMeta
from elbowroom.body.loading.hanim_names import NamedBones, hanim_bones
from elbowroom.errors import InputError
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.hanim.figure import HanimFigure, parse_figure, read_figure
from elbowroom.formats.nodes import NodeTree, read_nodes
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_STRAIGHT = 0.7  # cosine between an axis and the way from hips to head, at which the axis is meant to be up
_HEAD = 0.052 / 0.288  # height of the head joint above the shoulders, of theirs above the hips; Drillis & Contini 1966
_LARGEST_LOA = 4
_JOINTS = ((144, 4), (94, 3), (71, 2), (14, 1))  # of a level of articulation, or a little fewer


@dataclass(frozen=True, eq=False)
class HanimAsset:
    """An H-Anim file as a glTF asset, with what is known about it."""

    gltf: Gltf
    bones: NamedBones
    meta: AvatarMeta  # without bones


def read_hanim(path: Path) -> HanimAsset:
    """The humanoid of an X3D or VRML97 file; raises `InputError`."""
    return _asset(read_figure(path))


def parse_hanim(data: bytes, name: str) -> HanimAsset:
    """The same for bytes that were sent to us."""
    return _asset(parse_figure(data, name))


def _asset(figure: HanimFigure) -> HanimAsset:
    if len(figure.joints) == 1:
        raise InputError(
            f"{figure.file}: the humanoid has one joint (level of articulation 0): arms and legs need joints (LOA 1)"
        )
    gltf = figure.gltf()
    tree = read_nodes(gltf)
    bones = hanim_bones(figure.joints, tree)
    notes = list(figure.notes)
    changed = _upright(figure, tree, bones.nodes, notes)
    if "head" not in bones.nodes and {"leftUpperArm", "rightUpperArm", "hips"} <= bones.nodes.keys():
        bones = _with_head(figure, tree, bones, notes)
        changed = True
    if changed:
        gltf = figure.gltf()
    return HanimAsset(gltf, bones, _meta(figure, tuple(notes)))


def _upright(figure: HanimFigure, tree: NodeTree, bones: dict[str, int], notes: list[str]) -> bool:
    """Turn the whole figure so that +Y is up, if another axis of the file is; whether it was turned."""
    if not {"hips", "leftUpperArm", "rightUpperArm"} <= bones.keys():
        return False
    places = tree.world_matrices(tree.rotations)[:, :3, 3]
    up = 0.5 * (places[bones["leftUpperArm"]] + places[bones["rightUpperArm"]]) - places[bones["hips"]]
    axis = int(np.argmax(np.abs(up)))
    if not np.isfinite(up).all() or abs(up[axis]) <= _STRAIGHT * np.linalg.norm(up) or (axis == 1 and up[1] > 0.0):
        return False
    direction = np.zeros(3)
    direction[axis] = np.sign(up[axis])
    figure.draft.nodes[figure.top]["rotation"] = quaternion.between(direction, [0.0, 1.0, 0.0]).tolist()
    notes.append(f"{'-' if up[axis] < 0 else '+'}{'XYZ'[axis]} is up in the file; the figure was turned")
    return True


def _with_head(figure: HanimFigure, tree: NodeTree, bones: NamedBones, notes: list[str]) -> NamedBones:
    """A head joint above the shoulders, on what carries both arms."""
    matrices = tree.world_matrices(tree.rotations)
    arms = [bones.nodes[f"{side}UpperArm"] for side in ("left", "right")]
    shared = [node for node in tree.ancestors(arms[0]) if node in tree.ancestors(arms[1])]
    if not shared:
        return bones
    shoulders = matrices[arms, :3, 3].mean(axis=0)
    place = shoulders + _HEAD * (shoulders - matrices[bones.nodes["hips"], :3, 3])
    carrier = matrices[shared[0]]
    if not np.isfinite(place).all() or abs(np.linalg.det(carrier[:3, :3])) < 1e-12:
        return bones
    node = figure.draft.add_node("head", shared[0], np.linalg.solve(carrier[:3, :3], place - carrier[:3, 3]))
    notes.append("there is no joint for the head; one was added above the shoulders")
    return NamedBones(bones.nodes | {"head": node}, bones.found_by | {"head": "added"}, bones.standard)


def _meta(figure: HanimFigure, notes: tuple[str, ...]) -> AvatarMeta:
    info = {key.lower(): value for key, value in figure.info.items()}
    authors = next((info[key] for key in ("authorname", "author", "creator") if key in info), "")
    licence = next((info[key] for key in ("license", "copyright", "rights") if key in info), "")
    return AvatarMeta(
        title=figure.name or info.get("title", ""),
        authors=(authors,) if authors else (),
        licence=licence,
        format=_format(figure),
        notes=(_articulation(figure), *notes),
    )


def _format(figure: HanimFigure) -> str:
    kind = "X3D" if ".x3d" in figure.file.lower() else "VRML97"
    return f"H-Anim {figure.version or '1.x'} ({kind})"


def _articulation(figure: HanimFigure) -> str:
    """How many joints there are, and which level of articulation that is."""
    count = len(figure.joints)
    told = figure.loa if figure.loa is not None else next((loa for joints, loa in _JOINTS if count >= joints), 0)
    return f"{count} joints, level of articulation {min(told, _LARGEST_LOA)}"
