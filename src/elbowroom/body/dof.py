"""The table of groups: which degrees of freedom a body has, what they move, how far and how fast.

The groups are a tree: each hangs on its parent's last joint. The paper's (section 3.1) are here with their own
components, and with the lowering of the pelvis; the head, which goes with the waist there, has a group of its own. A
configuration `q` has shape (DOF,), metres and radians:

    index  group      component
    0-2    ROOT       x, z on the ground; heading about +Y, 0 faces +Z, positive turns left (towards +X)
    3-5    WAIST      bend (positive forward), twist (positive to the left), lowering (0 stands, positive crouches)
    6-9    LEFT_ARM   shoulder flexion, abduction, internal rotation; elbow flexion
    10-13  RIGHT_ARM  the same, mirrored: equal values on both sides make a symmetric gesture
    14-15  HEAD       nod (positive forward), turn (positive to the left), both since the chest

Lowering is counted in half leg lengths (`GaitShape.half_leg`; some 0.42 m on an adult), not in metres: so a crouch is
the same posture on every build, and a change of it moves the trunk about as far as an equal angle of bend moves the
shoulders. It goes with the waist because trunk, head and arms follow it; the legs bend under it, the feet stay where
the gait puts them.

All zero is the standing figure with hanging arms, palms to the thighs. The shoulder's flexion and abduction are the two
components of a swing (exponential map, Grassia 1998), followed by the rotation about the arm's own axis:
no gimbal lock within the limits, and Euclidean distance between configurations is meaningful.
"""

from collections.abc import Mapping
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.bones import PARENTS

Floats = NDArray[np.float64]


class Turning(Enum):
    """How the components of a group turn its joints."""

    ROOT = "root"  # they place the hips
    COLUMN = "column"  # bend and twist, spread over a row of joints; a third component lowers the first of them
    ARM = "arm"  # a swing and a rotation of the first joint, a bend of the second


class Component(NamedTuple):
    """One degree of freedom: its name in texts and its range of motion, radians or what its group says."""

    name: str
    low: float
    high: float


class GroupSpec(NamedTuple):
    """One row of the table."""

    label: str  # in texts, files and messages
    parent: str | None  # the group whose last joint it hangs on
    turning: Turning
    bones: tuple[str, ...]  # the joints that it turns, as far as a body has them, the nearest to the parent first
    components: tuple[Component, ...]
    clips: str  # the part that its clips are written for; "" where it has none
    samples: int = 0  # postures that the planner takes from each clip
    # What is shown, over all components together. People move their joints nearly with minimum jerk (T. Flash &
    # N. Hogan, J. Neuroscience 5, 1985), where a way D in the time T peaks at 1.9 D/T and 5.8 D/T^2.
    speed: float = np.inf  # rad/s
    acceleration: float = np.inf  # rad/s^2
    clear_of: tuple[str, ...] = ()  # groups whose parts it must not run into; they are searched before it
    shares: tuple[float, ...] = ()  # of a column's rotation that its joints take; shared out anew where some are absent
    undoes: float = 0.0  # what it undoes of its parent's first components where nobody plans it: then it follows


def _degrees(**ranges: tuple[float, float]) -> tuple[Component, ...]:
    return tuple(Component(name, *np.deg2rad(ends).tolist()) for name, ends in ranges.items())


# Ranges of motion: American Academy of Orthopaedic Surgeons, "Joint Motion: Method of Measuring and Recording" (1965):
# thoracolumbar flexion 80, extension 25, rotation 45; shoulder flexion 180, extension 60, abduction 180,
# internal rotation 70, external 90; elbow flexion 150 degrees. Adduction across the body (the swing's lateral part)
# is limited to 45 degrees, after Boone & Azen, J. Bone Joint Surg. 61-A (1979). The neck's are those of the first book,
# quoted from memory: flexion 45, extension 45, rotation 60 degrees. People get farther: the Academy's later tables have
# 75 degrees of extension at 20 to 29 years (as E. M. Kosmahl quotes them, "Goniometry", University of Scranton, 1999).
_FREE = (-np.inf, np.inf)
_ARM = _degrees(
    flexion=(-60.0, 175.0), abduction=(-45.0, 175.0), rotation=(-90.0, 70.0), elbow=(0.0, 150.0)
)  # a serve turns the upper arm at 10.8 rad/s (M. Reid, B. Elliott & J. Alderson, Br. J. Sports Med. 41, 2007)
# Flexion and abduction together swing the arm by at most this angle from hanging (the swing vector's length).
MAX_ELEVATION = float(np.deg2rad(175.0))


def _arm(side: str, clear_of: tuple[str, ...]) -> GroupSpec:
    return GroupSpec(
        label=f"{side}Arm",
        parent="WAIST",
        turning=Turning.ARM,
        bones=(f"{side}UpperArm", f"{side}LowerArm", f"{side}Hand"),
        components=_ARM,
        clips="arm",
        samples=10,
        speed=6.3,  # a reach of a radian in 0.3 s
        acceleration=150.0,  # a radian in 0.2 s, as in a reach as fast as can be
        clear_of=clear_of,
    )


class DofGroup(Enum):
    """The groups J of the paper; the value of each is its row of the table."""

    __hash__ = object.__hash__  # there is one of each: found in half the time that its name would be

    ROOT = GroupSpec(
        label="root",
        parent=None,
        turning=Turning.ROOT,
        bones=("hips",),
        components=(Component("x", *_FREE), Component("z", *_FREE), Component("heading", *_FREE)),
        clips="",
    )
    WAIST = GroupSpec(
        label="waist",
        parent="ROOT",
        turning=Turning.COLUMN,
        bones=("spine", "chest", "upperChest"),
        # Lowered by 0.7 half legs the knees of a walk are bent by 75 to 118 degrees (range of motion 135, in the same
        # book) and the shins of a stand lean by some 35, about what ankles give with the heels down.
        components=(*_degrees(bend=(-25.0, 80.0), twist=(-45.0, 45.0)), Component("lowering", 0.0, 0.7)),
        clips="waist",
        samples=6,
        speed=3.4,  # a bend, turn or crouch by half a radian in 0.28 s
        acceleration=60.0,  # half a radian in 0.22 s
        shares=(0.40, 0.35, 0.25),
        clear_of=("ROOT",),
    )
    LEFT_ARM = _arm("left", ("ROOT", "WAIST", "HEAD"))
    RIGHT_ARM = _arm("right", ("ROOT", "WAIST", "HEAD", "LEFT_ARM"))
    HEAD = GroupSpec(
        label="head",
        parent="WAIST",
        turning=Turning.COLUMN,
        bones=("neck", "head"),
        components=_degrees(nod=(-45.0, 45.0), turn=(-60.0, 60.0)),
        clips="head",
        samples=5,
        speed=4.7,  # half a radian in 0.2 s
        acceleration=75.0,  # the same
        clear_of=("ROOT",),
        shares=(0.5, 0.5),
        undoes=0.65,  # so that the gaze stays nearly ahead
    )

    def __repr__(self) -> str:
        return f"DofGroup.{self.name}"

    @property
    def size(self) -> int:
        """The number of degrees of freedom in the group."""
        return len(self.value.components)

    @property
    def at(self) -> slice:
        """The place of its components in a configuration `q`."""
        return _PLACES[self]

    @property
    def label(self) -> str:
        """Its name in texts, files and messages."""
        return self.value.label

    @property
    def parent(self) -> "DofGroup | None":
        """The group that it hangs on."""
        return None if self.value.parent is None else DofGroup[self.value.parent]

    @property
    def clear_of(self) -> tuple["DofGroup", ...]:
        """The groups whose parts it must not run into."""
        return tuple(DofGroup[name] for name in self.value.clear_of)

    @property
    def is_arm(self) -> bool:
        """Whether it turns a shoulder and an elbow."""
        return self.value.turning is Turning.ARM


def _places() -> dict[DofGroup, slice]:
    ends = np.cumsum([group.size for group in DofGroup]).tolist()
    return {group: slice(end - group.size, end) for group, end in zip(DofGroup, ends, strict=True)}


_PLACES = _places()
# J*, the groups of the local motion, in the order of `q`.
LOCAL_GROUPS = tuple(group for group in DofGroup if group.parent is not None)
DOF = sum(group.size for group in DofGroup)
LOCAL = DOF - DofGroup.ROOT.size  # components of the local groups, side by side: an upper body (LOCAL,)


def _search_order() -> tuple[DofGroup, ...]:
    """Every local group after its parent, and after those that it must keep clear of."""
    order: list[DofGroup] = []
    while len(order) < len(LOCAL_GROUPS):
        order.append(
            next(
                group
                for group in LOCAL_GROUPS
                if group not in order
                and all(other in order or other is DofGroup.ROOT for other in (group.parent, *group.clear_of))
            )
        )
    return tuple(order)


SEARCH_ORDER = _search_order()  # of decoupled planning; the first carries the others
CHILDREN = SEARCH_ORDER[1:]  # the groups that the waist carries
ARMS = tuple(group for group in CHILDREN if group.is_arm)
LOWERING = DofGroup.WAIST.at.start + 2  # the place of the lowering in `q`
_FIRST = DofGroup.ROOT.size  # of the local components in `q`
_COLUMNS = {group: slice(group.at.start - _FIRST, group.at.stop - _FIRST) for group in LOCAL_GROUPS}


def group_of_bone(bone: str) -> DofGroup:
    """The group that turns a bone, or the nearest one above it that is turned; hips and legs belong to the root."""
    at: str | None = bone
    while at is not None:
        for group in LOCAL_GROUPS:
            if at in group.value.bones:
                return group
        at = PARENTS.get(at)
    return DofGroup.ROOT


def columns_of(group: DofGroup) -> slice:
    """A local group's columns of an upper body (LOCAL,), a configuration without the root."""
    return _COLUMNS[group]


def side_by_side(parts: Mapping[DofGroup, Floats]) -> Floats:
    """Upper bodies (N, LOCAL) of the configurations (N, size) of every local group."""
    return np.concatenate([parts[group] for group in LOCAL_GROUPS], axis=1)


def followers_of(group: DofGroup) -> tuple[DofGroup, ...]:
    """The groups that hang on a group and follow it where nobody plans them."""
    return tuple(other for other in LOCAL_GROUPS if other.parent is group and other.value.undoes > 0.0)


_LIMITS = {group: np.array([(part.low, part.high) for part in group.value.components]) for group in DofGroup}


def limits(group: DofGroup) -> Floats:
    """Lower and upper limits of a group's components, shape (size, 2); the root is unbounded."""
    return _LIMITS[group].copy()


def clamp(group: DofGroup, q: ArrayLike) -> Floats:
    """The group's configurations (..., size) brought within the limits; an arm's elevation too."""
    low, high = _LIMITS[group].T
    inside: Floats = np.clip(np.asarray(q, np.float64), low, high)
    if group.is_arm:
        elevation = np.linalg.norm(inside[..., :2], axis=-1, keepdims=True)
        inside[..., :2] *= np.minimum(1.0, MAX_ELEVATION / np.maximum(elevation, MAX_ELEVATION))
    return inside


def followed(uppers: Floats) -> Floats:
    """Upper bodies (..., LOCAL) whose followers undo their part of what their parents do, as far as they can."""
    out = uppers.copy()
    for parent in LOCAL_GROUPS:
        for group in followers_of(parent):
            done = uppers[..., columns_of(parent)][..., : group.size]
            out[..., columns_of(group)] = clamp(group, -group.value.undoes * done)
    return out


def within_limits(q: ArrayLike, tolerance: float = 1e-9) -> bool:
    """Whether every one of the configurations (..., DOF) respects the limits of all groups, within `tolerance` rad."""
    posture = np.asarray(q, np.float64)
    groups = ((group, posture[..., group.at]) for group in LOCAL_GROUPS)
    return all(bool(np.all(np.abs(clamp(group, part) - part) <= tolerance)) for group, part in groups)
