"""A figure of bones: an octahedron for each bone of a skeleton, to see a motion that has no body of its own."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.nodes import NodeTree
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_WIDE, _AT = 0.12, 0.2  # of a bone's length: half its width, and where it is widest
_THINNEST, _THICKEST = 0.004, 0.03  # metres, half the width
_SHORTEST = 1e-4  # metres: a shorter bone has no shape
# Corners: the joint, four round the widest place, the tip; seen from outside they go round to the left.
_TRIANGLES = np.array([[0, 2, 1], [0, 3, 2], [0, 4, 3], [0, 1, 4], [5, 1, 2], [5, 2, 3], [5, 3, 4], [5, 4, 1]])


@dataclass(frozen=True, eq=False)
class BoneShapes:
    """Triangles whose every corner rides on one joint; no two triangles share a corner, so each is flat."""

    points: Floats  # (3 T, 3) in the axes of the rest pose, the file's own units
    normals: Floats  # (3 T, 3)
    joints: NDArray[np.int64]  # (3 T,) nodes of the tree

    @property
    def triangles(self) -> NDArray[np.int64]:
        """Corners (T, 3) of the triangles."""
        return np.arange(len(self.points)).reshape(-1, 3)

    def of(self, joint: int) -> tuple[Floats, Floats]:
        """The points and normals that ride on one joint."""
        mine = self.joints == joint
        return self.points[mine], self.normals[mine]


def bone_shapes(tree: NodeTree, tips: Mapping[str, Floats], unit: float = 1.0) -> BoneShapes:
    """Shapes for a tree without rest rotations; `tips` are the ends of bones without a joint below, `unit` is metres.

    A root on the ground, which is no bone, gets none.
    """
    places = tree.world_matrices(tree.rotations)[:, :3, 3]
    bones = [(int(parent), places[joint]) for joint, parent in enumerate(tree.parents) if parent >= 0]
    bones += [(tree.names.index(name), places[tree.names.index(name)] + tip) for name, tip in tips.items()]
    shapes = [(joint, _octahedron(places[joint], end, unit)) for joint, end in bones if tree.names[joint] != "root"]
    corners = [shape[_TRIANGLES] for _, shape in shapes if shape is not None]  # (8, 3, 3) each
    joints = np.repeat([joint for joint, shape in shapes if shape is not None], 3 * len(_TRIANGLES))
    faces = np.concatenate(corners)
    across = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    normals = np.repeat(across / np.linalg.norm(across, axis=1, keepdims=True), 3, axis=0)
    return BoneShapes(faces.reshape(-1, 3), normals, joints.astype(np.int64))


def _octahedron(start: Floats, end: Floats, unit: float) -> Floats | None:
    """Corners (6, 3) of a bone."""
    along = end - start
    length = float(np.linalg.norm(along))
    if length * unit < _SHORTEST:
        return None
    half = np.clip(_WIDE * length, _THINNEST / unit, _THICKEST / unit)
    turn = quaternion.between([0.0, 1.0, 0.0], along)
    ring = half * np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    middle = start + _AT * along + quaternion.rotate(turn, ring)
    return np.concatenate([[start], middle, [end]])
