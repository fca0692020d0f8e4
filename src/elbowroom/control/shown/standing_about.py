"""How far a body that is shown is from what stands about it, for kernels: in one pose, and all the way to the next.

Feet are held as high as `planning/model/footing.py` tells, and what their soles stand on is left out as
`feet/above_soles.py` tells.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL
from elbowroom.body.pose.whole_body import WholeBody, posed_capsules, posed_legs
from elbowroom.by_reference import by_reference
from elbowroom.jit import brief_exact_kernel, inner_exact_kernel, plain
from elbowroom.planning.halving import begun, due, settle
from elbowroom.planning.model.footing import floors_under, levelled, lift_feet
from elbowroom.planning.model.levers import Levers, travel
from elbowroom.world.obstacles.around_body import Standing, clearances_around

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]
Both = tuple[Floats, Floats]
BothGaps = tuple[Floats32, Floats32]

_ONE = plain(1)  # part of that time at a time
HALVINGS = plain(9)  # of the time between two frames: the bound on a foot in its stride is many times what it moves
OTHERS = 2  # what is no foot
EVEN = 5e-4  # metres by which what feet stand on may differ and be one height
_TOUCHING = 0.01  # metres: who has more room is free, however much that is
_OVER_GROUND = 0.004  # metres that feet are held higher where the ground that they stand on is left out


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
def hold_feet(body: ShownBody, q: Floats, roots: Floats, axes: Floats32) -> None:
    """Lift the feet among the capsules (C, 6, N) of postures (N, DOF) and root states (N, 7 or more): they are held so.

    Nothing is done on plain ground.
    """
    if len(body.feet) == 0:
        return
    lift_feet(axes, body.feet, posed_capsules(body.whole, q, levelled(roots)), body.feet, body.radii, 0.0)


@brief_exact_kernel
def lifted_capsules(body: ShownBody, q: Floats, roots: Floats) -> Floats32:
    """The capsules (C, 6, N) of postures (N, DOF) and root states (N, 7 or more), feet as high as they are held."""
    axes = posed_capsules(body.whole, q, roots)
    hold_feet(body, q, roots, axes)
    return axes


@brief_exact_kernel
def capsules_of(body: ShownBody, root: Floats, upper: Floats, held: bool) -> Floats32:
    """The capsules (C, 6, 1) of a root state and an upper body (LOCAL,), as seen from the root's place.

    Feet are as high as they are `held`, or where they are shown.
    """
    q, near = np.zeros((1, DOF)), root.copy().reshape((1, len(root)))
    q[0, DOF - LOCAL :] = upper
    near[0, :2] = 0.0
    return lifted_capsules(body, q, near) if held else posed_capsules(body.whole, q, near)


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


@brief_exact_kernel
def are_free(legs: ShownLegs, standing: Standing, axes: Floats32, x: float, z: float, floors: Floats) -> bool:
    """Whether legs (L, 6, N) about a place (x, z) touch nothing that stands; feet keep above `floors` (2,)."""
    for n in range(axes.shape[2]):
        for c in legs.feet:
            if min(axes[c, 1, n], axes[c, 4, n]) - legs.radii[c] < floors[legs.sides[c]]:
                return False
        one = axes[:, :, n : n + 1].copy()
        if gaps_about(legs.radii, legs.sides, standing, one, x, z, floors, _TOUCHING).min() < 0.0:
            return False
    return True


@brief_exact_kernel
def proven_between(
    body: ShownBody, standing: Standing, levers: Levers, roots: Both, uppers: Both, gaps: BothGaps, floors: Floats
) -> bool:
    """Whether each capsule is proven free of what stands, all the way from one pose to another, by `halving`.

    They are told by root states and upper bodies (LOCAL,), with their `gaps` (C,) above common `floors` (2,). Who has
    as much room in between as he can move is free: more than twice that is not told apart.
    """
    first, begin, x, z = roots[0], uppers[0], roots[0][0], roots[0][1]
    root_way, upper_way, (parts, shares) = roots[1] - first, uppers[1] - begin, (np.empty(1, np.int64), np.empty(1))
    ways, found = (
        travel(levers, roots, uppers).reshape((1, len(body.radii))),
        np.empty((1, len(body.radii)), np.float32),
    )
    near, q, ends = np.empty((1, len(first))), np.zeros((1, DOF)), np.empty((2, len(body.radii)), np.float32)
    ends[0], ends[1] = gaps
    proof, enough = begun(ends, ways, _ONE, 0.0, HALVINGS), 2.0 * ways.max()
    while due(proof, parts, shares) > 0:
        near[0] = first + shares[0] * root_way
        q[0, DOF - LOCAL :] = begin + shares[0] * upper_way
        near[0, 0] -= x
        near[0, 1] -= z
        axes = lifted_capsules(body, q, near)
        found[0] = gaps_about(body.radii, body.sides, standing, axes, x, z, floors, enough)
        settle(proof, found, _ONE)
    return bool(proof.least.min() >= 0.0)
