"""The formats of export by the endings of their files, and what each of them leaves open to choose."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.hanim_names import hanim_name
from elbowroom.body.loading.permissions import Use
from elbowroom.clips.told import Told
from elbowroom.errors import InputError
from elbowroom.export import tables
from elbowroom.export.animation import Animation
from elbowroom.export.avatar_glb import avatar_glb
from elbowroom.export.layout import Layout, Rest, RootMotion, take_of, tips
from elbowroom.formats.bvh_writing import write_bvh
from elbowroom.formats.hanim.writing import write_hanim
from elbowroom.formats.skeleton_glb import skeleton_glb, vrm_animation
from elbowroom.formats.usd.writing import write_usda


@dataclass(frozen=True)
class Wishes:
    """What a user said about a file; None where the format decides. Raises `InputError` for what does not exist."""

    root_motion: str = RootMotion.HIPS.value  # or "root", "none"
    rest: str | None = None  # "t" or "a"
    unit: str | None = None  # by name, or metres as a number
    up: str | None = None  # "y" or "z"

    def __post_init__(self) -> None:
        for name, wish, allowed in (("root", self.root_motion, RootMotion), ("rest", self.rest, Rest)):
            if wish is not None and wish.lower() not in [one.value for one in allowed]:
                raise InputError(f"{name}: {wish[:20]!r}, allowed are {', '.join(one.value for one in allowed)}")


@dataclass(frozen=True)
class Exported:
    """A file's bytes, and what there is to say about them."""

    data: bytes
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Format:
    """A kind of file."""

    title: str
    write: Callable[[Animation, Humanoid, Layout], Exported]
    usual: Layout  # what it has where nothing is asked for
    free: bool = False  # whether rest pose, unit and up axis may be chosen; else the format says what they are
    roots: tuple[RootMotion, ...] = tuple(RootMotion)

    def layout(self, wishes: Wishes) -> Layout:
        """The layout after somebody's wishes; raises `InputError` for one that the format has no room for."""
        for name, wish in (("rest", wishes.rest), ("unit", wishes.unit), ("up", wishes.up)):
            if wish is not None and not self.free:
                raise InputError(f"{name}: cannot be chosen in {self.title}, whose own convention holds")
        root, usual = RootMotion(wishes.root_motion.lower()), self.usual
        if root not in self.roots:
            allowed = " or ".join(possible.value for possible in self.roots)
            raise InputError(f"root: {root.value} is not possible in {self.title}: choose {allowed}")
        return Layout(
            root,
            usual.rest if wishes.rest is None else Rest(wishes.rest.lower()),
            usual.unit if wishes.unit is None else Told.metres(wishes.unit),
            usual.up if wishes.up is None else wishes.up.lower(),
        )


def format_of(path: Path) -> Format:
    """The format of a file by its ending; raises `InputError` for others."""
    ending = path.suffix.lower().removeprefix(".")
    if ending not in FORMATS:
        wanted = repr(ending or "a file without an ending")
        raise InputError(
            f"{path}: nothing is written as {wanted}: choose {_ENDINGS}, or .html for a page that plays it"
        )
    return FORMATS[ending]


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


FORMATS = {
    "bvh": Format("BVH", _bvh, Layout(unit=0.01), free=True),
    "csv": Format("CSV", _csv, Layout(), free=True),
    "glb": Format("GLB", _glb, Layout()),
    "npz": Format("NPZ", _npz, Layout(), free=True),
    "usda": Format("USD", _usda, Layout(), free=True),
    "vrma": Format("VRM animation", _vrma, Layout(), roots=(RootMotion.HIPS, RootMotion.NONE)),
    "x3d": Format("X3D", _x3d, Layout()),
}
_ENDINGS = ", ".join(f".{ending}" for ending in FORMATS)
