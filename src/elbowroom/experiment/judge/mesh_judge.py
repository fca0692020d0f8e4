"""The skinned mesh against obstacles: every triangle, none left out, the far ones dismissed in bulk."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.experiment.judge.ledger import Ledger, Nearness
from elbowroom.experiment.judge.obstacles import Obstacle, coal_library
from elbowroom.experiment.judge.patches import Patch, patches_of
from elbowroom.experiment.judge.poses import Posed
from elbowroom.experiment.judge.skin import Skin

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class _Moments(NamedTuple):
    """Some poses: their numbers (n,), times (n,) and joints."""

    numbers: Ints
    times: Floats
    posed: Posed

    def at(self, rows: Ints) -> "_Moments":
        """Those in some rows."""
        posed = Posed(self.posed.positions[rows], self.posed.rotations[rows])
        return _Moments(self.numbers[rows], self.times[rows], posed)


class MeshJudge:
    """Judges the surface of one avatar in one scene.

    A surface is judged, not a solid: an obstacle that lies wholly inside the body, so that no triangle meets it, is
    the capsules' to find.
    """

    def __init__(self, skin: Skin, skeleton: Skeleton, obstacles: Sequence[Obstacle]) -> None:
        self._coal, self._skin, self._obstacles = coal_library(), skin, obstacles
        self._patches = patches_of(skin)
        self._regions = [region_of(bone) for bone in skeleton.names]
        self._nearest = self._coal.DistanceRequest()

    def judge(self, posed: Posed, times: Floats, first: int, ledger: Ledger) -> None:
        """Enter what the surface does at N poses, whose numbers begin at `first`."""
        every = _Moments(np.arange(first, first + len(times)), times, posed)
        bounds = [self._patches.body_bounds(posed, obstacle) for obstacle in self._obstacles]
        for which in sorted(range(len(bounds)), key=lambda which: float(bounds[which].min())):
            near = np.flatnonzero(bounds[which] <= ledger.limit)
            if len(near):
                self._judge_obstacle(every.at(near), self._obstacles[which], ledger)

    def _judge_obstacle(self, moments: _Moments, obstacle: Obstacle, ledger: Ledger) -> None:
        bounds = self._patches.bounds(moments.posed, obstacle)  # (N, P)
        nearest = bounds.min(axis=0)
        for i in np.argsort(nearest):
            if nearest[i] > ledger.limit:
                return
            patch = self._patches.patches[i]
            if ledger.least is None:  # one pose first: from then on the ledger has a limit
                self._judge_patch(patch, moments.at(bounds[:, [i]].argmin(axis=0)), obstacle, ledger)
            self._judge_patch(patch, moments.at(np.flatnonzero(bounds[:, i] <= ledger.limit)), obstacle, ledger)

    def _judge_patch(self, patch: Patch, moments: _Moments, obstacle: Obstacle, ledger: Ledger) -> None:
        points = self._skin.vertices(moments.posed, patch.vertices)
        corners = obstacle.seen_from(points)[:, patch.triangles]  # (n, t, 3, 3)
        gaps = obstacle.box_distance(corners.min(axis=2), corners.max(axis=2))  # (n, t)
        for row in np.argsort(gaps.min(axis=1)):
            close = gaps[row] <= ledger.limit
            if not close.any():
                return
            distance = self._distance(points[row], patch.triangles[close], obstacle)
            found = Nearness(self._regions[patch.joint], obstacle.name, float(moments.times[row]), distance)
            ledger.enter(int(moments.numbers[row]), found)

    def _distance(self, points: Floats, triangles: Ints, obstacle: Obstacle) -> float:
        """Distance of the nearest triangle; negative: how far the deepest one would have to be moved to be free."""
        coal = self._coal
        model = coal.BVHModelOBBRSS()
        model.beginModel(len(triangles), len(points))
        model.addVertices(points)
        model.addTriangles(triangles)
        model.endModel()
        bodies = (model, coal.Transform3s(), obstacle.shape, obstacle.place)
        distance = float(coal.distance(*bodies, self._nearest, coal.DistanceResult()))
        return distance if distance > 0.0 else self._depth(bodies, len(triangles))

    def _depth(self, bodies: tuple[object, ...], triangles: int) -> float:
        """The contact depth of the deepest triangle, negative (a distance query stops at the first that touches)."""
        request, result = self._coal.CollisionRequest(), self._coal.CollisionResult()
        request.num_max_contacts, request.enable_contact = triangles, True
        self._coal.collide(*bodies, request, result)
        return min([float(contact.penetration_depth) for contact in result.getContacts()], default=0.0)


def region_of(bone: str) -> str:
    """The part of the body that a bone belongs to: trunk, head, leftArm, rightArm, leftLeg, rightLeg."""
    if bone in ("neck", "head", "jaw", "leftEye", "rightEye"):
        return "head"
    side = next((side for side in ("left", "right") if bone.startswith(side)), None)
    if side is None:
        return "trunk"
    return side + ("Leg" if bone.endswith(("Leg", "Foot", "Toes")) else "Arm")
