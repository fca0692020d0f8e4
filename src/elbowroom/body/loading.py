"""An avatar file becomes a `Humanoid`: bones, T-pose, facing, unit, ground, collision body."""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bone_names import bones_by_name, checked_bones, parent_bone
from elbowroom.body.capsules import Capsules
from elbowroom.body.fitting import BodyPoints, fit_capsules
from elbowroom.body.humanoid import AvatarMeta, Humanoid
from elbowroom.body.proportions import proportional_capsules
from elbowroom.body.rest_pose import facing_of, t_pose
from elbowroom.body.rig import Rig
from elbowroom.body.skeleton import Skeleton
from elbowroom.body.surface import body_points
from elbowroom.errors import InputError
from elbowroom.formats.gltf import Gltf, parse_gltf, read_gltf
from elbowroom.formats.meshes import SurfacePoints, compression, skin_joints, surface_points
from elbowroom.formats.nodes import NodeTree, read_nodes
from elbowroom.formats.packing import pack_glb
from elbowroom.formats.vrm import Vrm, read_vrm
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_TALLEST, _SMALLEST = 3.0, 0.3  # metres from the lowest joint to the head joint
_TYPICAL = 1.5
_UNITS = (0.001, 0.01, 0.1, 10.0, 100.0, 1000.0)  # metres per unit, where the file is not in metres
_BARE_SOLE = 0.026  # height of the lowest joint above the ground where no mesh shows it, of the head joint's height
_THICKEST_SOLE = 0.35  # of the head joint's height; what hangs lower is not a foot
_FARTHEST = 3.0  # distance of a joint from the hips, of the head joint's height
_UNIFORM = 1e-4  # relative difference of scales that still counts as one scale


@dataclass(frozen=True, eq=False)
class _Figure:
    """The humanoid in its file: T-posed, in the file's own axes and units."""

    place: str
    tree: NodeTree
    bones: dict[str, int]  # canonical order
    rotations: Floats  # (n, 4) local, T-pose
    matrices: Floats  # (n, 4, 4) world, T-pose
    facing: float

    def position(self, bone: str) -> Floats:
        """World position of a bone's node."""
        position: Floats = self.matrices[self.bones[bone], :3, 3]
        return position


def load_humanoid(path: Path) -> Humanoid:
    """Read a VRM 0.x, VRM 1.0 or glTF/GLB humanoid; raises `InputError`."""
    return _humanoid(read_gltf(path), path)[0]


def load_humanoid_bytes(data: bytes, name: str) -> Humanoid:
    """The same for the bytes of a file that was sent to us; it must not refer to other files."""
    return _humanoid(parse_gltf(data, name), None)[0]


def load_with_surface(path: Path) -> tuple[Humanoid, BodyPoints | None]:
    """The humanoid and the points of its own surface (None without a readable mesh), to judge its capsules by."""
    return _humanoid(read_gltf(path), path)


def _humanoid(gltf: Gltf, source: Path | None) -> tuple[Humanoid, BodyPoints | None]:
    tree = read_nodes(gltf)
    vrm = read_vrm(gltf, len(tree))
    named = vrm.bones if vrm else bones_by_name(tree, skin_joints(gltf, tree))
    bones, notes = checked_bones(named, tree, gltf.name)
    figure = _figure(gltf.name, tree, bones, vrm)
    surface, surface_notes = _surface(gltf, tree)
    springs = vrm.spring_nodes if vrm else frozenset()
    points = body_points(tree, list(figure.bones.values()), springs, surface, figure.matrices)
    rig = _rig(figure, points)
    skeleton = _skeleton(figure, rig)
    if points is not None:
        points = BodyPoints(rig.to_model(points.positions), points.joints)
    capsules, capsule_notes = _capsules(skeleton, points)
    meta = AvatarMeta(
        title=vrm.title if vrm else "",
        authors=vrm.authors if vrm else (),
        licence=vrm.licence if vrm else gltf.root.at("asset").at("copyright").text(),
        format=vrm.version if vrm else "glTF 2.0",
        notes=notes + surface_notes + capsule_notes,
    )
    return Humanoid(Path(gltf.name).stem, skeleton, capsules, rig, source, meta, pack_glb(gltf)), points


def _figure(place: str, tree: NodeTree, bones: dict[str, int], vrm: Vrm | None) -> _Figure:
    _check_scales(place, tree, bones)
    rest = tree.world_matrices(tree.rotations)
    if not np.isfinite(rest[list(bones.values())]).all():
        raise InputError(f"{place}: the positions of the bones are not finite numbers")
    positions = {bone: rest[node, :3, 3] for bone, node in bones.items()}
    if vrm:
        facing = np.pi if vrm.version == "VRM 0.x" else 0.0
        return _Figure(place, tree, bones, tree.rotations, rest, facing)
    facing = facing_of(positions, place)
    rotations = t_pose(tree, bones, facing)
    return _Figure(place, tree, bones, rotations, tree.world_matrices(rotations), facing)


def _check_scales(place: str, tree: NodeTree, bones: dict[str, int]) -> None:
    """A rotation under unequal scales would bend the bones below it, so only equal, positive scales are read."""
    for bone, node in bones.items():
        for above in tree.ancestors(node):
            scale = tree.scales[above]
            if scale.min() <= 0.0 or np.ptp(scale) > _UNIFORM * scale.max():
                shown = ", ".join(f"{component:g}" for component in scale)
                raise InputError(
                    f"{place}: nodes[{above}].scale is ({shown}): above the bone {bone} it must be positive and the "
                    "same along all axes (apply the scale in the modelling tool)"
                )


def _surface(gltf: Gltf, tree: NodeTree) -> tuple[SurfacePoints | None, tuple[str, ...]]:
    packed = compression(gltf)
    if packed:
        return None, (f"the mesh is compressed with {packed}, which is not read yet",)
    return surface_points(gltf, tree), ()


def _rig(figure: _Figure, points: BodyPoints | None) -> Rig:
    head, feet = figure.position("head"), [figure.position(f"{side}Foot") for side in ("left", "right")]
    height = float(head[1] - min(foot[1] for foot in feet))
    scale = _unit(figure.place, height)
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
        offset=np.array([hips_at[0], _ground(figure, points, height), hips_at[2]]),
        scale=scale,
    )


def _unit(place: str, height: float) -> float:
    """Metres per unit of the file, from the height of the head joint above the feet."""
    if _SMALLEST <= height <= _TALLEST:
        return 1.0
    fitting = [unit for unit in _UNITS if _SMALLEST <= unit * height <= _TALLEST]
    if not fitting:
        raise InputError(
            f"{place}: the head is {height:.3g} units above the feet: a humanoid has {_SMALLEST} to {_TALLEST} m"
        )
    return min(fitting, key=lambda unit: abs(np.log(unit * height / _TYPICAL)))


def _ground(figure: _Figure, points: BodyPoints | None, height: float) -> float:
    """Height of the ground in file units: the lowest point of the feet, or a little below the lowest joint."""
    names = list(figure.bones)
    soles = [i for i, bone in enumerate(names) if bone.endswith(("LowerLeg", "Foot", "Toes"))]
    lowest = min(float(figure.matrices[figure.bones[names[i]], 1, 3]) for i in soles)
    if points is not None and np.isin(points.joints, soles).any():
        mesh = float(points.positions[np.isin(points.joints, soles), 1].min())
        if lowest - mesh < _THICKEST_SOLE * height:
            return mesh
    if 0.0 <= lowest <= 0.12 * height:  # the file itself stands on y = 0
        return 0.0
    return lowest - _BARE_SOLE * height


def _skeleton(figure: _Figure, rig: Rig) -> Skeleton:
    names = tuple(figure.bones)
    parents = [parent_bone(bone, figure.bones) for bone in names]
    positions = rig.to_model(figure.matrices[rig.nodes, :3, 3])
    skeleton = Skeleton(
        names=names,
        parents=np.array([-1 if parent is None else names.index(parent) for parent in parents], dtype=np.int64),
        positions=positions,
    )
    _check_lengths(figure.place, skeleton)
    return skeleton


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


def _capsules(skeleton: Skeleton, points: BodyPoints | None) -> tuple[Capsules, tuple[str, ...]]:
    """The collision body, and notes on what of it has average proportions."""
    average = proportional_capsules(skeleton)
    if points is None:
        return average, ("the collision body has average proportions",)
    capsules, bare = fit_capsules(skeleton, points)
    if 2 * len(bare) > len(capsules.names):
        return average, ("no mesh on most of the bones: the collision body has average proportions",)
    return capsules, (f"without mesh, of average proportions: {', '.join(bare)}",) if bare else ()
