"""From any rest pose to the T-pose: each limb is swung straight, its twist stays."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.nodes import NodeTree
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_SNAP = np.deg2rad(15.0)  # a heading this near to a quarter turn is meant to be it
_LEANS = np.deg2rad(20.0)  # a trunk that leans more is stood up
_LIES = np.deg2rad(60.0)  # one that leans more lies: another axis of the file may be up
_T_POSED = np.deg2rad(30.0)  # no trunk leans more in a pose that is the T-pose by a format's rule
_KNUCKLES = ("IndexProximal", "MiddleProximal", "RingProximal", "LittleProximal")


def lean_of(positions: Mapping[str, Floats], place: str, *, t_posed: bool = False) -> float:
    """How far the trunk is from upright, radians, by joint positions (bone -> (3,), Y up).

    Raises `InputError` for a figure that lies, or, where its pose is the T-pose by the format's rule, leans.
    """
    up = positions["head"] - positions["hips"]
    lean = float(np.arctan2(np.linalg.norm(up[[0, 2]]), up[1]))
    if not lean <= (_T_POSED if t_posed else _LIES):
        rule = "a VRM rests in T-pose" if t_posed else "glTF needs +Y up"
        raise InputError(
            f"{place}: the figure does not stand upright, it leans by {np.rad2deg(lean):.0f} degrees: {rule}"
        )
    return lean


def stood_up(tree: NodeTree, bones: Mapping[str, int], lean: float) -> Floats:
    """Local rotations (n, 4) of all nodes, with the hips turned so that a trunk that leans is upright."""
    swinger = _Swinger(tree, bones)
    if lean > _LEANS:
        swinger.swing("hips", ["head"], np.array([0.0, 1.0, 0.0]))
    return swinger.rotations


def facing_of(positions: Mapping[str, Floats], place: str) -> float:
    """The heading in radians that a figure faces, from joint positions (bone -> (3,), Y up): 0 is +Z, pi is -Z.

    Raises `InputError` if it does not stand upright, or if its toes point backwards.
    """
    across = sum((positions[f"left{b}"] - positions[f"right{b}"] for b in ("UpperArm", "UpperLeg")), np.zeros(3))
    lean_of(positions, place)
    if float(np.linalg.norm(across[[0, 2]])) < max(1e-6, 0.5 * float(np.linalg.norm(across))):
        raise InputError(f"{place}: the figure does not stand upright: glTF needs +Y up")
    heading = float(np.arctan2(-across[2], across[0]))
    quarter = 0.5 * np.pi * round(heading / (0.5 * np.pi))
    heading = quarter if abs(heading - quarter) < _SNAP else heading
    forward = np.array([np.sin(heading), 0.0, np.cos(heading)])
    toes = [positions[f"{s}Toes"] - positions[f"{s}Foot"] for s in ("left", "right") if f"{s}Toes" in positions]
    if toes and all(toe @ forward < -0.5 * np.linalg.norm(toe) for toe in toes):
        raise InputError(f"{place}: the toes point backwards: the names of the left and right bones are swapped")
    return heading


def t_pose(tree: NodeTree, bones: Mapping[str, int], facing: float) -> Floats:
    """Local rotations (n, 4) of all nodes with the arms along the figure's sides and the legs straight down.

    The spine, the shoulders and the fingers keep their local rotations, the feet their orientation in the world.
    """
    swinger = _Swinger(tree, bones)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        sideways = quaternion.rotate(quaternion.about_axis(1, facing), [sign, 0.0, 0.0])
        swinger.swing(f"{side}UpperArm", [f"{side}LowerArm"], sideways)
        swinger.swing(f"{side}LowerArm", [f"{side}Hand"], sideways)
        swinger.swing(f"{side}Hand", [f"{side}{k}" for k in _KNUCKLES if f"{side}{k}" in bones], sideways)
        foot = swinger.world_rotation(f"{side}Foot")
        down = np.array([0.0, -1.0, 0.0])
        swinger.swing(f"{side}UpperLeg", [f"{side}LowerLeg"], down)
        swinger.swing(f"{side}LowerLeg", [f"{side}Foot"], down)
        swinger.turn_to(f"{side}Foot", foot)
    return swinger.rotations


class _Swinger:
    """Turns bones in the world, one after the other; its state is the local rotations of all nodes."""

    def __init__(self, tree: NodeTree, bones: Mapping[str, int]) -> None:
        self.rotations = tree.rotations.copy()
        self._tree, self._bones = tree, bones

    def world_rotation(self, bone: str) -> Floats:
        return self._world(self._bones[bone])[1]

    def swing(self, bone: str, tips: list[str], direction: Floats) -> None:
        """Turn `bone` by the shortest way so that its mean tip lies in `direction`; without tips it stays."""
        if not tips:
            return
        ends = [self._world(self._bones[tip])[0] for tip in tips]
        along = np.mean(ends, axis=0) - self._world(self._bones[bone])[0]
        if np.linalg.norm(along) > 1e-9:
            self.turn_to(bone, quaternion.multiply(quaternion.between(along, direction), self.world_rotation(bone)))

    def turn_to(self, bone: str, rotation: Floats) -> None:
        """Give `bone` this world rotation."""
        node = self._bones[bone]
        above = self._world(int(self._tree.parents[node]))[1]
        self.rotations[node] = quaternion.normalize(quaternion.multiply(quaternion.conjugate(above), rotation))

    def _world(self, node: int) -> tuple[Floats, Floats]:
        """World position (3,) and rotation (4,) of a node."""
        position, rotation = self._tree.translations[node], self.rotations[node]
        for above in self._tree.ancestors(node):
            position = quaternion.rotate(self.rotations[above], self._tree.scales[above] * position)
            position = position + self._tree.translations[above]
            rotation = quaternion.multiply(self.rotations[above], rotation)
        return position, rotation
