"""What cannot bend: legs and pelvis of a humanoid among the obstacles that they can touch."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.made_once import made_once
from elbowroom.body.pose.kinematics import BodyModel, body_model, leg_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.by_reference import by_reference
from elbowroom.planning.model.footing import Footing
from elbowroom.planning.root.legs.hull import StrideHull, boxes_below, some_boxes, stride_hull
from elbowroom.planning.root.legs.neighbours import Neighbours
from elbowroom.planning.root.legs.room_of_legs import Legs, room_at
from elbowroom.world.ground import ground as walked
from elbowroom.world.ground.ground import STEP, heights_along, heights_beside, tops_about
from elbowroom.world.obstacles.broad_phase import grids_of, meeting
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.walkable import StanceCapsule, WalkableMap, stance_segments, walkable_window

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_WALK, _RUN = 1.1, 2.2  # m/s
_SPARE = 0.2  # metres: more than any clearance that is asked for
_SPARE_HEIGHT = 0.05  # metres above the pelvis as it walks
_HALF_DIAGONAL = 0.71  # of a square metre
_KNEES = 0.1  # metres that legs reach farther where they climb
_CLIMB = 1.5  # metres up and down that are looked at on a way
_FAR_BELOW = 0.1  # metres above the ground: what is lower is far from a stance that is held a step above it
_BESIDE = 0.1  # metres beside a stance within which treads are stood on too: more than any room that is asked for
_LOW = 0.1  # metres: lower end of the stance capsule's axis


@by_reference
class Measures(NamedTuple):
    """What is known of somebody's legs anywhere."""

    stance: StanceCapsule  # a vertical capsule as broad as legs and pelvis in a walk and as high as the pelvis
    height: float  # of the pelvis, metres
    reach: float  # how far the legs reach in a run, with a little to spare, metres
    hull: StrideHull  # how far they reach in any stride


class WindowGrid(NamedTuple):
    """A grid on the ground, as `walkable_window` has it, and where one comes to it."""

    origin: tuple[float, float]
    heading: float
    shape: tuple[int, int]
    cell: float
    farthest: float
    height: float  # of who stands in the middle of a row, metres
    first: int  # and of which


class LowerBody:
    """Legs and pelvis, and the obstacles low enough to matter to them."""

    def __init__(self, humanoid: Humanoid, obstacles: Obstacles, ground: walked.Ground = walked.PLAIN) -> None:
        self.model: BodyModel = body_model(humanoid)
        self.footing = Footing(self.model, ground)
        self.radii: Floats32 = self.model.roots.radii
        self.stance, height, self.reach, self.hull = _measures(humanoid)
        tall = height + _SPARE_HEIGHT
        # Metres above the ground: what begins higher is not met by legs, as on the plane.
        self._tall = tall + max(ground.step, STEP)
        corners, height = obstacles.corners, tall if ground.plain else math.inf
        low = corners[:, :, 1].min(axis=1) < height
        self.height = height
        if not ground.plain:
            self.hull = self.hull._replace(extents=self.hull.extents + _KNEES)
            self.reach += _KNEES
        feet, sole = self.footing.feet, self.footing.sole
        self.legs = Legs(self.model.lower, self.radii, feet, sole, self.reach, self._tall)
        self._obstacles, self._low = obstacles, np.flatnonzero(low)
        self.boxes = boxes_below(corners[low], height, ground, tall)
        self.grids = grids_of(self.boxes.least, self.boxes.most)
        self._near: tuple[tuple[int, int, float, int], Neighbours] | None = None

    def near(self, x: float, z: float, reach: float, height: float = 0.0) -> Neighbours:
        """The obstacles within `reach` metres of a place, perhaps some a little farther: those of a square metre.

        Of several floors those that are met from a height.
        """
        asked = (round(x), round(z), reach, round(height))
        if self._near is None or self._near[0] != asked:
            far, (x, z) = reach + _HALF_DIAGONAL, asked[:2]
            near = meeting(self.grids, (x - far, z - far), (x + far, z + far))
            low, high = self.footing.heights_between(asked[3] - _CLIMB, asked[3] + _CLIMB)
            if math.isfinite(low):
                own = self.boxes.heights[near]
                near = near[(own[:, 0] <= high) & (own[:, 1] >= low)]
            self._near = asked, Neighbours(self._obstacles.picked(self._low[near]), some_boxes(self.boxes, near))
        return self._near[1]

    def clearance(self, among: Neighbours, states: Floats, spare: float = 0.0, farthest: float = math.inf) -> Floats32:
        """Clearance (N,) of legs and pelvis, posed by the gait, at root states (N, ROOT_STATE); infinite where far.

        Feet may stand on what they stand on, also for who asks for `spare` metres; negative where there is no ground.
        More than `farthest` metres are not told apart.
        """
        return room_at(self.legs, among, np.ascontiguousarray(states), spare, farthest)

    def standing_clearance(
        self, among: Neighbours, places: Floats, height: float = 0.0, farthest: float = math.inf
    ) -> Floats32:
        """Clearance (N,) of the stance capsule at `places` (N, 2) on a way over the ground that begins at a height.

        Where the ground is not plain, it is held above all that is a step high, and above the treads about it; negative
        where there is no ground. More than `farthest` metres are not told apart.
        """
        segments = stance_segments(self.stance, places[:, 0], places[:, 1])
        radii = np.array([self.stance.radius])
        if self.footing.plain:
            return clearance(segments, radii, among.obstacles, farthest)
        heights = heights_along(self.footing.ground, height, places)
        there = np.isfinite(heights)
        above = np.where(there, heights, height)
        raised, tops = self.raised_stance, self._tops(above, places)
        segments[0, 1], segments[0, 4] = tops + self.stance.radius, above + raised.high
        segments[0, 4] = np.maximum(segments[0, 4], segments[0, 1])
        near = among.above(float(above.min()) + _FAR_BELOW, float(above.max()) + self._tall)
        clear = clearance(segments.astype(np.float32), radii, near.obstacles, farthest)
        return np.where(there, clear, np.float32(-1.0))

    def _tops(self, heights: Floats, places: Floats) -> Floats:
        """What a stance at places (N, 2) and `heights` (N,) is held above (N,): a step, and the treads about it."""
        about = tops_about(self.footing.ground, heights, places, self.stance.radius + _BESIDE)
        tops: Floats = np.maximum(heights + self.footing.ground.step, about)
        return tops

    @property
    def raised_stance(self) -> StanceCapsule:
        """The stance capsule above all that is a step high."""
        low = self.footing.ground.step + self.stance.radius
        return self.stance._replace(low=low, high=max(self.stance.high, low))

    def window(self, among: Neighbours, grid: WindowGrid) -> WalkableMap:
        """The clearance of the stance capsule over a grid; where the ground is not plain, above it, as on a way."""
        origin, heading, shape, cell, farthest = grid[:5]
        if self.footing.plain:
            return walkable_window(among.obstacles, self.stance, origin, heading, shape, cell, farthest)
        sine, cosine = math.sin(heading), math.cos(heading)
        ahead, left = (cell * part for part in np.indices(shape, np.float64))
        places = np.stack([origin[0] + ahead * sine + left * cosine, origin[1] + ahead * cosine - left * sine], axis=-1)
        heights = heights_beside(self.footing.ground, grid.height, grid.first, places)
        there = np.isfinite(heights)
        above = np.where(there, heights, grid.height)
        near = among.above(float(above.min()) + _FAR_BELOW, float(above.max()) + self._tall).obstacles
        raised = self.raised_stance
        lower = self._tops(above.reshape(-1), places.reshape(-1, 2)).reshape(shape) - self.footing.ground.step
        ends = lower, np.maximum(above, lower + (raised.low - raised.high))
        found = walkable_window(near, raised, origin, heading, shape, cell, farthest, ends)
        return replace(found, clearance=np.where(there, found.clearance, np.float32(-1.0)))


@made_once
def _measures(humanoid: Humanoid) -> Measures:
    model = body_model(humanoid)
    walk, run = (_stride(model, speed) for speed in (_WALK, _RUN))
    radius, height = float(walk[:, 0].max()), float(walk[:, 1].max())
    stance = StanceCapsule(radius, _LOW, max(height - radius, _LOW))
    return Measures(stance, height, float(run.max()) + _SPARE, stride_hull(model))


def _stride(model: BodyModel, speed: float) -> Floats:
    """Greatest distance from the root aside, up and ahead of every capsule over a stride, (C, 3)."""
    roots = np.zeros((32, ROOT_STATE))
    roots[:, 3], roots[:, 6] = speed, np.linspace(0.0, 1.0, 32, endpoint=False)
    segments = np.abs(leg_capsules(model, roots)).reshape(len(model.roots.radii), 2, 3, 32)
    greatest: Floats = segments.max(axis=(1, 3)) + model.roots.radii[:, None]
    return greatest
