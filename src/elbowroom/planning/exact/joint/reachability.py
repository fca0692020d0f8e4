"""How deep any path leads through the product of postures: sets of triples, the right arm's postures as bits.

That there is no path at all can only be said when every triple was checked. Reaching needs no costs: a slice is one
bit for each triple, 64 at a time, and following edges is the union of neighbours' sets. In the open, where the sets
under many waists and left postures are equal, the same union is not made twice.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.exact.joint.bounds import Problem

Bits = NDArray[np.uint64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]

_WORD = 64
_START = plain(0)  # the first slice


class Reach(NamedTuple):
    """The deepest slice that can be reached, and the triples there that can."""

    depth: int  # -1 where not even the start is free
    triples: Bools  # (W, L, R)


@exact_kernel
def _packed(flags: Bools) -> Bits:
    """Rows of flags (N, R) as words (N, ceil(R / 64))."""
    out = np.empty((flags.shape[0], (flags.shape[1] + _WORD - 1) // _WORD), np.uint64)
    out[:] = 0
    for n in range(flags.shape[0]):
        for r in range(flags.shape[1]):
            if flags[n, r]:
                out[n, r // _WORD] |= np.uint64(1) << np.uint64(r % _WORD)
    return out


@exact_kernel
def _open(costs: Floats32) -> Bools:
    """Which costs (N, R) are finite."""
    out = np.empty(costs.shape, np.bool_)
    for n in range(costs.shape[0]):
        for r in range(costs.shape[1]):
            out[n, r] = np.isfinite(costs[n, r])
    return out


@exact_kernel
def _free(problem: Problem, depth: int) -> Bits:
    """The triples (W, L, words) that are free in a slice."""
    waist, left = problem.waist[depth], problem.left[depth]
    right, apart = _packed(_open(problem.right[depth])), _packed(problem.apart[depth])
    out = np.empty((left.shape[0], left.shape[1], right.shape[1]), np.uint64)
    out[:] = 0
    for w in range(left.shape[0]):
        if not np.isfinite(waist[w]):
            continue
        for n in range(left.shape[1]):
            if np.isfinite(left[w, n]):
                for i in range(right.shape[1]):
                    out[w, n, i] = right[w, i] & apart[n, i]
    return out


@inner_exact_kernel
def _intersect(known: Bits, free: Bits) -> bool:
    """Leave in `known` the triples that are free; whether there are any."""
    any_left = np.uint64(0)
    for w in range(known.shape[0]):
        for n in range(known.shape[1]):
            for i in range(known.shape[2]):
                known[w, n, i] &= free[w, n, i]
                any_left |= known[w, n, i]
    return bool(any_left != 0)


@helper
def _same(first: Bits, second: Bits) -> bool:
    """Whether two sets (words,) are equal."""
    differing = np.uint64(0)
    for i in range(first.shape[0]):
        differing |= first[i] ^ second[i]
    return bool(differing == 0)


@helper
def _along_right(known: Bits, edges: Bits) -> Bits:
    """Along the right arm's edges: of each set (W, L, words) the union of its members' neighbours, rows (R, words)."""
    out = np.empty(known.shape, np.uint64)
    last, union = np.empty(known.shape[2], np.uint64), np.empty(known.shape[2], np.uint64)
    last[:], union[:] = 0, 0
    for w in range(known.shape[0]):
        for n in range(known.shape[1]):
            here = known[w, n]
            if not _same(here, last):
                for i in range(union.shape[0]):
                    last[i], union[i] = here[i], 0
                for r in range(edges.shape[0]):
                    if here[r // _WORD] >> np.uint64(r % _WORD) & np.uint64(1):
                        for i in range(union.shape[0]):
                            union[i] |= edges[r, i]
            for i in range(union.shape[0]):
                out[w, n, i] = union[i]
    return out


@helper
def _along_others(known: Bits, waist_edges: Bools, left_edges: Bools) -> Bits:
    """Along the edges of left arm and waist: unions of sets (W, L, words)."""
    half, out = np.empty(known.shape, np.uint64), np.empty(known.shape, np.uint64)
    half[:], out[:] = 0, 0
    for n in range(known.shape[1]):
        for target in range(known.shape[1]):
            if left_edges[n, target]:
                for w in range(known.shape[0]):
                    for i in range(known.shape[2]):
                        half[w, target, i] |= known[w, n, i]
    for w in range(known.shape[0]):
        for target in range(known.shape[0]):
            if waist_edges[w, target]:
                for n in range(known.shape[1]):
                    for i in range(known.shape[2]):
                        out[target, n, i] |= half[w, n, i]
    return out


@inner_exact_kernel
def _unpacked(bits: Bits, size: int) -> Bools:
    """The words (W, L, words) as flags (W, L, R), R being `size`."""
    out = np.empty((bits.shape[0], bits.shape[1], size), np.bool_)
    for w in range(bits.shape[0]):
        for n in range(bits.shape[1]):
            for r in range(size):
                out[w, n, r] = bits[w, n, r // _WORD] >> np.uint64(r % _WORD) & np.uint64(1)
    return out


@inner_exact_kernel
def _after(problem: Problem, depth: int, known: Bits) -> Bits:
    """The triples of the next slice to which edges lead from `known`, free or not."""
    reached = _along_right(known, _packed(_open(problem.right_edges[depth])))
    return _along_others(reached, _open(problem.waist_edges[depth]), _open(problem.left_edges[depth]))


@exact_kernel
def next_triples(problem: Problem, depth: int, triples: Bools) -> Bools:
    """The triples (W, L, R) of the next slice to which edges lead from some of these, free or not."""
    waist, left, right = triples.shape
    bits = _packed(triples.reshape(waist * left, right)).reshape(waist, left, (right + _WORD - 1) // _WORD)
    return _unpacked(_after(problem, depth, bits), right)


@exact_kernel
def reach(problem: Problem) -> Reach:
    """The deepest slice to which a path leads, every triple of every slice checked."""
    size = problem.right.shape[2]
    depth, last = _START, problem.waist_edges.shape[0]
    known = _free(problem, depth)
    if not _intersect(known, known):
        return Reach(-1, _unpacked(known, size))
    while depth < last:
        after = _after(problem, depth, known)
        if not _intersect(after, _free(problem, depth + 1)):
            break
        depth, known = depth + 1, after
    return Reach(depth, _unpacked(known, size))
