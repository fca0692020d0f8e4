"""How far a body that is shown is from what stands about it, for kernels: in one pose, and all the way to the next.

Feet are held as high as `planning/model/footing.py` tells, and what their soles stand on is left out as
`feet/above_soles.py` tells.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL
from elbowroom.body.gait.foot_state import Z
from elbowroom.body.pose.between_frames import FramePair, capsules_between, capsules_on, speeds_between
from elbowroom.body.pose.whole_body import WholeBody, posed_capsules, posed_legs
from elbowroom.body.root import FOOT, RISES, ROOT_STATE, WITH_FEET
from elbowroom.by_reference import by_reference
from elbowroom.jit import brief_exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.halving import begun, due, settle
from elbowroom.planning.model.footing import floors_under, levelled, lift_feet, lift_of
from elbowroom.world.obstacles.around_body import Standing, clearances_around

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]
Both = tuple[Floats, Floats]
BothAxes = tuple[Floats32, Floats32]
BothGaps = tuple[Floats32, Floats32]

_ONE = plain(1)  # part of that time at a time
HALVINGS = plain(9)  # of the time between two frames
OTHERS = 2  # what is no foot
EVEN = 5e-4  # metres by which what feet stand on may differ and be one height
_QUICKLY, _FAR = 0.01, 0.1  # metres between two frames: soles of who goes up or down by more, or farther, are looked at
_OVER_GROUND = 0.0055  # metres that feet are held higher where the ground that they stand on is left out


@by_reference
class ShownBody(NamedTuple):
    """What is to be known of one body on some ground."""

    whole: WholeBody
    radii: Floats32  # (C,) metres
    sides: Indices  # (C,) of capsules that keep above the left sole 0, above the right one 1, `OTHERS` of all others
    feet: Indices  # (F,) capsules round feet, that are lifted on ground that is not plain; none on plain ground


@by_reference
class ShownLegs(NamedTuple):
    """The same of what pelvis and legs carry, L capsules."""

    posed: WholeBody
    radii: Floats32  # (L,)
    sides: Indices  # (L,)
    feet: Indices  # (F,)


@inner_exact_kernel
def _as_deep(level: Floats32, feet: Indices, sides: Indices, radii: Floats32, roots: Floats) -> None:
    """Lower the `feet` (F,) among capsules (C, 6, N) in strides on the plane, to be held as high as they are on slopes.

    A foot that is as deep in a slope, at right angles to it, is farther below it. `sides` and `radii` (C,) are as in
    `ShownBody`.
    """
    for foot in feet:
        at = RISES + 2 * sides[foot] + 1
        for n in range(roots.shape[0] if roots.shape[1] > at else 0):
            longer = np.float32(1.0 / math.cos(roots[n, at]))
            for end in range(1, 6, 3):
                level[foot, end, n] = radii[foot] - longer * (radii[foot] - level[foot, end, n])


@inner_exact_kernel
def hold_feet(body: ShownBody, q: Floats, roots: Floats, axes: Floats32) -> None:
    """Lift the feet among the capsules (C, 6, N) of postures (N, DOF) and root states (N, 7 or more): they are held so.

    Nothing is done on plain ground.
    """
    if len(body.feet) == 0:
        return
    on_plane = posed_capsules(body.whole, q, levelled(roots))
    _as_deep(on_plane, body.feet, body.sides, body.radii, roots)
    lift_feet(axes, body.feet, on_plane, body.feet, body.radii, 0.0)


@brief_exact_kernel
def held_capsules(body: ShownBody, root: Floats, upper: Floats, joints: tuple[Floats, Floats]) -> Floats32:
    """The capsules (C, 6, 1) of a root state and an upper body (LOCAL,), as seen from the root's place.

    They have these `posed_joints`. Feet are as high as they are held.
    """
    q, near = np.zeros((1, DOF)), root.copy().reshape((1, len(root)))
    q[0, DOF - LOCAL :] = upper
    near[0, :2] = 0.0
    axes = capsules_on(body.whole, near, joints[0].reshape((1, *joints[0].shape)), joints[1].reshape((1, 3)))
    hold_feet(body, q, near, axes)
    return axes


@brief_exact_kernel
def room_along(legs: ShownLegs, standing: Standing, roots: Floats, lowering: float, farthest: float) -> float:
    """Metres from legs to what stands about feet, the least of root states (N, WITH_FEET); `farthest` at most.

    All have one lowering. Feet are held some millimetres higher, where ground is not plain: so what they stand on
    counts as no nearer.
    """
    count, near, lowerings, floors = len(legs.radii), roots.copy(), np.full(len(roots), lowering), np.full(3, -np.inf)
    near[:, :2] -= roots[0, :2]
    axes = posed_legs(legs.posed, near, lowerings)
    if len(legs.feet) > 0:
        on_plane = posed_legs(legs.posed, levelled(near), lowerings)
        _as_deep(on_plane, legs.feet, legs.sides, legs.radii, near)
        lift_feet(axes, legs.feet, on_plane, legs.feet, legs.radii, _OVER_GROUND)
        floors[:2] = floors_under(roots)
        floors[OTHERS] = min(floors[0], floors[1])
    each, radii, heights = (
        np.empty((len(roots) * count, 6, 1), np.float32),
        np.empty(len(roots) * count, np.float32),
        np.empty(len(roots) * count),
    )
    for n in range(len(roots)):
        for c in range(count):
            lane = n * count + c
            each[lane, :, 0], radii[lane], heights[lane] = axes[c, :, n], legs.radii[c], floors[legs.sides[c]]
    found = clearances_around(standing, each, radii, roots[0, 0], roots[0, 1], heights, farthest)
    return min(float(found.min()), farthest)


@brief_exact_kernel
def gaps_about(
    radii: Floats32, sides: Indices, standing: Standing, axes: Floats32, x: float, z: float, floors: Floats, most: float
) -> Floats32:
    """How far each capsule (C, 6, 1) about a place (x, z) is from what stands, (C,) metres: `clearances_around`.

    `radii` and `sides` are as in `ShownBody`. Both soles keep above `floors` (2,); what is no foot is held above the
    lower of them too. What is more than `most` metres is not told apart.
    """
    low, count = min(floors[0], floors[1]), len(axes)
    heights = np.full(count, low)
    if max(floors[0], floors[1]) > low + EVEN:
        for c in range(count):
            if sides[c] != OTHERS:
                heights[c] = floors[sides[c]]
    found = clearances_around(standing, axes, radii, x, z, heights, most)
    if low > -np.inf:
        for c in range(count):
            if sides[c] == OTHERS:
                lowest = min(axes[c, 1, 0], axes[c, 4, 0]) - radii[c]
                found[c] = min(found[c], lowest - np.float32(low))
    return found


@inner_exact_kernel
def _on_plane(body: ShownBody, frames: FramePair, uppers: Both) -> Floats32:
    """How high both ends of the axes of F feet are in two frames' strides on the plane, (F, 2, 2) metres.

    `uppers` (LOCAL,) are those of the frames. No feet on plain ground.
    """
    heights = np.empty((len(body.feet), 2, 2), np.float32)
    if len(body.feet) > 0:
        q = np.zeros((2, DOF))
        for n in range(2):
            q[n, DOF - LOCAL :] = uppers[n]
        level = posed_capsules(body.whole, q, levelled(frames.roots))
        _as_deep(level, body.feet, body.sides, body.radii, frames.roots)
        for f in range(len(heights)):
            for end in range(2):
                for n in range(2):
                    heights[f, end, n] = level[body.feet[f], 1 + 3 * end, n]
    return heights


@inner_exact_kernel
def _raised_between(body: ShownBody, frames: FramePair, on_plane: Floats32, shares: Floats) -> Floats32:
    """`held_between`, of who knows how high feet are `_on_plane`."""
    axes = capsules_between(body.whole, frames, shares)
    for n in range(len(shares)):
        share = np.float32(shares[n])
        for f in range(len(on_plane)):
            foot, ends = body.feet[f], on_plane[f]
            first = ends[0, 0] + share * (ends[0, 1] - ends[0, 0])
            last = ends[1, 0] + share * (ends[1, 1] - ends[1, 0])
            lift = lift_of(body.radii[foot], min(first, last))
            axes[foot, 1, n] += lift
            axes[foot, 4, n] += lift
    return axes


@brief_exact_kernel
def held_between(body: ShownBody, frames: FramePair, uppers: Both, shares: Floats) -> Floats32:
    """The capsules (C, 6, N) at `shares` (N,) of the time between two frames, as seen from the first one's place.

    As screens show them, but for feet: those are as high as they are held. How deep they are on the plane is told by
    the frames: their capsules go evenly from the one to the other there. Root states in between are none where a foot
    comes down, since what they tell of its swing ends there. `uppers` (LOCAL,) are those of the frames.
    """
    return _raised_between(body, frames, _on_plane(body, frames, uppers), shares)


@helper
def _go_far(roots: Floats) -> bool:
    """Whether a foot goes up, down or elsewhere quickly between two root states (2, ROOT_STATE or more)."""
    for side in range(2):
        if abs(roots[1, RISES + 2 * side] - roots[0, RISES + 2 * side]) > _QUICKLY:
            return True
    for foot in range(ROOT_STATE, min(roots.shape[1], WITH_FEET), FOOT):
        if math.hypot(roots[1, foot] - roots[0, foot], roots[1, foot + Z] - roots[0, foot + Z]) > _FAR:
            return True
    return False


@helper
def _soles_stay_above(body: ShownBody, frames: FramePair, uppers: Both, floors: Floats) -> bool:
    """Whether feet are no deeper in what they stand on than they may be, at some moments between two frames.

    That lies under their soles, so it is left out of their gaps. But a foot that stands is not quite still where hips
    go straight and legs turn by the shortest arcs.
    """
    axes = held_between(body, frames, uppers, np.array([0.25, 0.5, 0.75]))
    for n in range(axes.shape[2]):
        for c in body.feet:
            if min(axes[c, 1, n], axes[c, 4, n]) - body.radii[c] < floors[body.sides[c]]:
                return False
    return True


@inner_exact_kernel
def _farthest_between(body: ShownBody, frames: FramePair, on_plane: Floats32, axes: BothAxes) -> Floats:
    """`ways_between`, of who knows how high feet are `_on_plane`."""
    both, risen = np.empty((len(body.radii), 6, 2), np.float32), np.zeros(len(body.radii))
    both[:, :, 0], both[:, :, 1] = axes[0][:, :, 0], axes[1][:, :, 0]
    for f in range(len(on_plane)):
        foot, ends = body.feet[f], on_plane[f]
        for n in range(2):
            lift = lift_of(body.radii[foot], min(ends[0, n], ends[1, n]))
            both[foot, 1, n] -= lift
            both[foot, 4, n] -= lift
        risen[foot] = max(abs(ends[0, 1] - ends[0, 0]), abs(ends[1, 1] - ends[1, 0]))
    for end in range(0, 6, 3):
        both[:, end, 1] += frames.roots[1, 0]
        both[:, end + 2, 1] += frames.roots[1, 1]
    ways = speeds_between(body.whole, frames, both)
    for foot in body.feet:
        ways[foot] += risen[foot]
    return ways


@brief_exact_kernel
def ways_between(body: ShownBody, frames: FramePair, uppers: Both, axes: BothAxes) -> Floats:
    """No point of a capsule's axis goes farther between two frames, (C,) metres; `axes` (C, 6, 1) are those in both.

    A foot that is held goes as far as it is shown to, and is raised or lowered by no more than its ends on the plane.
    """
    return _farthest_between(body, frames, _on_plane(body, frames, uppers), axes)


@brief_exact_kernel
def proven_between(
    body: ShownBody,
    standing: Standing,
    frames: FramePair,
    uppers: Both,
    axes: BothAxes,
    gaps: BothGaps,
    floors: Floats,
) -> bool:
    """Whether each capsule is proven free of what stands, all the way from one frame to another, by `halving`.

    The capsules have `axes` (C, 6, 1) in both, and `gaps` (C,) above common `floors` (2,). Who has as much room in
    between as he can move is free: more than twice that is not told apart.
    """
    if len(body.feet) > 0 and _go_far(frames.roots) and not _soles_stay_above(body, frames, uppers, floors):
        return False
    x, z, (parts, shares) = frames.place[0], frames.place[1], (np.empty(1, np.int64), np.empty(1))
    on_plane = _on_plane(body, frames, uppers)
    ways = _farthest_between(body, frames, on_plane, axes).reshape((1, len(body.radii)))
    found, ends = np.empty((1, len(body.radii)), np.float32), np.empty((2, len(body.radii)), np.float32)
    ends[0], ends[1] = gaps
    proof, enough = begun(ends, ways, _ONE, 0.0, HALVINGS), 2.0 * ways.max()
    while due(proof, parts, shares) > 0:
        held = _raised_between(body, frames, on_plane, shares)
        found[0] = gaps_about(body.radii, body.sides, standing, held, x, z, floors, enough)
        settle(proof, found, _ONE)
    return bool(proof.least.min() >= 0.0)
