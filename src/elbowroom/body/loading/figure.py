"""The humanoid in its file: T-posed, its facing, unit and ground found; from it come the rig and the skeleton."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bone_mapping.structure import parent_bone
from elbowroom.body.fitting.body_parts import BodyPoints
from elbowroom.body.loading.rest_pose import facing_of, lean_of, stood_up, t_pose
from elbowroom.body.rig import Rig
from elbowroom.body.skeleton import Skeleton
from elbowroom.errors import InputError
from elbowroom.formats.nodes import NodeTree
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_TALLEST, _SMALLEST = 3.0, 0.3  # metres from the lowest joint to the head joint
_TYPICAL = 1.5
_LEAST = 1e-6  # units: nothing can be measured by less
_UNITS = (0.001, 0.01, 0.1, 10.0, 100.0, 1000.0)  # metres per unit, where the file is not in metres
_BARE_SOLE = 0.026  # height of the lowest joint above the ground where no mesh shows it, of the head joint's height
_THICKEST_SOLE = 0.35  # of the head joint's height; what hangs lower is not a foot
_FARTHEST = 3.0  # distance of a joint from the hips, of the head joint's height
_UNIFORM = 1e-4  # relative difference of scales that still counts as one scale


@dataclass(frozen=True, eq=False)
class Figure:
    """A humanoid in the axes and units of its file, T-posed."""

    place: str  # the file's name, for messages
    tree: NodeTree
    bones: Mapping[str, int]  # canonical order
    rotations: Floats  # (n, 4) local, T-pose
    matrices: Floats  # (n, 4, 4) world, T-pose
    facing: float  # radians
    metric: bool  # the format counts in metres and says so for humanoids (VRM)
    notes: tuple[str, ...] = ()  # on how it was posed

    def position(self, bone: str) -> Floats:
        """World position of a bone's node."""
        position: Floats = self.matrices[self.bones[bone], :3, 3]
        return position

    @property
    def height(self) -> float:
        """From the lower foot to the head joint, in the file's unit."""
        return float(self.position("head")[1] - min(self.position(f"{side}Foot")[1] for side in ("left", "right")))


def figure_of(place: str, tree: NodeTree, bones: Mapping[str, int], vrm_facing: float | None) -> Figure:
    """Bring a file's humanoid into T-pose; a VRM file (`vrm_facing`) is in T-pose already. Raises `InputError`."""
    _check_scales(place, tree, bones)
    rest = tree.world_matrices(tree.rotations)
    if not np.isfinite(rest[list(bones.values())]).all():
        raise InputError(f"{place}: the positions of the bones are not finite numbers")
    at = {bone: rest[node, :3, 3] for bone, node in bones.items()}
    lean = lean_of(at, place, t_posed=vrm_facing is not None)
    if vrm_facing is not None:
        return Figure(place, tree, bones, tree.rotations, rest, vrm_facing, metric=True)
    stood = replace(tree, rotations=stood_up(tree, bones, lean))
    turned = stood.world_matrices(stood.rotations)
    facing = facing_of({bone: turned[node, :3, 3] for bone, node in bones.items()}, place)
    rotations = t_pose(stood, bones, facing)
    was = f"its trunk leans by {np.rad2deg(lean):.0f} degrees in the file; it was stood up"
    notes = () if np.array_equal(stood.rotations, tree.rotations) else (was,)
    return Figure(place, tree, bones, rotations, tree.world_matrices(rotations), facing, metric=False, notes=notes)


def rig_of(figure: Figure, points: BodyPoints) -> Rig:
    """How the file is driven; `points` are the surface in the file's axes and units. Raises `InputError`."""
    hips = figure.bones["hips"]
    nodes = np.array(list(figure.bones.values()), dtype=np.int64)
    world = figure.tree.world_rotations(figure.rotations)
    above = int(figure.tree.parents[hips])
    hips_at = figure.position("hips")
    return Rig(
        nodes=nodes,
        local_rotations=figure.rotations[nodes],
        world_rotations=world[nodes],
        hips_parent_rotation=world[above] if above >= 0 else quaternion.IDENTITY.copy(),
        hips_parent_position=figure.matrices[above, :3, 3] if above >= 0 else np.zeros(3),
        hips_parent_scale=figure.tree.world_scale(above) if above >= 0 else 1.0,
        facing=figure.facing,
        offset=np.array([hips_at[0], _ground(figure, points), hips_at[2]]),
        scale=unit_of(figure),
    )


def skeleton_of(figure: Figure, rig: Rig) -> Skeleton:
    """The normalised skeleton; raises `InputError` where its proportions are no humanoid's."""
    names = tuple(figure.bones)
    parents = [parent_bone(bone, figure.bones) for bone in names]
    skeleton = Skeleton(
        names=names,
        parents=np.array([-1 if parent is None else names.index(parent) for parent in parents], dtype=np.int64),
        positions=rig.to_model(figure.matrices[rig.nodes, :3, 3]),
    )
    _check_lengths(figure.place, skeleton)
    return skeleton


def unit_of(figure: Figure) -> float:
    """Metres per unit of the file, from the height of the head joint above the feet; a VRM is in metres.

    Raises `InputError` where the head is not above the feet, or no unit makes a humanoid of it.
    """
    if not figure.height > _LEAST:
        raise InputError(f"{figure.place}: the head is {figure.height:.3g} units above the feet: it must be higher up")
    if figure.metric:
        return 1.0
    if _SMALLEST <= figure.height <= _TALLEST:
        return 1.0
    fitting = [unit for unit in _UNITS if _SMALLEST <= unit * figure.height <= _TALLEST]
    if not fitting:
        raise InputError(
            f"{figure.place}: the head is {figure.height:.3g} units above the feet: "
            f"a humanoid has {_SMALLEST} to {_TALLEST} m"
        )
    return min(fitting, key=lambda unit: abs(np.log(unit * figure.height / _TYPICAL)))


def _check_scales(place: str, tree: NodeTree, bones: Mapping[str, int]) -> None:
    """A rotation under unequal scales would bend the bones below it, so only equal, positive scales are read."""
    for bone, node in bones.items():
        for above in tree.ancestors(node):
            scale = tree.scales[above]
            if scale.min() <= 0.0 or np.ptp(scale) > _UNIFORM * scale.max():
                shown = ", ".join(f"{component:g}" for component in scale)
                raise InputError(
                    f"{place}: the scale of {_called(tree, above)} is ({shown}): above the bone {bone} it must be "
                    "positive and the same along all axes (apply the scale in the modelling tool)"
                )


def _called(tree: NodeTree, node: int) -> str:
    """A node for messages: by its name, without one by its number in the glTF file."""
    return f"the node {tree.names[node]!r}" if tree.names[node] else f"nodes[{node}]"


def _ground(figure: Figure, points: BodyPoints) -> float:
    """Height of the ground in file units: the lowest point of the feet, or a little below the lowest joint."""
    names, height = list(figure.bones), figure.height
    soles = [i for i, bone in enumerate(names) if bone.endswith(("LowerLeg", "Foot", "Toes"))]
    lowest = min(float(figure.matrices[figure.bones[names[i]], 1, 3]) for i in soles)
    if np.isin(points.joints, soles).any():
        mesh = float(points.positions[np.isin(points.joints, soles), 1].min())
        if lowest - mesh < _THICKEST_SOLE * height:
            return mesh
    if 0.0 <= lowest <= 0.12 * height:  # the file itself stands on y = 0
        return 0.0
    return lowest - _BARE_SOLE * height


def _check_lengths(place: str, skeleton: Skeleton) -> None:
    reach = np.linalg.norm(skeleton.positions - skeleton.positions[0], axis=1)
    if reach.max() > _FARTHEST * skeleton.height:
        bone = skeleton.names[int(np.argmax(reach))]
        raise InputError(f"{place}: the bone {bone} is {reach.max():.3g} m from the hips: that is no humanoid")
    for side in ("left", "right"):
        for limb in (("UpperArm", "LowerArm", "Hand"), ("UpperLeg", "LowerLeg", "Foot")):
            for a, b in pairwise(limb):
                ends = skeleton.positions[[skeleton.index(side + a), skeleton.index(side + b)]]
                if np.linalg.norm(ends[1] - ends[0]) < 1e-3 * skeleton.height:
                    raise InputError(f"{place}: the bones {side}{a} and {side}{b} are at the same place")
