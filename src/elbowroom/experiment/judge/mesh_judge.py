"""The skinned mesh against obstacles: every triangle, none left out, the far ones dismissed in bulk."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.experiment.judge.around import Around
from elbowroom.experiment.judge.crossing_triangles import crossing_depths
from elbowroom.experiment.judge.ledger import Ledger, Nearness
from elbowroom.experiment.judge.obstacles import Obstacle, coal_library
from elbowroom.experiment.judge.patches import Patch, patches_of
from elbowroom.experiment.judge.pieces import MOST, Piece
from elbowroom.experiment.judge.poses import Posed
from elbowroom.experiment.judge.skin import Skin

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class _Moments:
    """Some poses, and the skin in them: a patch is posed once, when it is first asked for."""

    def __init__(self, skin: Skin, posed: Posed, times: Floats, first: int) -> None:
        self.posed, self.times, self.first = posed, times, first
        self._skin, self._known = skin, dict[int, Floats]()

    def points(self, number: int, patch: Patch) -> Floats:
        """The vertices (N, v, 3) of a patch of that number, in the world."""
        if number not in self._known:
            self._known[number] = self._skin.vertices(self.posed, patch.vertices)
        return self._known[number]


class MeshJudge:
    """Judges the surface of one avatar in one scene.

    A surface is judged, not a solid: an obstacle that lies wholly inside the body, so that no triangle meets it, is
    the capsules' to find.
    """

    def __init__(self, skin: Skin, skeleton: Skeleton, obstacles: Sequence[Obstacle]) -> None:
        self._coal, self._skin, self._around = coal_library(), skin, Around(obstacles)
        self._patches = patches_of(skin)
        self._regions = [region_of(bone) for bone in skeleton.names]
        self._nearest = self._coal.DistanceRequest()

    def judge(self, posed: Posed, times: Floats, first: int, ledger: Ledger) -> None:
        """Enter what the surface does at N poses, whose numbers begin at `first`."""
        moments = _Moments(self._skin, posed, times, first)
        low, high = self._patches.spans(posed)  # (N, P, 3)
        lowest, highest = low.min(axis=1), high.max(axis=1)
        for least, obstacle in self._around.nearest_first(lowest.min(axis=0), highest.max(axis=0)):
            if least > ledger.limit:
                return
            rows = np.flatnonzero(obstacle.world_distance(lowest, highest) <= ledger.limit)
            if len(rows):
                self._judge_obstacle(rows, obstacle.world_distance(low[rows], high[rows]), moments, obstacle, ledger)

    def _judge_obstacle(
        self, rows: Ints, bounds: Floats, moments: _Moments, obstacle: Obstacle, ledger: Ledger
    ) -> None:
        """Enter what the surface does to an obstacle at poses `rows` (n,); no patch is nearer than `bounds` (n, P)."""
        if ledger.least is None:  # one pose first: from then on the ledger has a limit
            row, number = np.unravel_index(bounds.argmin(), bounds.shape)
            self._judge_patch(int(number), rows[[row]], moments, obstacle, ledger)
        near, nearest = bounds <= ledger.limit, bounds.min(axis=0)
        numbers = np.flatnonzero(near.any(axis=0))
        for number in numbers[np.argsort(nearest[numbers], kind="stable")].tolist():
            if nearest[number] > ledger.limit:
                return
            self._judge_patch(number, rows[near[:, number]], moments, obstacle, ledger)

    def _judge_patch(self, number: int, rows: Ints, moments: _Moments, obstacle: Obstacle, ledger: Ledger) -> None:
        """Enter what a patch does to an obstacle at those poses `rows` (n,) at which it may be near."""
        patch = self._patches.patches[number]
        rows = rows[self._patches.bounds(number, moments.posed, rows, obstacle) <= ledger.limit]
        if not len(rows):
            return
        points = moments.points(number, patch)[rows]
        corners = obstacle.seen_from(points)[:, patch.triangles]  # (n, t, 3, 3)
        gaps = obstacle.box_distance(corners.min(axis=2), corners.max(axis=2))  # (n, t)
        for row in np.argsort(gaps.min(axis=1)):
            close = gaps[row] <= ledger.limit
            if not close.any():
                return
            distance = self._distance(points[row], patch.triangles[close], obstacle)
            found = Nearness(self._regions[patch.joint], obstacle.name, float(moments.times[rows[row]]), distance)
            ledger.enter(moments.first + int(rows[row]), found)

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
        if not isinstance(obstacle.made_of, Piece):
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
