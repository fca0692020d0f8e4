"""How an animation is written in each of the formats."""

from collections.abc import Callable
from dataclasses import dataclass

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.hanim_names import hanim_name
from elbowroom.body.loading.permissions import Use
from elbowroom.export import tables
from elbowroom.export.animation import Animation
from elbowroom.export.avatar_glb import avatar_glb
from elbowroom.export.formats import Layout
from elbowroom.export.layout import take_of, tips
from elbowroom.formats.bvh_writing import write_bvh
from elbowroom.formats.hanim.writing import write_hanim
from elbowroom.formats.skeleton_glb import skeleton_glb, vrm_animation
from elbowroom.formats.usd.writing import write_usda


@dataclass(frozen=True)
class Exported:
    """A file's bytes, and what there is to say about them."""

    data: bytes
    notes: tuple[str, ...] = ()


def _bvh(animation: Animation, humanoid: Humanoid, layout: Layout) -> Exported:
    return Exported(write_bvh(take_of(animation, layout), tips(humanoid.skeleton, layout)))


def _npz(animation: Animation, _: Humanoid, layout: Layout) -> Exported:
    return Exported(tables.archive(animation, layout))


def _csv(animation: Animation, _: Humanoid, layout: Layout) -> Exported:
    return Exported(tables.table(animation, layout))


def _glb(animation: Animation, humanoid: Humanoid, layout: Layout) -> Exported:
    """The avatar's own file where it has one and allows it, else a figure of bones."""
    refusal = humanoid.meta.permissions.refusal(Use.EMBED) if humanoid.glb else "the avatar has no file"
    if refusal is None:
        return Exported(avatar_glb(animation, humanoid, layout.root_motion))
    data = skeleton_glb(take_of(animation, layout), tips(humanoid.skeleton, layout))
    return Exported(data, (f"{humanoid.name}: {refusal}: a figure of bones shows the motion",))


def _vrma(animation: Animation, _: Humanoid, layout: Layout) -> Exported:
    """A VRM animation; eyes look where they are told by other means there, and are no bones of it."""
    bones = {bone: bone for bone in animation.skeleton.names if not bone.endswith("Eye")}
    return Exported(vrm_animation(take_of(animation, layout), bones))


def _x3d(animation: Animation, humanoid: Humanoid, layout: Layout) -> Exported:
    names = {bone: hanim_name(bone) for bone in humanoid.skeleton.names}
    return Exported(write_hanim(take_of(animation, layout), tips(humanoid.skeleton, layout), names))


def _usda(animation: Animation, humanoid: Humanoid, layout: Layout) -> Exported:
    take, ends = take_of(animation, layout), tips(humanoid.skeleton, layout)
    return Exported(write_usda(take, ends, layout.unit, layout.up))


WRITERS: dict[str, Callable[[Animation, Humanoid, Layout], Exported]] = {
    "bvh": _bvh,
    "csv": _csv,
    "glb": _glb,
    "npz": _npz,
    "usda": _usda,
    "vrma": _vrma,
    "x3d": _x3d,
}  # each of `FORMATS`
