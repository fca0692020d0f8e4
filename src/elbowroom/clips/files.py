"""Motion files, told apart by their content: BVH, the animations of a glTF file, VRM animations, X3D and USD."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from elbowroom.body.bone_mapping.override import override_beside, read_override
from elbowroom.body.loading.hanim_names import hanim_bones
from elbowroom.clips.body_motion import body_motion
from elbowroom.clips.bones import gltf_bones, tree_bones
from elbowroom.clips.clip import Clip
from elbowroom.clips.take_figure import figure_of
from elbowroom.clips.told import Told
from elbowroom.errors import InputError
from elbowroom.formats.animations import read_animations, take_of
from elbowroom.formats.bvh import MAX_BYTES, is_bvh, parse_bvh
from elbowroom.formats.fields import Field
from elbowroom.formats.file_bytes import read_file
from elbowroom.formats.foreign_files import told_apart
from elbowroom.formats.gltf import Gltf, parse_gltf
from elbowroom.formats.hanim.figure import HanimFigure, parse_figure
from elbowroom.formats.hanim.motion import hanim_animations, hanim_take
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.takes import Take
from elbowroom.formats.usd.prims import Prim, is_usd, parse_usda
from elbowroom.formats.usd.skel import usd_skeletons, usd_take
from elbowroom.formats.vrm import read_vrm, read_vrm_animation
from elbowroom.formats.x3d.files import unpacked
from elbowroom.formats.x3d.recognised import is_x3d


@dataclass(frozen=True, eq=False)
class MotionFile:
    """A file's clips by name; each is read when it is asked for."""

    name: str
    format: str
    clips: dict[str, Callable[[], Clip]]

    def clip(self, name: str | None = None) -> Clip:
        """The clip of this name; without one the only clip. Raises `InputError`."""
        if name is None and len(self.clips) == 1:
            name = next(iter(self.clips))
        if name is None:
            some = ", ".join(list(self.clips)[:5])
            raise InputError(
                f"{self.name} holds {len(self.clips)} clips: choose one with {self.name}#NAME ({some}, ...)"
            )
        if name not in self.clips:
            some = ", ".join(list(self.clips)[:60])
            raise InputError(f"{self.name} holds no clip {name[:60]!r}; there are {some}")
        return self.clips[name]()


def open_motion(path: Path, told: Told | None = None) -> MotionFile:
    """Open a motion file; raises `InputError`."""
    data, beside = read_file(path, 8 * MAX_BYTES), override_beside(path)
    return parse_motion(data, path.name, told, path.parent, None if beside is None else read_override(beside))


_SKELETAL = (b"SkelAnimation", b"SkelRoot", b"Skeleton")  # in text; a binary file packs its names


def parse_motion(
    data: bytes, name: str, told: Told | None = None, folder: Path | None = None, bones: Field | None = None
) -> MotionFile:
    """Read the bytes of a motion file; `folder` is where a glTF may have its buffers.

    `bones` is what the user says about its nodes (`FILE.bones.json`). Raises `InputError`.
    """
    told = told or Told()
    if not data:
        raise InputError(f"{name} is empty")
    if _is_gltf(data):
        return _from_gltf(parse_gltf(data, name, folder), told, bones)
    if is_x3d(data):
        return _from_x3d(parse_figure(data, name, folder), told, bones)
    if is_usd(data):
        return _from_usd(parse_usda(data, name), told, bones)
    if not is_bvh(data):
        raise InputError(told_apart(name, data, "it is neither BVH (HIERARCHY) nor glTF, GLB, VRMA, X3D or USD"))
    return _from_bvh(data, name, told, bones)


def is_motion_only(data: bytes, name: str) -> bool:
    """Whether a file shows no avatar: BVH, USD with a skeleton, a VRM animation, or a glTF that is animated only."""
    if is_bvh(data):
        return True
    if is_usd(data):
        return any(word in data for word in _SKELETAL)
    if not _is_gltf(data):
        return False
    root = parse_gltf(data, name).root
    vrma = root.at("extensions").at("VRMC_vrm_animation").present
    return vrma or bool(root.at("animations").items() and not root.at("meshes").items())


def has_animations(data: bytes, name: str) -> bool:
    """Whether a file is a glTF or X3D file with animations."""
    if is_x3d(data):
        return any(b"Interpolator" in part for part in (data, unpacked(data, name)))
    return _is_gltf(data) and bool(parse_gltf(data, name).root.at("animations").items())


def _is_gltf(data: bytes) -> bool:
    return data[:4] == b"glTF" or data[:64].lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{")


def _from_bvh(data: bytes, name: str, told: Told, named: Field | None) -> MotionFile:
    take = _at_rate(parse_bvh(data, name).take(), told)
    if not len(take):
        raise InputError(f"{name} holds no frames: it is a skeleton without motion")

    def clip() -> Clip:
        figure = figure_of(take, tree_bones(take.tree, name, named), told, name)
        return Clip(take.name, name, "BVH", len(take), figure, body_motion(take, figure, floor_known=False))

    return MotionFile(name, "BVH", {take.name: clip})


def _from_gltf(gltf: Gltf, told: Told, chosen: Field | None) -> MotionFile:
    tree = read_nodes(gltf)
    animations = read_animations(gltf, len(tree))
    if not animations:
        raise InputError(f"{gltf.name} holds no animation of nodes")
    vrma = read_vrm_animation(gltf, len(tree))
    vrm = read_vrm(gltf, len(tree))
    kind = "glTF 2.0" if vrma is None else "VRM animation 1.0"
    named = vrma or (vrm.bones if vrm else None)

    def clip(index: int, name: str) -> Clip:
        place = f"{gltf.name}#{name}"
        whole, bones = gltf_bones(gltf, tree, named, chosen)
        take = _at_rate(take_of(animations[index], whole, place), told)
        figure = figure_of(take, bones, told, place, t_posed=vrma is not None, metric=True)
        return Clip(name, gltf.name, kind, len(take), figure, body_motion(take, figure, floor_known=True))

    names = _distinct([animation.name for animation in animations])
    return MotionFile(gltf.name, kind, {name: _bound(clip, i, name) for i, name in enumerate(names)})


def _from_x3d(figure: HanimFigure, told: Told, chosen: Field | None) -> MotionFile:
    animations = hanim_animations(figure)
    if not animations:
        raise InputError(f"{figure.file} holds no interpolators, driven by a TimeSensor, of an H-Anim figure")
    kind = "X3D" if ".x3d" in figure.file.lower() else "VRML97"

    def clip(index: int, name: str) -> Clip:
        place = f"{figure.file}#{name}"
        gltf = figure.gltf()
        nodes = read_nodes(gltf)
        named = hanim_bones(figure.joints, nodes)
        tree, bones = gltf_bones(gltf, nodes, named.nodes if named.is_humanoid else None, chosen, strict=False)
        take = _at_rate(hanim_take(animations[index], figure, tree, place), told)
        body = figure_of(take, bones, told, place, metric=True)
        return Clip(name, figure.file, kind, len(take), body, body_motion(take, body, floor_known=True))

    names = _distinct([animation.name for animation in animations])
    return MotionFile(figure.file, kind, {name: _bound(clip, i, name) for i, name in enumerate(names)})


def _from_usd(stage: Prim, told: Told, chosen: Field | None) -> MotionFile:
    skeletons = usd_skeletons(stage)
    if not skeletons:
        raise InputError(f"{stage.file} holds no SkelAnimation of a Skeleton")

    def clip(index: int, name: str) -> Clip:
        place = f"{stage.file}#{name}"
        take = _at_rate(usd_take(skeletons[index], place), told)
        body = figure_of(take, tree_bones(take.tree, place, chosen), told, place, metric=True)
        return Clip(name, stage.file, "USD", len(take), body, body_motion(take, body, floor_known=True))

    names = _distinct([skeleton.name for skeleton in skeletons])
    return MotionFile(stage.file, "USD", {name: _bound(clip, i, name) for i, name in enumerate(names)})


def _bound(clip: Callable[[int, str], Clip], index: int, name: str) -> Callable[[], Clip]:
    return lambda: clip(index, name)


def _distinct(names: list[str]) -> list[str]:
    """The names, numbered where one occurs again."""
    seen: dict[str, int] = {}
    result = []
    for name in names:
        seen[name] = seen.get(name, 0) + 1
        result.append(name if seen[name] == 1 else f"{name} ({seen[name]})")
    return result


def _at_rate(take: Take, told: Told) -> Take:
    if told.fps is None:
        return take
    return Take(take.name, take.tree, 1.0 / told.fps, take.rotations, take.translations)
