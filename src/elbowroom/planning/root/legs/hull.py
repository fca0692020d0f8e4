"""Rectangles on the ground that hold legs and pelvis during a key interval: what is far from them is not checked.

Posing legs costs a thousand times more than telling that a rectangle is beside a box. So the exact check of a path is
left for the key intervals whose rectangle meets a box. Where feet stand on level ground all over the rectangle, what
does not rise from it is not in the way, nor what hangs above the legs.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.pose.kinematics import BodyModel, leg_capsules
from elbowroom.body.root import HEIGHT, ROOT_STATE
from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel
from elbowroom.world.ground.ground import PLAIN, Ground, level_about
from elbowroom.world.obstacles.broad_phase import Grids, meeting_any_order

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_STEPS = (6, 2, 2)  # cells of the table of strides: forward, lateral, turn
_GREATEST = (2.4, 0.8, 2.6)  # m/s, m/s, rad/s; what is faster is always checked
_STRAIGHT = (0.005, 0.01)  # m/s, rad/s: who goes aside or turns no faster has the stride of one who does not, nearly
_PHASES = 16
_SPARE = 0.01  # metres: strides between those that were measured, and nearly straight ones
_FLAT = 1e-12  # metres
_MORE = 0.003  # metres
_EVEN = 5e-4  # metres by which level ground may rise
_PIECE = 0.5  # metres of a route


@by_reference
class StrideHull(NamedTuple):
    """How far legs and pelvis reach from the root in a stride no faster than the table's velocities, metres."""

    extents: Floats  # (F, L, T, 3) to either side, behind, ahead
    cell: Floats  # (3,) m/s, m/s, rad/s


@by_reference
class LowBoxes(NamedTuple):
    """What stands on the ground, seen from above."""

    corners: Floats  # (B, P, 2) x and z of the corners of what is low enough of each box
    least: Floats  # (B, 2)
    most: Floats  # (B, 2)
    heights: Floats  # (B, 2) from where to where each box reaches
    underfoot: Ground  # what feet stand on; on the plane heights do not count
    tall: float  # metres that legs reach above that


_ENDS = np.array([(i, i + step) for step in (1, 2, 4) for i in range(8) if not i & step])  # a box's edges


def boxes_below(corners: Floats, height: float, underfoot: Ground = PLAIN, tall: float = np.inf) -> LowBoxes:
    """What the parts of boxes below a height cover; `corners` (B, 8, 3) each partly below."""
    one, other = corners[:, _ENDS[:, 0]], corners[:, _ENDS[:, 1]]
    rise = other[..., 1] - one[..., 1]
    at = np.clip((height - one[..., 1]) / np.where(np.abs(rise) < _FLAT, _FLAT, rise), 0.0, 1.0)[..., None]
    cut = one + at * (other - one)
    ends = [np.where(end[..., 1:2] <= height, end, cut) for end in (one, other)]
    low = np.concatenate(ends, axis=1)
    # An edge that lies above altogether gives one end of it: put a point in its place that is below.
    below = low[..., 1] <= height + 1e-9
    low = np.where(below[..., None], low, np.take_along_axis(low, below.argmax(axis=1)[:, None, None], axis=1))
    points = np.ascontiguousarray(low[..., [0, 2]])
    heights = np.stack([corners[:, :, 1].min(axis=1), corners[:, :, 1].max(axis=1)], axis=1)
    return LowBoxes(points, points.min(axis=1), points.max(axis=1), heights, underfoot, tall)


def some_boxes(boxes: LowBoxes, chosen: Bools | NDArray[np.int64]) -> LowBoxes:
    """Some of them."""
    corners, least, most, heights, underfoot, tall = boxes
    return LowBoxes(corners[chosen], least[chosen], most[chosen], heights[chosen], underfoot, tall)


def joined_boxes(one: LowBoxes, other: LowBoxes) -> LowBoxes:
    """Those of both, on the ground of the first."""
    corners, least, most, heights = (np.concatenate([a, b]) for a, b in zip(one[:4], other[:4], strict=True))
    return LowBoxes(corners, least, most, heights, one.underfoot, one.tall)


def stride_hull(model: BodyModel) -> StrideHull:
    """Measure a body's strides in all directions."""
    axes = [np.linspace(0.0, most, steps + 1) for most, steps in zip(_GREATEST, _STEPS, strict=True)]
    signed = [np.concatenate([-axis[:0:-1], axis]) for axis in axes]
    grid = np.stack(np.meshgrid(*signed, np.arange(_PHASES) / _PHASES, indexing="ij"), axis=-1)
    states = np.zeros((grid[..., 0].size, ROOT_STATE))
    states[:, 3:7] = grid.reshape(-1, 4)
    segments = leg_capsules(model, states).reshape(len(model.roots.radii), 2, 3, -1).astype(np.float64)
    high = (segments + model.roots.radii[:, None, None, None]).max(axis=(0, 1))
    low = (segments - model.roots.radii[:, None, None, None]).min(axis=(0, 1))
    reach = np.stack([np.maximum(high[0], -low[0]), -low[2], high[2]], axis=-1)
    reach = reach.reshape(*grid.shape[:4], 3).max(axis=3)
    for axis, steps in enumerate(_STEPS):
        outward = np.moveaxis(reach, axis, 0)
        reach = np.moveaxis(np.maximum.accumulate(np.maximum(outward[steps:], outward[steps::-1]), axis=0), 0, axis)
    return StrideHull(np.ascontiguousarray(reach) + _SPARE, np.array([axis[1] for axis in axes]))


@helper
def _meets(x: float, z: float, heading: float, near: float, low: Floats, high: Floats, boxes: LowBoxes) -> bool:
    """Whether the rectangle from `low` to `high` (2,), to the left and ahead of a place, may meet a box.

    Of floors above one another that which is about as high as `near`.
    """
    sine, cosine = np.sin(heading), np.cos(heading)
    wide, deep = 0.5 * (high[0] - low[0]), 0.5 * (high[1] - low[1])
    left, ahead = 0.5 * (high[0] + low[0]), 0.5 * (high[1] + low[1])
    middle_x, middle_z = x + left * cosine + ahead * sine, z - left * sine + ahead * cosine
    span_x, span_z = wide * abs(cosine) + deep * abs(sine), wide * abs(sine) + deep * abs(cosine)
    found, floor, roof = False, -np.inf, np.inf
    if not boxes.underfoot.plain:
        level = level_about(boxes.underfoot, middle_x, middle_z, max(span_x, span_z), near)
        if level > -np.inf:
            floor, roof = level + _EVEN, level + boxes.tall
    for b in range(boxes.corners.shape[0]):
        if boxes.heights[b, 1] <= floor or boxes.heights[b, 0] >= roof:
            continue
        if (
            middle_x + span_x < boxes.least[b, 0]
            or middle_x - span_x > boxes.most[b, 0]
            or middle_z + span_z < boxes.least[b, 1]
            or middle_z - span_z > boxes.most[b, 1]
        ):
            continue
        least_l, most_l, least_a, most_a = np.inf, -np.inf, np.inf, -np.inf
        for c in range(boxes.corners.shape[1]):
            dx, dz = boxes.corners[b, c, 0] - x, boxes.corners[b, c, 1] - z
            across, along = dx * cosine - dz * sine, dx * sine + dz * cosine
            least_l, most_l = min(least_l, across), max(most_l, across)
            least_a, most_a = min(least_a, along), max(most_a, along)
        if least_l <= high[0] and most_l >= low[0] and least_a <= high[1] and most_a >= low[1]:
            found = True
            break
    return found


@helper
def _swept(hull: StrideHull, a: Floats, b: Floats, turned: float, more: float, low: Floats, high: Floats) -> bool:
    """The rectangle in the frame of state `a` that holds the strides from there to place and heading of `b`.

    Velocities are at most those of the two states. False if they are faster than the table knows.
    """
    speed = max(np.sqrt(a[3] * a[3] + a[4] * a[4]), np.sqrt(b[3] * b[3] + b[4] * b[4]))
    mixed = abs(turned) * speed
    i = int(np.ceil((max(abs(a[3]), abs(b[3])) + mixed) / hull.cell[0] - 1e-9))
    j = int(np.ceil(max(max(abs(a[4]), abs(b[4])) + mixed - _STRAIGHT[0], 0.0) / hull.cell[1] - 1e-9))
    k = int(np.ceil(max(max(abs(a[5]), abs(b[5])) - _STRAIGHT[1], 0.0) / hull.cell[2] - 1e-9))
    if i >= hull.extents.shape[0] or j >= hull.extents.shape[1] or k >= hull.extents.shape[2]:
        return False
    side, behind, ahead = hull.extents[i, j, k, 0], hull.extents[i, j, k, 1], hull.extents[i, j, k, 2]
    more += 0.125 * turned * turned * (side + max(behind, ahead))
    sine, cosine = np.sin(a[2]), np.cos(a[2])
    dx, dz = b[0] - a[0], b[1] - a[1]
    left, along = dx * cosine - dz * sine, dx * sine + dz * cosine
    low[0], high[0], low[1], high[1] = -side, side, -behind, ahead
    sine, cosine = np.sin(turned), np.cos(turned)
    for n in range(4):
        x, z = (side if n % 2 == 0 else -side), (ahead if n < 2 else -behind)
        corner_l, corner_a = left + x * cosine + z * sine, along - x * sine + z * cosine
        low[0], high[0] = min(low[0], corner_l), max(high[0], corner_l)
        low[1], high[1] = min(low[1], corner_a), max(high[1], corner_a)
    for n in range(2):
        low[n] -= more
        high[n] += more
    return True


@helper
def _height(state: Floats) -> float:
    return float(state[HEIGHT]) if state.shape[0] > HEIGHT else 0.0


@helper
def _change(a: Floats, b: Floats) -> float:
    """The change of the ground velocity between two states, m/s."""
    sine_a, cosine_a, sine_b, cosine_b = np.sin(a[2]), np.cos(a[2]), np.sin(b[2]), np.cos(b[2])
    dx = b[3] * sine_b + b[4] * cosine_b - a[3] * sine_a - a[4] * cosine_a
    dz = b[3] * cosine_b - b[4] * sine_b - a[3] * cosine_a + a[4] * sine_a
    return float(np.sqrt(dx * dx + dz * dz))


@exact_kernel
def to_check(
    states: Floats, interval: float, braking: float, swinging: float, skin: float, hull: StrideHull, boxes: LowBoxes
) -> tuple[Bools, Bools]:
    """Which key intervals (n,), and which stops from their ends (n,), may come within `skin` of something.

    `braking` and `swinging` are the accelerations, m/s^2 and rad/s^2, with which a stop is made.
    """
    count = states.shape[0] - 1
    moving, stopping = np.empty(count, np.bool_), np.empty(count, np.bool_)
    low, high, rest = np.empty(2), np.empty(2), np.empty(states.shape[1])
    rest[:] = 0.0
    for k in range(count):
        a, b = states[k], states[k + 1]
        bulge = 0.125 * interval * _change(a, b)
        known = _swept(hull, a, b, b[2] - a[2], skin + _MORE + bulge, low, high)
        moving[k] = not known or _meets(a[0], a[1], a[2], _height(a), low, high, boxes)
        speed, sine, cosine = np.sqrt(b[3] * b[3] + b[4] * b[4]), np.sin(b[2]), np.cos(b[2])
        lasting, turning = 0.5 * speed / braking + 0.5 * interval, 0.5 * abs(b[5]) / swinging + 0.5 * interval
        rest[0] = b[0] + lasting * (b[3] * sine + b[4] * cosine)
        rest[1] = b[1] + lasting * (b[3] * cosine - b[4] * sine)
        known = _swept(hull, b, rest, turning * b[5], skin + _MORE, low, high)
        stopping[k] = not known or _meets(b[0], b[1], b[2], _height(b), low, high, boxes)
    return moving, stopping


@exact_kernel
def route_is_open(route: Floats, near: float, half: float, boxes: LowBoxes) -> bool:
    """Whether nothing stands on the strips of half width `half` along a route (m, 2), corner points x and z.

    It begins at a height `near`. Strips over ground that is not the plane are looked at in short pieces.
    """
    low, high = np.empty(2), np.empty(2)
    low[0], low[1], high[0] = -half, -half, half
    for i in range(route.shape[0] - 1):
        dx, dz = route[i + 1, 0] - route[i, 0], route[i + 1, 1] - route[i, 1]
        length, heading = np.hypot(dx, dz), np.arctan2(dx, dz)
        count = 1 if boxes.underfoot.plain else max(int(np.ceil(length / _PIECE)), 1)
        high[1] = length / count + half
        for k in range(count):
            if _meets(route[i, 0] + dx * k / count, route[i, 1] + dz * k / count, heading, near, low, high, boxes):
                return False
    return True


@inner_exact_kernel
def boxes_near(boxes: LowBoxes, grids: Grids, x: float, z: float, reach: float) -> LowBoxes:
    """Those that may come within `reach` metres of a place; `grids` as `grids_of` its bounds."""
    near = meeting_any_order(grids, x - reach, z - reach, x + reach, z + reach)
    count = near.shape[0]
    found = LowBoxes(
        np.empty((count, boxes.corners.shape[1], 2)), np.empty((count, 2)), np.empty((count, 2)), np.empty((count, 2)),
        boxes.underfoot, boxes.tall,
    )  # fmt: skip
    for n in range(count):
        for i in range(2):
            found.least[n, i], found.most[n, i] = boxes.least[near[n], i], boxes.most[near[n], i]
            found.heights[n, i] = boxes.heights[near[n], i]
            for c in range(boxes.corners.shape[1]):
                found.corners[n, c, i] = boxes.corners[near[n], c, i]
    return found
