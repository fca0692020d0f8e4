"""A skin in patches: small pieces of surface that can be told to be far from an obstacle without being posed.

A posed vertex lies in the convex hull of the places to which its joints alone would carry it, so a patch lies in the
hull of one box for each of its joints: that round the patch's vertices as this joint alone would carry them.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.judge.obstacles import Obstacle
from elbowroom.experiment.judge.poses import Posed
from elbowroom.experiment.judge.skin import Skin

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_LARGEST = 160  # triangles


@dataclass(frozen=True, eq=False)
class Patch:
    """Some triangles of a skin."""

    joint: int  # that carries most of it
    vertices: Ints  # (v,) into the skin's vertices
    triangles: Ints  # (t, 3) into `vertices`


@dataclass(frozen=True, eq=False)
class Patches:
    """All patches of a skin, and the boxes (of patch and joint) round them."""

    patches: tuple[Patch, ...]
    starts: Ints  # (P,) first box of each patch
    joints: Ints  # (B,) joint of each box
    centers: Floats  # (B, 3) in the joint's frame
    half_sizes: Floats  # (B, 3)

    def spans(self, posed: Posed) -> tuple[Floats, Floats]:
        """The corners (N, P, 3) of boxes along the world's axes that hold the patches at N poses."""
        own = posed.rotations[:, self.joints]
        middle = np.einsum("nbij,bj->nbi", own, self.centers) + posed.positions[:, self.joints]
        reach = np.einsum("nbij,bj->nbi", np.abs(own), self.half_sizes)
        low, high = middle - reach, middle + reach
        return np.minimum.reduceat(low, self.starts, axis=1), np.maximum.reduceat(high, self.starts, axis=1)

    def bounds(self, number: int, posed: Posed, rows: Ints, obstacle: Obstacle) -> Floats:
        """A lower bound (n,) of the distance between a patch and an obstacle at some of N poses."""
        ends = np.append(self.starts, len(self.joints))
        boxes = slice(ends[number], ends[number + 1])
        joints = self.joints[boxes]
        own = np.einsum("ij,nbjl->nbil", obstacle.to_box, posed.rotations[rows[:, None], joints])
        places = obstacle.seen_from(posed.positions[rows[:, None], joints])
        middle = np.einsum("nbij,bj->nbi", own, self.centers[boxes]) + places
        reach = np.einsum("nbij,bj->nbi", np.abs(own), self.half_sizes[boxes])
        return obstacle.box_distance((middle - reach).min(axis=1), (middle + reach).max(axis=1))


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
    return Patch(int(skin.joints[corners[0, 0], 0]), vertices, places.reshape(-1, 3))


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
