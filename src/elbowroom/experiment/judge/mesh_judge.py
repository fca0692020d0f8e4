"""The skinned mesh against obstacles: every triangle, none left out, the far ones dismissed in bulk."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.experiment.judge.case import Case
from elbowroom.experiment.judge.crossing_triangles import crossing_depths, has_area
from elbowroom.experiment.judge.nearest_first import nearest_first
from elbowroom.experiment.judge.obstacle_index import ObstacleIndex
from elbowroom.experiment.judge.obstacles import Obstacle, coal_library
from elbowroom.experiment.judge.patches import Patch, patches_of
from elbowroom.experiment.judge.pieces import MOST, MeshPiece
from elbowroom.experiment.judge.skin import Skin
from elbowroom.experiment.judge.stretches import Stretches, stretches_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_KNOWN = 50_000  # patches, each in a pose, that are kept: some 100 MB
_AT_ONCE = 24  # poses at which a patch is looked at, the nearest first: those after them may be too far then


class _Surface:
    """The skin in the poses of a case: a patch is posed once in each, when it is first asked for."""

    def __init__(self, case: Case) -> None:
        self.case, self.posed, self.ledger = case, case.posed, case.ledger
        self.stretches: Stretches = stretches_of(case.posed)
        self._known = dict[tuple[int, int], Floats]()  # by patch and pose

    def points(self, number: int, patch: Patch, rows: Ints) -> Floats:
        """The vertices (n, v, 3) of a patch of that number at some poses, in the world."""
        if len(self._known) > _KNOWN:
            self._known.clear()
        new = [row for row in rows.tolist() if (number, row) not in self._known]
        for row, points in zip(new, patch.carried.vertices(self.posed, np.array(new, np.int64)), strict=True):
            self._known[number, row] = points
        return np.stack([self._known[number, row] for row in rows.tolist()])


class MeshJudge:
    """Judges the surface of one avatar in one scene.

    A surface is judged, not a solid: an obstacle that lies wholly inside the body, so that no triangle meets it, is
    the capsules' to find.
    """

    def __init__(self, skin: Skin, skeleton: Skeleton, obstacles: Sequence[Obstacle]) -> None:
        self._coal, self._index = coal_library(), ObstacleIndex(obstacles)
        self._patches = patches_of(skin)
        self._regions = [region_of(bone) for bone in skeleton.names]
        self._nearest = self._coal.DistanceRequest()

    @property
    def reach(self) -> float:
        """Metres that anything of the skin is away from the nearest of its joints, at most."""
        return self._patches.reach

    def judge(self, case: Case) -> None:
        """Enter what the surface does."""
        surface = _Surface(case)
        low, high = self._patches.spans(case.posed, surface.stretches)  # (S, P, 3)
        lowest, highest = low.min(axis=1), high.max(axis=1)
        for least, obstacle in self._index.nearest_first(lowest.min(axis=0), highest.max(axis=0)):
            if least > case.ledger.limit:
                return
            some = np.flatnonzero(obstacle.world_distance(lowest, highest) <= case.ledger.limit)
            if len(some):
                self._judge_obstacle(some, obstacle.world_distance(low[some], high[some]), surface, obstacle)

    def _judge_obstacle(self, some: Ints, bounds: Floats, surface: _Surface, obstacle: Obstacle) -> None:
        """Enter what the surface does to an obstacle in stretches `some` (s,); none is nearer than `bounds` (s, P)."""
        stretches, ledger = surface.stretches, surface.ledger
        if ledger.least is None:  # one pose first: from then on the ledger has a limit
            nearest, number = np.unravel_index(bounds.argmin(), bounds.shape)
            self._judge_patch(int(number), stretches.middles[some[[nearest]]], surface, obstacle)
        near, nearest = bounds <= ledger.limit, bounds.min(axis=0)
        numbers = np.flatnonzero(near.any(axis=0))
        for number in numbers[np.argsort(nearest[numbers], kind="stable")].tolist():
            if nearest[number] > ledger.limit:
                return
            self._judge_patch(number, np.unique(stretches.rows(some[near[:, number]])), surface, obstacle)

    def _judge_patch(self, number: int, rows: Ints, surface: _Surface, obstacle: Obstacle) -> None:
        """Enter what a patch does to an obstacle at those poses `rows` (n,) at which it may be near."""
        bounds = self._patches.bounds(number, surface.posed, rows, obstacle)
        for (some,) in nearest_first(bounds, lambda: surface.ledger.limit, _AT_ONCE):
            self._judge_triangles(number, rows[some], surface, obstacle)

    def _judge_triangles(self, number: int, rows: Ints, surface: _Surface, obstacle: Obstacle) -> None:
        """Enter what the triangles of a patch do to an obstacle at some poses `rows` (n,)."""
        patch = self._patches.patches[number]
        points = surface.points(number, patch, rows)
        corners = obstacle.seen_from(points)[:, patch.triangles]  # (n, t, 3, 3)
        gaps = obstacle.box_distance(corners.min(axis=2), corners.max(axis=2))  # (n, t)
        for row in np.argsort(gaps.min(axis=1)):
            close = gaps[row] <= surface.ledger.limit
            if not close.any():
                return
            triangles = patch.triangles[close & has_area(points[row, patch.triangles])]
            if not len(triangles):
                continue
            distance = self._distance(points[row], triangles, obstacle)
            surface.case.enter(int(rows[row]), self._regions[patch.joint], obstacle.name, distance)

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
        if distance > 0.0:
            return distance
        contacts = self._contacts(bodies, len(triangles))
        if not isinstance(obstacle.made_of, MeshPiece):
            return min([float(contact.penetration_depth) for contact in contacts], default=0.0)
        mine, theirs = ([getattr(contact, side) for contact in contacts] for side in ("b1", "b2"))
        return -float(crossing_depths(points[triangles[mine]], obstacle.triangles[theirs]).max(initial=0.0))

    def _contacts(self, bodies: tuple[object, ...], triangles: int) -> list[Any]:
        """All contacts of a patch with an obstacle (a distance query stops at the first that touches)."""
        request, result = self._coal.CollisionRequest(), self._coal.CollisionResult()
        request.num_max_contacts, request.enable_contact = triangles * MOST, True
        self._coal.collide(*bodies, request, result)
        return list(result.getContacts())


def region_of(bone: str) -> str:
    """The part of the body that a bone belongs to: trunk, head, leftArm, rightArm, leftLeg, rightLeg."""
    if bone in ("neck", "head", "jaw", "leftEye", "rightEye"):
        return "head"
    side = next((side for side in ("left", "right") if bone.startswith(side)), None)
    if side is None:
        return "trunk"
    return side + ("Leg" if bone.endswith(("Leg", "Foot", "Toes")) else "Arm")
