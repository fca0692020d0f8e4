"""An avatar's surface as points: the vertices of its body, and points spread evenly over the area of its triangles.

A sample within a triangle moves as the mean of three vertices, each of which may hang on several joints. Capsules are
rigid, so each sample is given to the one joint that carries it best: the one for which, when each joint of the body
turns a little about each axis, the sample strays least from where the mesh has it.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bones import SPINE
from elbowroom.body.fitting.body_mesh import BodyMesh, triangle_areas
from elbowroom.body.fitting.body_parts import BodyPoints
from elbowroom.body.fitting.flexing import FlexedPoses, flexed, poses_of
from elbowroom.body.pose.hands import relaxed_rotations
from elbowroom.body.skeleton import Skeleton
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SAMPLES = 20_000
_AT_ONCE = 4_000
_TURNING = ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes")
_GOLDEN = (0.7548776662466927, 0.5698402909980532)  # steps of the sequence R2: M. Roberts 2018


@dataclass(frozen=True, eq=False)
class Surface:
    """What a body looks like from outside, T-posed with its fingers relaxed, metres, in the skeleton's frame."""

    posed: Floats  # (P, V, 3) the vertices in the poses of `flexing.Poses`, which begin with T-pose
    joints: Ints  # (V,) of the greatest weight of each
    samples: BodyPoints  # spread evenly over its area, in those poses in turn

    @property
    def vertices(self) -> BodyPoints:
        """The vertices in T-pose."""
        return BodyPoints(self.posed[0], self.joints)

    def scaled(self, factor: float) -> "Surface":
        """The surface of an avatar so many times as large."""
        return Surface(factor * self.posed, self.joints, self.samples.scaled(factor))


def used_vertices(body: BodyMesh) -> Ints:
    """Which vertices have triangles (V,)."""
    used: Ints = np.unique(body.triangles)
    return used


def vertex_points(body: BodyMesh) -> BodyPoints:
    """The vertices of the triangles."""
    used = used_vertices(body)
    return BodyPoints(body.vertices()[used], body.joints[used, 0])


def surface_of(body: BodyMesh, skeleton: Skeleton, count: int = SAMPLES) -> Surface:
    """The surface of a body mesh in the skeleton's frame, with `count` samples; none where it has no area."""
    relaxed, poses, used = with_relaxed_hands(body, skeleton), poses_of(skeleton), used_vertices(body)
    posed, carriers = poses.skinned(relaxed, used), relaxed.joints[used, 0]
    areas = triangle_areas(relaxed.vertices()[body.triangles])
    if not areas.sum() > 0.0:
        return Surface(posed, carriers, BodyPoints(np.zeros((0, 3)), np.zeros(0, np.int64)))
    which, shares = _spread(areas, count)
    found = [
        _carried(relaxed, skeleton, poses, relaxed.triangles[which[some]], shares[some])
        for some in (slice(first, first + _AT_ONCE) for first in range(0, count, _AT_ONCE))
    ]
    places, joints = (np.concatenate(column) for column in zip(*found, strict=True))
    return Surface(posed, carriers, BodyPoints(places, joints))


def _carried(
    body: BodyMesh, skeleton: Skeleton, poses: FlexedPoses, corners: Ints, shares: Floats
) -> tuple[Floats, Ints]:
    """Where samples (S, 3) are for the joints that carry them best, and these joints (S,)."""
    joints = _carriers(body, skeleton, corners, shares)
    return flexed(body, poses, corners, shares, joints), joints


def with_relaxed_hands(body: BodyMesh, skeleton: Skeleton) -> BodyMesh:
    """The T-posed body as it is when its fingers are relaxed."""
    local, rest = relaxed_rotations(skeleton), skeleton.positions
    turned, placed = local.copy(), rest.copy()
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            turned[joint] = quaternion.multiply(turned[parent], local[joint])
            placed[joint] = placed[parent] + quaternion.rotate(turned[parent], rest[joint] - rest[parent])
    places = placed[body.joints] + quaternion.rotate(turned[body.joints], body.places - rest[body.joints])
    return replace(body, places=places)


def _spread(areas: Floats, count: int) -> tuple[Ints, Floats]:
    """Triangles (S,) and barycentric coordinates (S, 3) of samples at equal steps of area; no chance in it."""
    number = np.arange(count)
    ends = np.cumsum(areas)
    which = np.minimum(np.searchsorted(ends, (number + 0.5) / count * ends[-1]), len(areas) - 1)
    u, v = ((number[None] + 1) * np.array(_GOLDEN)[:, None]) % 1.0
    root = np.sqrt(u)
    return which, np.stack([1.0 - root, root * (1.0 - v), root * v], axis=1)


def _carriers(body: BodyMesh, skeleton: Skeleton, corners: Ints, shares: Floats) -> Ints:
    """The joint (S,) that carries each sample best.

    When joint m turns, a sample moves by the turn applied to D, the sum over its vertices of the weight of all joints
    below m times the vertex's way from m; a point carried by one joint below m by the turn applied to its whole way
    from m, and by any other joint not at all. |D - way|^2 less |D|^2 is what it costs to be carried by m.
    """
    rest = skeleton.positions
    influence = body.weights[corners] * shares[:, :, None]
    places = np.einsum("sck,scki->si", influence, body.places[corners])
    turning = [joint for joint, bone in enumerate(skeleton.names) if _turns(bone)]
    below = _below(skeleton)
    costs = np.zeros((len(corners), len(rest)))
    for joint in turning:
        share = influence * below[joint][body.joints[corners]]
        moved = np.einsum("sck,scki->si", share, body.places[corners] - rest[joint])
        costs += np.outer(np.sum((moved - (places - rest[joint])) ** 2 - moved**2, axis=1), below[joint])
    candidates = np.array([0, *(joint for joint in turning if not skeleton.names[joint].endswith("Toes"))])
    found: Ints = candidates[np.argmin(costs[:, candidates], axis=1)]
    return found


def _turns(bone: str) -> bool:
    """Whether the bone turns against its parent while the avatar walks."""
    return bone in (*SPINE, "neck", "head") or bone.endswith(_TURNING)


def _below(skeleton: Skeleton) -> NDArray[np.bool_]:
    """Whether a joint (second) is another (first) or hangs below it, (J, J)."""
    below = np.eye(len(skeleton.parents), dtype=bool)
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            below[:, joint] |= below[:, parent]
    return below
