"""A skin in patches: small pieces of surface that can be told to be far from an obstacle without being posed.

A posed vertex lies in the convex hull of the places to which its joints alone would carry it, so a patch lies in the
hull of one box for each of its joints: that round the patch's vertices as this joint alone would carry them.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.judge.obstacles import Obstacle
from elbowroom.experiment.judge.poses import Posed
from elbowroom.experiment.judge.skin import Carried, Skin
from elbowroom.experiment.judge.stretches import Stretches

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_LARGEST = 160  # triangles


@dataclass(frozen=True, eq=False)
class Patch:
    """Some triangles of a skin."""

    joint: int  # that carries most of it
    vertices: Ints  # (v,) into the skin's vertices
    triangles: Ints  # (t, 3) into `vertices`
    carried: Carried  # the vertices


@dataclass(frozen=True, eq=False)
class Patches:
    """All patches of a skin, and the boxes (of patch and joint) round them."""

    patches: tuple[Patch, ...]
    starts: Ints  # (P,) first box of each patch
    joints: Ints  # (B,) joint of each box
    centers: Floats  # (B, 3) in the joint's frame
    half_sizes: Floats  # (B, 3)

    @cached_property
    def _of_joints(self) -> list[tuple[int, Ints]]:
        """Each joint that has boxes, and which."""
        return [(int(joint), np.flatnonzero(self.joints == joint)) for joint in np.unique(self.joints)]

    @cached_property
    def _farthest(self) -> Floats:
        """How far (B,) from its joint anything in a box is at most, metres."""
        farthest: Floats = np.linalg.norm(np.abs(self.centers) + self.half_sizes, axis=1)
        return farthest

    @property
    def reach(self) -> float:
        """Metres that anything of the skin is away from the nearest of its joints, at most."""
        return float(self._farthest.max())

    def spans(self, posed: Posed, stretches: Stretches) -> tuple[Floats, Floats]:
        """The corners (S, P, 3) of boxes along the world's axes that hold the patches at all poses of S stretches."""
        middles, shape = stretches.middles, (len(stretches.middles), len(self.joints), 3)
        middle, reach = np.empty(shape), np.empty(shape)
        for joint, boxes in self._of_joints:
            turns = posed.rotations[middles, joint]  # (S, 3, 3)
            middle[:, boxes] = self.centers[boxes] @ np.swapaxes(turns, 1, 2) + posed.positions[middles, None, joint]
            reach[:, boxes] = self.half_sizes[boxes] @ np.swapaxes(np.abs(turns), 1, 2)
        reach += stretches.away(self.joints, self._farthest)[..., None]
        low, high = middle - reach, middle + reach
        return np.minimum.reduceat(low, self.starts, axis=1), np.maximum.reduceat(high, self.starts, axis=1)

    def bounds(self, number: int, posed: Posed, rows: Ints, obstacle: Obstacle) -> Floats:
        """A lower bound (n,) of the distance between a patch and an obstacle at some of N poses."""
        ends = np.append(self.starts, len(self.joints))
        boxes = slice(ends[number], ends[number + 1])
        joints = self.joints[boxes]
        own = obstacle.to_box @ posed.rotations[rows[:, None], joints]
        places = obstacle.seen_from(posed.positions[rows[:, None], joints])
        middle = _each_turned(own, self.centers[boxes]) + places
        reach = _each_turned(np.abs(own), self.half_sizes[boxes])
        return obstacle.box_distance((middle - reach).min(axis=1), (middle + reach).max(axis=1))


def _each_turned(turns: Floats, vectors: Floats) -> Floats:
    """Vectors (B, 3), each turned by its own matrix of (..., B, 3, 3)."""
    turned: Floats = (turns @ vectors[..., None])[..., 0]
    return turned


@lru_cache(maxsize=8)  # a skin is judged in many walks
def patches_of(skin: Skin) -> Patches:
    """Cut a skin into patches."""
    patches = tuple(_patch(skin, rows) for rows in _pieces(skin))
    boxes = [_boxes(skin, patch) for patch in patches]
    return Patches(
        patches=patches,
        starts=np.cumsum([0, *(len(joints) for joints, _, _ in boxes[:-1])]),
        joints=np.concatenate([joints for joints, _, _ in boxes]),
        centers=np.concatenate([0.5 * (low + high) for _, low, high in boxes]),
        half_sizes=np.concatenate([0.5 * (high - low) for _, low, high in boxes]),
    )


def _pieces(skin: Skin) -> list[Ints]:
    """Rows of triangles: by the joint that carries them, halved along their longest side until they are few."""
    carriers = skin.joints[skin.triangles[:, 0], 0]
    middles = skin.offsets[skin.triangles[:, 0], 0]
    waiting = [np.flatnonzero(carriers == joint) for joint in np.unique(carriers)]
    done = []
    while waiting:
        rows = waiting.pop()
        if len(rows) <= _LARGEST:
            done.append(rows)
            continue
        axis = int(np.argmax(np.ptp(middles[rows], axis=0)))
        order = rows[np.argsort(middles[rows, axis], kind="stable")]
        waiting += [order[: len(rows) // 2], order[len(rows) // 2 :]]
    return done


def _patch(skin: Skin, rows: Ints) -> Patch:
    corners = skin.triangles[rows]
    vertices, places = np.unique(corners, return_inverse=True)
    return Patch(int(skin.joints[corners[0, 0], 0]), vertices, places.reshape(-1, 3), skin.carried(vertices))


def _boxes(skin: Skin, patch: Patch) -> tuple[Ints, Floats, Floats]:
    """Joints (b,) that carry any of the patch, and the corners (b, 3) of the boxes in their frames."""
    joints, weights = skin.joints[patch.vertices], skin.weights[patch.vertices]
    offsets = skin.offsets[patch.vertices]
    present = np.unique(joints[weights > 0.0])
    low, high = np.empty((len(present), 3)), np.empty((len(present), 3))
    for row, joint in enumerate(present):
        carried = offsets[(joints == joint) & (weights > 0.0)]
        low[row], high[row] = carried.min(axis=0), carried.max(axis=0)
    return present, low, high
