"""How the feet of a walk stand on the ground: what rises under them, and how much of them may be in it.

Where a foot stands, and where it will, follows from the root's state (`gait.stood_places`). It stands on the highest
ground under its sole, or so near before or behind it that it would come against its edge; on its way it goes from the
one height to the other, higher where something is in between.

A capsule round a foot reaches a little below the sole, at heel strike more. As deep as it is below level ground in the
same stride it may be below any: feet are held against obstacles as much higher, so they may stand on them, no more.
"""

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF
from elbowroom.body.gait.cycle import stood_places
from elbowroom.body.gait.smoothstep import smoothstep
from elbowroom.body.pose.kinematics import BodyModel, CapsuleSet, leg_capsules, posture_capsules
from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE
from elbowroom.by_reference import by_reference
from elbowroom.jit import brief_exact_kernel, helper, inner_exact_kernel
from elbowroom.world.ground.ground import PLAIN, Ground, height_along, level_about, under_body
from elbowroom.world.ground.sole import Sole, sole_on
from elbowroom.world.ground.swept import set_highest_under
from elbowroom.world.obstacles.obstacles import EVERY_HEIGHT, Span

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Longs = NDArray[np.int64]

IN_GROUND = 0.003  # metres that a sole may be in what it stands on
_NONE = -math.inf
OVER = 0.16  # of the highest step that a swinging foot keeps above an edge, as it is planned and as it is shown
_BESIDE = 0.04  # metres before and behind an edge that a foot keeps: where it rolls its toes come 3 cm farther
_LEVEL = 0.002  # metres: what is no higher in its way is not stepped over
_LOOKS = 25  # places of a swing that are looked at
_QUICKEST = 0.12  # the part of a swing in which a foot is raised over what is close, at least
_BELOW, _ABOVE = 0.4, 1.4  # of a standing body's height: so far below and above its place it reaches at most
_UPRIGHT, _EVEN = 1e-4, 5e-4  # radians: a level sole; metres by which level ground may be uneven
NOWHERE = np.full(2, -math.inf)
_NOTHING: Any = np.float32(0.0)
_IN_GROUND: Any = np.float32(IN_GROUND)
_UP, _DOWN = 0.7, 0.3  # the part of a swing by which a foot is up, or until which it does not come down
_TIMES = np.arange(1.0, _LOOKS) / _LOOKS
_GONE = _TIMES * _TIMES * (3.0 - 2.0 * _TIMES)  # how much of its way a foot has gone at those times of its swing


@by_reference
class Underfoot(NamedTuple):
    """What feet stand on, for kernels that call `set_rises`."""

    ground: Ground
    sole: Sole


ON_PLANE = Underfoot(PLAIN, Sole(0.0, 0.0, 0.0))


class Footing:
    """The feet of one body on the ground of one scene; frozen."""

    def __init__(self, model: BodyModel, ground: Ground) -> None:
        self._model, self.ground = model, ground

    @property
    def underfoot(self) -> Underfoot:
        """The same for kernels."""
        return Underfoot(self.ground, self.sole)

    @property
    def plain(self) -> bool:
        """Whether all feet stand on the plane."""
        return self.ground.plain

    def stood(self, states: Floats) -> tuple[Floats, Bools]:
        """Root states (N, ROOT_STATE) with what the feet stand on in them, and in which there is ground for both (N,).

        The states themselves on plain ground.
        """
        if self.ground.plain:
            return states, np.ones(len(states), np.bool_)
        rows = states.copy()
        return rows, set_rises(self.ground, self._model.gait.legs, self._model.gait.scale, self.sole, rows)

    def heights(self, states: Floats) -> Span:
        """From where to where bodies reach in root states (N, ROOT_STATE); all heights on plain ground."""
        if self.ground.plain:
            return EVERY_HEIGHT
        return self.heights_between(float(states[:, HEIGHT].min()), float(states[:, HEIGHT].max()))

    def heights_between(self, least: float, most: float) -> Span:
        """From where to where bodies reach whose places are between two heights; all heights on plain ground."""
        if self.ground.plain:
            return EVERY_HEIGHT
        return least - _BELOW * self._tall, most + _ABOVE * self._tall

    def floors(self, states: Floats) -> Floats:
        """For both feet heights (2,) that their soles keep above in root states (N, ROOT_STATE) that are `stood`.

        What rises no higher is not in the way of a foot that is held higher. Minus infinity where a sole is tilted.
        """
        if self.ground.plain:
            return NOWHERE
        return floors_under(states)

    def over_soles(self, states: Floats) -> Span:
        """From where to where what is in the way reaches in root states (N, ROOT_STATE) that are `stood`."""
        low, high = self.heights(states)
        return max(low, float(self.floors(states).min())), high

    @cached_property
    def _tall(self) -> float:
        """How high the standing body is, metres."""
        ends = posture_capsules(self._model, np.zeros((1, DOF)), np.zeros((1, ROOT_STATE)))[:, [1, 4], 0]
        return float((ends.max(axis=1) + self._model.body.radii).max())

    def _feet(self, capsules: CapsuleSet) -> Bools:
        """Which of the capsules (C,) are round feet and toes; of the legs' or of the whole body's."""
        left, right = self.each_foot(capsules)
        both: Bools = left | right
        return both

    def each_foot(self, capsules: CapsuleSet) -> Bools:
        """Which of the capsules (2, C) are round the left foot, and the right one."""
        return self._feet_of[0 if capsules is self._model.roots else 1]

    @cached_property
    def _feet_of(self) -> tuple[Bools, Bools]:
        feet, sets = self._model.tree.legs[:, 2:], (self._model.roots, self._model.body)
        legs, body = (np.array([np.isin(each.joints, own) for own in feet]) for each in sets)
        return legs, body

    @cached_property
    def feet(self) -> Longs:
        """The numbers (F,) of the legs' capsules that are round feet and toes."""
        return np.flatnonzero(self._feet(self._model.roots))

    @cached_property
    def sole(self) -> Sole:
        """The rectangle over which the capsules of a standing foot lie, about its ankle, and what it keeps to edges.

        So a foot is never just before an edge, nor rolls or slides into one: it is on it already.
        """
        roots, legs = self._model.roots, self._model.gait.legs
        feet = self._feet(roots)
        ends = leg_capsules(self._model, np.zeros((1, ROOT_STATE)))[feet].reshape(-1, 2, 3).astype(np.float64)
        radii, ankle = roots.radii[feet][:, None], legs[:, 5].mean()
        aside = np.abs(np.abs(ends[:, :, 0]) - np.abs(legs[:, 3]).mean()) + radii
        return Sole(
            float((ankle - ends[:, :, 2] + radii).max()) + _BESIDE,
            float((ends[:, :, 2] + radii - ankle).max()) + _BESIDE,
            float(aside.max()),
        )


@helper
def _uneased(y: float) -> float:
    """Where `smoothstep` is `y`."""
    return 0.5 - math.sin(math.asin(1.0 - 2.0 * min(max(y, 0.0), 1.0)) / 3.0)


@helper
def _climbed(w: float, rise: float) -> float:
    """How much of the way up or down it has gone by then: up early, down late."""
    return smoothstep(w / _UP) if rise > 0.0 else smoothstep((w - _DOWN) / (1.0 - _DOWN))


@helper
def in_world(root: Floats, x: float, z: float) -> tuple[float, float]:
    """A place x, z in the frame of a root, as the world has it."""
    sine, cosine = math.sin(root[2]), math.cos(root[2])
    return root[0] + x * cosine + z * sine, root[1] - x * sine + z * cosine


@inner_exact_kernel
def stood_at(ground: Ground, sole: Sole, root: Floats, x: float, z: float, yaw: float) -> tuple[float, float]:
    """Height and slope of the ground under a foot at a place in a root's frame; minus infinity without any.

    One comes there from the ground under the root.
    """
    wx, wz = in_world(root, x, z)
    under = under_body(ground, root[0], root[HEIGHT], root[1])
    near = height_along(ground, (root[0], under, root[1]), wx, wz)
    if near == _NONE:
        return near, 0.0
    return sole_on(ground, sole, (wx, near, wz), root[2] + yaw)


@helper
def _level_under(ground: Ground, sole: Sole, root: Floats, places: Floats) -> float:
    """The height of the ground where it is one level under a root and a foot at `places` (3,) or (6,), and in between.

    Minus infinity where it is not.
    """
    sine, cosine = math.sin(root[2]), math.cos(root[2])
    low_x, high_x, low_z, high_z = 0.0, 0.0, 0.0, 0.0
    for i in range(0, places.shape[0], 3):
        x, z = places[i] * cosine + places[i + 1] * sine, places[i + 1] * cosine - places[i] * sine
        low_x, high_x, low_z, high_z = min(low_x, x), max(high_x, x), min(low_z, z), max(high_z, z)
    around = math.hypot(max(sole.back, sole.ahead), sole.aside)
    reach = 0.5 * max(high_x - low_x, high_z - low_z) + around
    middle_x, middle_z = root[0] + 0.5 * (low_x + high_x), root[1] + 0.5 * (low_z + high_z)
    return level_about(ground, middle_x, middle_z, reach, root[HEIGHT])


@helper
def _swung(ground: Ground, sole: Sole, root: Floats, places: Floats, w: float) -> tuple[float, float]:
    """Height and slope of a swinging foot between the `places` (6,) where it stood and will, the part `w` of it over.

    It goes from one place to the other as the cycle has it, at rest over the ground at both ends.
    """
    begin, first = stood_at(ground, sole, root, places[0], places[1], places[2])
    end, last = stood_at(ground, sole, root, places[3], places[4], places[5])
    if min(begin, end) == _NONE:
        return _NONE, 0.0
    rise, lacks, overs = end - begin, 0.0, np.empty(_TIMES.shape[0])
    above, (x, z) = max(rise, 0.0), in_world(root, places[0], places[1])
    to_x, to_z = in_world(root, places[3], places[4])
    way = (x, z, root[2] + places[2], first), (to_x, to_z, root[2] + places[5], last)
    set_highest_under(ground, sole, way[0], way[1], begin, _GONE, overs)
    for k in range(overs.shape[0]):
        overs[k] -= begin
        above, lacks = max(above, overs[k]), max(lacks, overs[k] - _climbed(_TIMES[k], rise) * rise)
    part = _climbed(w, rise)
    over = OVER * ground.step
    height = begin + (_lifted(overs, rise, above + over, over, w) if lacks > _LEVEL else part * rise)
    return height, first + part * (last - first)


@helper
def _lifted(overs: Floats, rise: float, top: float, over: float, w: float) -> float:
    """How high a foot is lifted that goes over edges: up to the `top`, no sooner and no later than it must, and down.

    `overs` are heights of the ground in its way at `_TIMES`, `rise` is that of where it comes down; all from where it
    stood. It keeps so far `over` edges.
    """
    up, down, early = _UP, _UP, 0.5 / _LOOKS
    for k in range(overs.shape[0]):
        if overs[k] > _LEVEL:
            up = min(up, (_TIMES[k] - early) / _uneased((overs[k] + 0.9 * over) / top))
        if overs[k] > rise + _LEVEL:
            down = min(down, (1.0 - _TIMES[k] - early) / _uneased((overs[k] + 0.9 * over - rise) / (top - rise)))
    risen, sunk = smoothstep(w / max(up, _QUICKEST)), smoothstep((1.0 - w) / max(down, _QUICKEST))
    return min(top * risen, rise + (top - rise) * sunk)


@brief_exact_kernel
def set_rises(ground: Ground, legs: Floats, scale: float, sole: Sole, roots: Floats) -> Bools:
    """Write to root states (N, ROOT_STATE) what their feet stand on; in which of them there is ground for both (N,)."""
    found, places = np.ones(roots.shape[0], np.bool_), np.empty(6)
    for n in range(roots.shape[0]):
        root = roots[n]
        for side in range(2):
            w, at = stood_places(legs, scale, root, side, places), RISES + 2 * side
            level = _level_under(ground, sole, root, places[:6] if w > 0.0 else places[:3])
            if level > _NONE:
                height, slope = level, 0.0
            elif w > 0.0:
                height, slope = _swung(ground, sole, root, places, w)
            else:
                height, slope = stood_at(ground, sole, root, places[0], places[1], places[2])
            found[n] = found[n] and height > _NONE
            root[at], root[at + 1] = height - root[HEIGHT] if height > _NONE else 0.0, slope
    return found


@brief_exact_kernel
def floors_under(states: Floats) -> Floats:
    """`Footing.floors` (2,), on ground that is not plain."""
    floors = np.empty(2)
    for side in range(2):
        at, floor, tilted = RISES + 2 * side, np.inf, 0.0
        for n in range(states.shape[0]):
            floor = min(floor, states[n, HEIGHT] + states[n, at])
            tilted = max(tilted, abs(states[n, at + 1]))
        floors[side] = floor + _EVEN if tilted < _UPRIGHT else _NONE
    return floors


@inner_exact_kernel
def levelled(states: Floats) -> Floats:
    """Root states (N, ROOT_STATE) in the same strides on the plane."""
    level = states.copy()
    level[:, HEIGHT] = 0.0
    level[:, RISES:ROOT_STATE] = 0.0
    return level


@helper
def lift_of(radius: Any, lowest: Any) -> Any:
    """Metres that a foot is held higher whose capsule's axis comes as low as that in the same stride on the plane."""
    return max(radius - lowest, _NOTHING) + _IN_GROUND


@inner_exact_kernel
def lift_feet(segments: Floats32, feet: Longs, on_plane: Floats32, soles: Longs, radii: Floats32, spare: float) -> None:
    """Raise the capsules `feet` (F,) among `segments` (C, 6, N) by as much as feet are below the plane, and 3 mm.

    That is told by the capsules `soles` (F,) of legs `on_plane` (L, 6, N) in the same strides, with `radii` (L,). They
    are raised by `spare` metres more.
    """
    for f in range(feet.shape[0]):
        own, sole = segments[feet[f]], on_plane[soles[f]]
        for n in range(segments.shape[2]):
            lift = lift_of(radii[soles[f]], min(sole[1, n], sole[4, n])) + np.float32(spare)
            own[1, n] += lift
            own[4, n] += lift
