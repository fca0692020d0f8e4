"""How deep any way leads through the product of postures: sets of triples, the right arm's postures as bits.

That there is no way at all can only be said when every triple was looked at. Reaching needs no costs: a slice is one
bit for each triple, 64 at a time, and a step is the union of neighbours' sets. In the open, where the sets under many
waists and left postures are equal, the same union is not made twice.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.joint_bounds import Problem

Bits = NDArray[np.uint64]
Bools = NDArray[np.bool_]

_WORD = 64


class Reach(NamedTuple):
    """The deepest slice that can be reached, and the triples there that can."""

    depth: int  # -1 where not even the start is free
    triples: Bools  # (W, L, R)


@exact_kernel
def _packed(flags: Bools) -> Bits:
    """Rows of flags (N, R) as words (N, ceil(R / 64))."""
    out = np.zeros((flags.shape[0], (flags.shape[1] + _WORD - 1) // _WORD), np.uint64)
    for n in range(flags.shape[0]):
        for r in range(flags.shape[1]):
            if flags[n, r]:
                out[n, r // _WORD] |= np.uint64(1) << np.uint64(r % _WORD)
    return out


@exact_kernel
def _free(problem: Problem, depth: int) -> Bits:
    """The triples (W, L, words) that are free in a slice."""
    waist, left = np.isfinite(problem.waist[depth]), np.isfinite(problem.left[depth])
    right, apart = _packed(np.isfinite(problem.right[depth])), _packed(problem.apart[depth])
    out = np.zeros((left.shape[0], left.shape[1], right.shape[1]), np.uint64)
    for w in range(left.shape[0]):
        if not waist[w]:
            continue
        for n in range(left.shape[1]):
            if left[w, n]:
                out[w, n] = right[w] & apart[n]
    return out


@exact_kernel
def _same(first: Bits, second: Bits) -> bool:
    differing = np.uint64(0)
    for i in range(first.shape[0]):
        differing |= first[i] ^ second[i]
    return bool(differing == 0)


@exact_kernel
def _stepped(known: Bits, steps: Bits) -> Bits:
    """The right arm's step: of each set (W, L, words) the union of its members' neighbours, rows `steps` (R, words)."""
    out = np.zeros_like(known)
    last, union = np.zeros(known.shape[2], np.uint64), np.zeros(known.shape[2], np.uint64)
    for w in range(known.shape[0]):
        for n in range(known.shape[1]):
            here = known[w, n]
            if not _same(here, last):
                last[:], union[:] = here, 0
                for r in range(steps.shape[0]):
                    if here[r // _WORD] >> np.uint64(r % _WORD) & np.uint64(1):
                        for i in range(union.shape[0]):
                            union[i] |= steps[r, i]
            out[w, n] = union
    return out


@exact_kernel
def _merged(known: Bits, waist_steps: Bools, left_steps: Bools) -> Bits:
    """The steps of left arm and waist: unions of sets (W, L, words)."""
    half, out = np.zeros_like(known), np.zeros_like(known)
    for n in range(known.shape[1]):
        for target in range(known.shape[1]):
            if left_steps[n, target]:
                for w in range(known.shape[0]):
                    for i in range(known.shape[2]):
                        half[w, target, i] |= known[w, n, i]
    for w in range(known.shape[0]):
        for target in range(known.shape[0]):
            if waist_steps[w, target]:
                for n in range(known.shape[1]):
                    for i in range(known.shape[2]):
                        out[target, n, i] |= half[w, n, i]
    return out


@exact_kernel
def _unpacked(bits: Bits, size: int) -> Bools:
    out = np.zeros((bits.shape[0], bits.shape[1], size), np.bool_)
    for w in range(bits.shape[0]):
        for n in range(bits.shape[1]):
            for r in range(size):
                out[w, n, r] = bits[w, n, r // _WORD] >> np.uint64(r % _WORD) & np.uint64(1)
    return out


@exact_kernel
def stepped_triples(problem: Problem, depth: int, triples: Bools) -> Bools:
    """The triples (W, L, R) of the next slice to which a step leads from some of these, free or not."""
    waist, left, right = triples.shape
    bits = _packed(triples.reshape(waist * left, right)).reshape(waist, left, (right + _WORD - 1) // _WORD)
    stepped = _stepped(bits, _packed(np.isfinite(problem.right_steps[depth])))
    return _unpacked(
        _merged(stepped, np.isfinite(problem.waist_steps[depth]), np.isfinite(problem.left_steps[depth])), right
    )


@exact_kernel
def reach(problem: Problem) -> Reach:
    """The deepest slice to which a way leads, every triple of every slice looked at."""
    size = problem.right.shape[2]
    known = _free(problem, 0)
    if not known.any():
        return Reach(-1, _unpacked(known, size))
    for t in range(problem.waist_steps.shape[0]):
        stepped = _stepped(known, _packed(np.isfinite(problem.right_steps[t])))
        after = _merged(stepped, np.isfinite(problem.waist_steps[t]), np.isfinite(problem.left_steps[t]))
        after &= _free(problem, t + 1)
        if not after.any():
            return Reach(t, _unpacked(known, size))
        known = after
    return Reach(problem.waist_steps.shape[0], _unpacked(known, size))
