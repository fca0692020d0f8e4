"""A body between two frames as screens show it, for kernels: root and hips go straight, joints turn by shortest arcs.

That is not where postures are that lie between the two: a foot that has just come down has none of its swing left, and
hips would be centimetres too high half-way.

How fast a point goes there is bounded by what it goes on the whole and half of what its velocity can change: no value
is farther from the mean of a function than its slope allows. Turning by `t` in all, at a distance of `a` at most, adds
t² a + 2 t v to the change for what moves with v as seen from the joint.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.pose.posing import pose_joints
from elbowroom.body.pose.whole_body import WholeBody, taken_apart
from elbowroom.jit import brief_exact_kernel, helper, inner_exact_kernel

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Both = tuple[Floats, Floats]

_STRAIGHT = 1e-6  # radians: who turns less goes straight
_HEADING = 2  # its place in a root state


class FramePair(NamedTuple):
    """Two frames one after the other, as a screen is told of them."""

    place: Floats  # (2,) x and z of the first one's root
    roots: Floats  # (2, ROOT_STATE or more), as seen from there
    joints: Floats  # (2, J, 4) local rotations, the second ones on the side of the first
    hips: Floats  # (2, 3) their joint in the root's axes
    arcs: Floats  # (J,) radians: half of what each joint turns


@brief_exact_kernel
def frame_pair(roots: Both, first: tuple[Floats, Floats], second: tuple[Floats, Floats]) -> FramePair:
    """The frames of two root states (ROOT_STATE or more,), and of `posed_joints` in the first and in the second."""
    rows, joints, hips = np.empty((2, len(roots[0]))), np.empty((2, *first[0].shape)), np.empty((2, 3))
    rows[0], rows[1] = roots[0], roots[1]
    rows[:, 0] -= roots[0][0]
    rows[:, 1] -= roots[0][1]
    joints[0], hips[0] = first
    joints[1], hips[1] = second
    arcs = np.empty(joints.shape[1])
    for j in range(len(arcs)):
        one, other, apart = joints[0, j], joints[1, j], 0.0
        if one[0] * other[0] + one[1] * other[1] + one[2] * other[2] + one[3] * other[3] < 0.0:
            for i in range(4):
                other[i] = -other[i]
        for i in range(4):
            apart += (other[i] - one[i]) ** 2
        arcs[j] = 2.0 * math.asin(min(0.5 * math.sqrt(apart), 1.0))
    return FramePair(roots[0][:2].copy(), rows, joints, hips, arcs)


@inner_exact_kernel
def capsules_on(body: WholeBody, roots: Floats, joints: Floats, hips: Floats) -> Floats32:
    """The capsules (C, 6, N) in the world for root states (N, 7 or more) and `posed_joints` (N, J, 4), (N, 3) there."""
    by = taken_apart(body)
    return pose_joints(by.tree, by.capsules, roots, joints, hips)


@inner_exact_kernel
def capsules_between(body: WholeBody, frames: FramePair, shares: Floats) -> Floats32:
    """The capsules (C, 6, N) at `shares` (N,) of the time between two frames, as seen from the first one's place."""
    count = len(shares)
    roots, hips = np.empty((count, frames.roots.shape[1])), np.empty((count, 3))
    joints = np.empty((count, len(frames.arcs), 4))
    for n in range(count):
        share = shares[n]
        roots[n] = frames.roots[0] + share * (frames.roots[1] - frames.roots[0])
        hips[n] = frames.hips[0] + share * (frames.hips[1] - frames.hips[0])
        for j in range(len(frames.arcs)):
            arc = frames.arcs[j]
            before, after = 1.0 - share, share
            if arc > _STRAIGHT:
                before, after = math.sin(before * arc) / math.sin(arc), math.sin(after * arc) / math.sin(arc)
            for i in range(4):
                joints[n, j, i] = before * frames.joints[0, j, i] + after * frames.joints[1, j, i]
    return capsules_on(body, roots, joints, hips)


@inner_exact_kernel
def speeds_between(body: WholeBody, frames: FramePair, axes: Floats32) -> Floats:
    """How fast any point of each capsule's axis goes at most between two frames, (C,) metres in all that time.

    `axes` (C, 6, 2) are those in both frames, as seen from one place.
    """
    by, speeds = taken_apart(body), np.empty(len(axes))
    parents, offsets, all_ends, joints = by.tree.parents, by.tree.offsets, by.capsules.ends, by.capsules.joints
    way = np.empty(6)
    for c in range(len(speeds)):
        reach, moved = 0.0, 0.0
        for i in range(6):
            way[i] = axes[c, i, 1] - axes[c, i, 0]
        for end in range(0, 6, 3):
            reach, moved = max(reach, _length(all_ends[c], end)), max(moved, _length(way, end))
        speeds[c] = moved + 0.5 * _bend(parents, offsets, frames, joints[c], reach)
    return speeds


@helper
def _length(row: Floats | Floats32, first: int = 0) -> float:
    """Of a vector that begins somewhere in a row."""
    return math.sqrt(row[first] * row[first] + row[first + 1] * row[first + 1] + row[first + 2] * row[first + 2])


@helper
def _bend(parents: NDArray[np.int64], offsets: Floats, frames: FramePair, joint: int, reach: float) -> float:
    """How much the velocity of a point can change, that is `reach` metres from the joint that carries it."""
    speed, bend = 0.0, 0.0
    while joint >= 0:
        turned = 2.0 * frames.arcs[joint]
        bend += turned * (turned * reach + 2.0 * speed)
        speed += turned * reach
        reach += _length(offsets[joint]) if joint > 0 else max(_length(frames.hips[0]), _length(frames.hips[1]))
        joint = parents[joint]
    turned = abs(frames.roots[1, _HEADING] - frames.roots[0, _HEADING])
    speed += _length(frames.hips[1] - frames.hips[0])
    return float(bend + turned * (turned * reach + 2.0 * speed))
