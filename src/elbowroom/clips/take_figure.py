"""Whose motion it is: the humanoid in a take's skeleton, and how it lies in the file's axes and unit.

A skeleton's rest pose may be anything of human shape: T, A or hanging arms, any axis up, facing anywhere. It is stood
upright and turned to +Z by its own anatomy (hips to head, right to left), then brought to the T-pose.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.loading.rest_pose import facing_of, t_pose
from elbowroom.clips.told import UNITS, Told
from elbowroom.errors import InputError
from elbowroom.formats.nodes import NodeTree
from elbowroom.formats.takes import Take
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_ADULT = (1.2, 1.75)  # metres from the soles to the head joint
_ANY_HUMAN = (0.6, 2.5)
_TYPICAL = 1.5  # where no unit fits
_UPRIGHT = 0.7  # cosine: so near to an axis is meant to be it
_WATCHED = 200  # frames that are looked at to see where up is
_ENDS = ("end", "nub", "site")  # how the names of end sites end
_SUNK, _RAISED = 0.03, 0.12  # of the head joint's height: so near to its zero a file's lowest joint stands on it
_ANKLE = 0.045  # of the leg: how high the ankle joint is above the sole, where nothing below it shows


@dataclass(frozen=True, eq=False)
class TakeFigure:
    """The humanoid of a take, T-posed: metres, Y up, facing +Z."""

    bones: dict[str, int]  # VRM 1.0 name -> node, parents first
    turns: Floats  # (B, 4) world rotations of the bones' nodes in T-pose
    positions: Floats  # (B, 3) metres, the sole at y = 0
    soles: Floats  # (2, 2, 3) heel and toe of the left and the right foot on the ground, T-pose
    upright: Floats  # (4,) rotation from the file's axes to Y up; of a glTF, whose rest pose shows it, to +Z ahead too
    up: str  # the file's axis that points up: "y", "z", "-x", ...
    unit: float  # metres per unit of the file
    unit_name: str  # "cm", "inch", ...; "body" where the unit is none of the usual ones and was taken from the height

    @property
    def names(self) -> tuple[str, ...]:
        """The bones in order."""
        return tuple(self.bones)

    def position(self, bone: str) -> Floats:
        """T-pose position (3,) of a bone's joint."""
        position: Floats = self.positions[self.names.index(bone)]
        return position

    @property
    def height(self) -> float:
        """Of the head joint above the ground, metres."""
        return float(self.position("head")[1])

    @property
    def hips_height(self) -> float:
        """Of the hips joint above the ground, metres."""
        return float(self.position("hips")[1])


def figure_of(
    take: Take, bones: dict[str, int], told: Told, place: str, *, t_posed: bool = False, metric: bool = False
) -> TakeFigure:
    """The figure behind a take; `bones` in canonical order.

    `t_posed`: the rest pose is the T-pose by the format's rule. `metric`: the format counts in metres with Y up (glTF).
    Raises `InputError` where the skeleton has not the shape of a human.
    """
    tree, stood = (take.tree, quaternion.IDENTITY) if t_posed else _standing(take, bones, place)
    rotations = tree.rotations if t_posed else t_pose(tree, bones, 0.0)
    nodes = np.array(list(bones.values()))
    positions = tree.world_matrices(rotations)[:, :3, 3]
    floor, soles = _soles(tree, bones, positions)
    head = float(positions[bones["head"], 1]) - floor
    if not np.isfinite(head) or head < 1e-6:
        raise InputError(f"{place}: the head is not above the feet: that is no standing humanoid")
    unit, unit_name = _unit(head, told, metric)
    if metric and told.up is None:
        upright = stood
    else:
        upright = quaternion.between(_axis(told.up.lower() if told.up else _up_axis(take, bones)), [0.0, 1.0, 0.0])
    ground = np.array([0.0, floor, 0.0])
    return TakeFigure(
        bones=bones,
        turns=tree.world_rotations(rotations)[nodes],
        positions=unit * (positions[nodes] - ground),
        soles=unit * (soles - ground),
        upright=upright,
        up=_axis_name(quaternion.rotate(quaternion.conjugate(upright), [0.0, 1.0, 0.0])),
        unit=unit,
        unit_name=unit_name,
    )


def _axis(name: str) -> Floats:
    axis = np.zeros(3)
    axis["xyz".index(name[-1])] = -1.0 if name.startswith("-") else 1.0
    return axis


def _axis_name(direction: Floats) -> str:
    """The axis nearest to a direction."""
    k = int(np.argmax(np.abs(direction)))
    return ("-" if direction[k] < 0.0 else "") + "xyz"[k]


def _standing(take: Take, bones: Mapping[str, int], place: str) -> tuple[NodeTree, Floats]:
    """The rest pose stood upright, facing +Z, and how it was turned.

    If it has not the shape of a human, the first frame is taken instead. Raises `InputError` if that has not either.
    """
    frames = [(take.tree.rotations, take.tree.translations)]
    if len(take):
        frames.append((take.rotations[0], take.translations[0]))
    for rotations, translations in frames:
        tree = _posed(take.tree, rotations, translations)
        world = tree.world_matrices(rotations)[:, :3, 3]
        turn = _to_upright({bone: world[node] for bone, node in bones.items()})
        if turn is not None:
            stood = _turned(tree, turn)
            matrices = stood.world_matrices(stood.rotations)
            facing_of({bone: matrices[node, :3, 3] for bone, node in bones.items()}, place)
            return stood, turn
    raise InputError(f"{place}: neither the rest pose nor the first frame shows a human that stands upright")


def _posed(tree: NodeTree, rotations: Floats, translations: Floats) -> NodeTree:
    return NodeTree(tree.names, tree.parents, tree.order, translations, rotations, tree.scales, tree.meshes, tree.skins)


def _turned(tree: NodeTree, turn: Floats) -> NodeTree:
    """The whole tree turned about the origin."""
    roots = tree.parents < 0
    rotations, translations = tree.rotations.copy(), tree.translations.copy()
    rotations[roots] = quaternion.multiply(turn, rotations[roots])
    translations[roots] = quaternion.rotate(turn, translations[roots])
    return _posed(tree, rotations, translations)


def _to_upright(at: Mapping[str, Floats]) -> Floats | None:
    """The rotation that stands a figure upright and turns it to +Z; None where its joints tell no directions."""
    spine = at["head"] - at["hips"]
    across = sum((at[f"left{b}"] - at[f"right{b}"] for b in ("UpperArm", "UpperLeg")), np.zeros(3))
    legs = at["hips"] - 0.5 * (at["leftFoot"] + at["rightFoot"])
    if min(np.linalg.norm(v) for v in (spine, across, legs)) < 1e-9 or not np.isfinite(spine + across + legs).all():
        return None
    up, left = _snapped(spine / np.linalg.norm(spine)), across / np.linalg.norm(across)
    left = left - (left @ up) * up
    if np.linalg.norm(left) < 0.5 or legs @ up < 0.5 * np.linalg.norm(legs):
        return None
    left = _snapped(left / np.linalg.norm(left))
    left = left - (left @ up) * up
    left /= np.linalg.norm(left)
    return quaternion.from_matrix(np.stack([left, up, np.cross(left, up)]))


def _snapped(direction: Floats) -> Floats:
    """The coordinate axis, if the direction is meant to be it."""
    k = int(np.argmax(np.abs(direction)))
    if abs(direction[k]) < np.cos(np.deg2rad(20.0)):
        return direction
    axis = np.zeros(3)
    axis[k] = np.sign(direction[k])
    return axis


def _up_axis(take: Take, bones: Mapping[str, int]) -> str:
    """The axis along which the body stands on average; that of the rest pose where it rather lies or bends down."""
    nodes = np.array([bones["hips"], bones["head"]])
    rest = take.tree.world_matrices(take.tree.rotations)[nodes, :3, 3]
    spines = [rest[1] - rest[0]]
    if len(take):
        some = np.unique(np.linspace(0, len(take) - 1, _WATCHED).astype(int))
        part = Take(take.name, take.tree, take.frame_time, take.rotations[some], take.translations[some])
        at = part.world(nodes)[1]
        spines.insert(0, (at[:, 1] - at[:, 0]).mean(axis=0))
    for spine in spines:
        length = float(np.linalg.norm(spine))
        if length > 0.0 and np.abs(spine).max() >= _UPRIGHT * length:
            return _axis_name(spine)
    return "y"


def _unit(head: float, told: Told, metric: bool) -> tuple[float, str]:
    """Metres per unit, and its name; `head` is the height of the head joint in units."""
    if told.unit is not None:
        return Told.metres(told.unit), told.unit.lower()
    if metric and _ANY_HUMAN[0] <= head <= _ANY_HUMAN[1]:
        return 1.0, "m"
    for low, high in (_ADULT, _ANY_HUMAN):
        names = UNITS if (low, high) == _ADULT else ("m", "cm")
        for name in names:
            if low <= UNITS[name] * head <= high:
                return UNITS[name], name
    return _TYPICAL / head, "body"


def _soles(tree: NodeTree, bones: Mapping[str, int], positions: Floats) -> tuple[float, Floats]:
    """Height of the ground under a T-pose (Y up), and heel and toe of both feet on it, (2, 2, 3)."""
    leg = float(positions[bones["hips"], 1]) - float(positions[bones["leftFoot"], 1])
    below = {side: _of_foot(tree, bones, side) for side in ("left", "right")}
    lowest = min(float(positions[nodes, 1].min()) for nodes in below.values())
    ankle = min(float(positions[bones[f"{side}Foot"], 1]) for side in below)
    head = float(positions[bones["head"], 1])
    if -_SUNK * head <= lowest <= _RAISED * head:  # the file itself stands on the ground
        floor = min(lowest, 0.0)
    else:
        floor = min(lowest, ankle - _ANKLE * leg)
    soles = np.empty((2, 2, 3))
    for i, (side, nodes) in enumerate(below.items()):
        at = positions[bones[f"{side}Foot"]]
        ahead = max(float(positions[nodes, 2].max() - at[2]), 0.15 * leg)
        soles[i] = [[at[0], floor, at[2] - 0.06 * leg], [at[0], floor, at[2] + ahead]]
    return floor, soles


def _of_foot(tree: NodeTree, bones: Mapping[str, int], side: str) -> list[int]:
    """The joints of a foot and its end sites; other nodes that hang on it may be anything."""
    nodes = [bones[f"{side}{bone}"] for bone in ("Foot", "Toes") if f"{side}{bone}" in bones]
    ends = [n for n in map(int, tree.order) if tree.names[n].lower().endswith(_ENDS) and nodes[0] in tree.ancestors(n)]
    return nodes + ends
