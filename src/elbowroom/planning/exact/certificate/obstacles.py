"""Why there is no path: the fewest obstacles that together leave no posture of a slice.

Each candidate posture of the upper body, a triple (w, l, r), is closed by what touches it: its waist by some
obstacles, its left arm under that waist by some, its right arm by some, and by nothing in the scene where the arms
touch each other. A set of obstacles blocks a slice if it closes every candidate. They are taken away one after the
other while the rest still blocks: what is left is enough, and none of it can be missed.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.certificate.closed_nodes import Closed

Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]


class SliceContacts(NamedTuple):
    """Which obstacle closes which posture of a slice; B obstacles, the likeliest to be missed first."""

    candidates: Bools  # (W, L, R) triples that count: free of the body itself, and in reach
    waist: Bools  # (B, W)
    left: Bools  # (B, W, L)
    right: Bools  # (B, W, R)


def contacts_of(candidates: Bools, closed: Sequence[Closed]) -> SliceContacts:
    """Candidates (W, L, R), and what each of some obstacles closes."""
    waists, lefts, rights = candidates.shape
    return SliceContacts(
        candidates,
        np.array([nodes.waist for nodes in closed], np.bool_).reshape(-1, waists),
        np.array([nodes.left for nodes in closed], np.bool_).reshape(-1, waists, lefts),
        np.array([nodes.right for nodes in closed], np.bool_).reshape(-1, waists, rights),
    )


@exact_kernel
def _all_closed(contacts: SliceContacts, left_in: Bools) -> bool:
    """Whether the obstacles that are left in, flags (B,), close every candidate."""
    _, waists, lefts = contacts.left.shape
    rights = contacts.right.shape[2]
    left, right = np.empty(lefts, np.bool_), np.empty(rights, np.bool_)
    for w in range(waists):
        closed = False
        left[:], right[:] = False, False
        for b in range(left_in.shape[0]):
            if left_in[b]:
                closed |= contacts.waist[b, w]
                left |= contacts.left[b, w]
                right |= contacts.right[b, w]
        if closed:
            continue
        for n in range(lefts):
            if not left[n]:
                for r in range(rights):
                    if not right[r] and contacts.candidates[w, n, r]:
                        return False
    return True


@exact_kernel
def _needed(contacts: SliceContacts) -> Bools:
    """Which obstacles (B,) are left when those that can be missed are taken away one after the other."""
    left_in = np.empty(contacts.waist.shape[0], np.bool_)
    left_in[:] = True
    for b in range(left_in.shape[0]):
        left_in[b] = False
        left_in[b] = not _all_closed(contacts, left_in)
    return left_in


def blocking_obstacles(contacts: SliceContacts) -> Indices | None:
    """Indices of obstacles that close every candidate, each of them needed; None where a candidate stays open.

    There are none to name where nothing is a candidate to begin with.
    """
    if not _all_closed(contacts, np.ones(len(contacts.waist), np.bool_)):
        return None
    return np.flatnonzero(_needed(contacts))
