"""Which joints move which points of a skin: H-Anim says it joint by joint, glTF point by point."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.x3d.model import Node

_MOST = 4  # joints that move one point


@dataclass(frozen=True, eq=False)
class SkinWeights:
    """The joints of each point; a point that no joint claims goes with the first one, the root."""

    joints: NDArray[np.int64]  # (P, 4) index into the joints
    weights: NDArray[np.float64]  # (P, 4) greatest first, sum 1


def skin_weights(joints: list[Node], points: int) -> SkinWeights:
    """The joints of `points` skin points by the joints' `skinCoordIndex` and `skinCoordWeight`; four each at most."""
    at, owner, weight = [], [], []
    for number, joint in enumerate(joints):
        index = joint.integers("skinCoordIndex")
        if len(index) and not 0 <= int(index.min()) <= int(index.max()) < points:
            raise InputError(f"{joint.place}.skinCoordIndex points to number {int(index.max())} of {points}")
        given = joint.numbers("skinCoordWeight")[: len(index)]
        at.append(index)
        owner.append(np.full(len(index), number))
        weight.append(np.concatenate([given, np.ones(len(index) - len(given))]))
    where, who = np.concatenate(at), np.concatenate(owner)
    much = np.maximum(np.concatenate(weight), 0.0)
    order = np.lexsort((-much, where))
    where, who, much = where[order], who[order], much[order]
    rank = np.arange(len(where)) - np.searchsorted(where, where)
    kept = rank < _MOST
    slots = np.zeros((points, _MOST), dtype=np.int64)
    shares = np.zeros((points, _MOST))
    slots[where[kept], rank[kept]] = who[kept]
    shares[where[kept], rank[kept]] = much[kept]
    shares[shares.sum(axis=1) <= 0.0, 0] = 1.0
    return SkinWeights(slots, shares / shares.sum(axis=1, keepdims=True))
