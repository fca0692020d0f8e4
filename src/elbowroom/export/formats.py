"""The formats of export by the endings of their files, and what each of them leaves open to choose."""

from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from elbowroom.clips.told import Told
from elbowroom.errors import InputError

SLOWEST, FASTEST = 1.0, 240.0  # frames a second
_SMALLEST, _LARGEST = 1e-4, 1e3  # metres a unit


class RootMotion(Enum):
    """What carries the way through the world."""

    HIPS = "hips"  # the hips' translation and rotation
    ROOT = "root"  # a node of its own above the hips, on the ground
    NONE = "none"  # nothing: the body moves on the spot, facing ahead


class Rest(Enum):
    """The pose in which all rotations are zero."""

    T = "t"
    A = "a"  # arms 45 degrees below the horizontal


@dataclass(frozen=True)
class Layout:
    """What the nodes are to be like."""

    root_motion: RootMotion = RootMotion.HIPS
    rest: Rest = Rest.T
    unit: float = 1.0  # metres
    up: str = "y"  # "y": +Z is ahead at heading 0; "z": -Y is

    def __post_init__(self) -> None:
        if not _SMALLEST <= self.unit <= _LARGEST:
            raise InputError(f"unit: {self.unit:g} m, allowed are {_SMALLEST:g} to {_LARGEST:g}")
        if self.up not in ("y", "z"):
            raise InputError(f"up: {self.up!r}, allowed are y and z")


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
class Format:
    """A kind of file."""

    ending: str
    title: str
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


def check_rate(fps: float) -> None:
    """Raises `InputError` for frames a second that are out of range."""
    if not SLOWEST <= fps <= FASTEST:
        raise InputError(f"fps: {fps:g}, allowed are {SLOWEST:g} to {FASTEST:g} frames a second")


FORMATS = {
    format.ending: format
    for format in (
        Format("bvh", "BVH", Layout(unit=0.01), free=True),
        Format("csv", "CSV", Layout(), free=True),
        Format("glb", "GLB", Layout()),
        Format("npz", "NPZ", Layout(), free=True),
        Format("usda", "USD", Layout(), free=True),
        Format("vrma", "VRM animation", Layout(), roots=(RootMotion.HIPS, RootMotion.NONE)),
        Format("x3d", "X3D", Layout()),
    )
}
_ENDINGS = ", ".join(f".{ending}" for ending in FORMATS)
