"""The one proof that two things keep apart at every moment of a time, and not only where they were looked at.

Let g and g' be the gaps of two things at two looks, and L a length such that no point of the one moves farther against
the other between them, seen from any one frame: what both move there added up. When s of L is done, L - s is left, and
a gap changes by no more than is moved; so it is at least g - s and at least g' - (L - s), and never less than

    (g + g' - L) / 2.

Where that is not enough the time between the looks is halved, up to a number of times. What a pair is does not matter:
a part of a body and what stands about it, two parts of one body, the body and another avatar. Whoever asks says how
far pairs can move (L), and looks where it is told to:

    proof = begun(gaps, lengths, each, enough, depth)
    while (count := due(proof, parts, shares)) > 0:
        ...  # gaps found (count, R) at the shares of these parts
        settle(proof, found, count)
    proof.least  # bounds on the gaps
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import brief_exact_kernel, inner_exact_kernel, plain

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

ENOUGH = 4e-4  # metres: a proven gap that counts as free; more than rounding, and than the bob's bend between looks
_WHOLE = plain(0)  # how often a part is halved at first
_TAKEN, _ENTERED, _LOOKS = 0, 1, 2  # places in the counts


class Proof(NamedTuple):
    """R pairs in B parts of a time: what is proven of them, and the pieces of these parts that have to be halved."""

    lengths: Floats  # (B, R) metres: how far the two of a pair can move against each other in a part
    each: int  # parts of a row: where a pair touches in one of them, the others are not looked into any more
    enough: float  # metres
    depth: int  # how often a part may be halved
    least: Floats  # (B, R) metres: no gap is less; in rows that are lost one of them is too little, the others unknown
    gaps: Floats32  # (N, R) metres, at all looks
    part: Longs  # (M,) of each piece, and
    begin: Floats  # (M,) where in it the piece begins,
    level: Longs  # (M,) how often it was halved,
    looks: Longs  # (M, 2) the looks before and after it
    asked: Longs  # (M,) the pieces in which looks are wanted now
    counts: Longs  # (3,) pieces that are done with, pieces, looks
    lost: Bools  # (B / each,) rows in which a pair touches, or nearly


@brief_exact_kernel
def begun(gaps: Floats32, lengths: Floats, each: int, enough: float, depth: int) -> Proof:
    """The proof as far as first looks have it.

    They found `gaps` (K, R): one before the first of each row of `each` parts, and one after each part. Pieces are
    halved until `enough` is proven; not for a pair that has not even `ENOUGH` at one of its ends.
    """
    parts, pairs, halved = lengths.shape[0], lengths.shape[1], 0
    for b in range(parts):
        before = b + b // each
        for r in range(pairs):
            if 0.5 * (gaps[before, r] + gaps[before + 1, r] - lengths[b, r]) < enough:
                halved += 1
                break
    room = halved * ((1 << depth) - 1)
    proof = Proof(
        lengths, each, enough, depth, np.empty(lengths.shape), np.empty((gaps.shape[0] + room, pairs), np.float32),
        np.empty(room, np.int64), np.empty(room), np.empty(room, np.int64), np.empty((room, 2), np.int64),
        np.empty(room, np.int64), np.zeros(3, np.int64), np.zeros(parts // each, np.bool_),
    )  # fmt: skip
    proof.least[:] = np.inf
    proof.gaps[: gaps.shape[0]] = gaps
    proof.counts[_LOOKS] = gaps.shape[0]
    for b in range(parts):
        before = b + b // each
        _weigh(proof, b, 0.0, _WHOLE, before, before + 1)
    return proof


@inner_exact_kernel
def _weigh(proof: Proof, part: int, begin: float, level: int, before: int, after: int) -> None:
    """Settle a piece, between two looks, or note it to be halved."""
    one, other, least, lengths = proof.gaps[before], proof.gaps[after], proof.least[part], proof.lengths[part]
    share, hopeless, open_pairs, lost = 0.5**level, min(proof.enough, ENOUGH), 0, 0
    enough = proof.enough if level < proof.depth else -np.inf
    for r in range(np.uint64(one.shape[0])):
        low = 0.5 * (one[r] + other[r] - share * lengths[r])
        touches = min(one[r], other[r]) < hopeless
        settled = (low >= enough) | touches
        lost += touches | (settled & (low < hopeless))
        open_pairs += not settled
        least[r] = min(least[r], low if settled else np.inf)
    proof.lost[part // proof.each] |= lost > 0
    if open_pairs > 0:
        n = proof.counts[_ENTERED]
        proof.part[n], proof.begin[n], proof.level[n] = part, begin, level
        proof.looks[n, 0], proof.looks[n, 1] = before, after
        proof.counts[_ENTERED] = n + 1


@brief_exact_kernel
def due(proof: Proof, parts: Longs, shares: Floats) -> int:
    """The number of looks that are wanted next, as many as there is room for: in which `parts`, and where in them."""
    count, at = 0, proof.counts[_TAKEN]
    while at < proof.counts[_ENTERED] and count < parts.shape[0]:
        if not proof.lost[proof.part[at] // proof.each]:
            parts[count], shares[count] = proof.part[at], proof.begin[at] + 0.5 ** (proof.level[at] + 1)
            proof.asked[count] = at
            count += 1
        at += 1
    proof.counts[_TAKEN] = at
    return count


@brief_exact_kernel
def settle(proof: Proof, found: Floats32, count: int) -> None:
    """Take in the gaps `found` (N, R) at the first `count` looks that were wanted: their pieces are halved there."""
    for n in range(count):
        at, look = proof.asked[n], proof.counts[_LOOKS]
        for r in range(found.shape[1]):
            proof.gaps[look, r] = found[n, r]
        proof.counts[_LOOKS] = look + 1
        part, begin, level = proof.part[at], proof.begin[at], proof.level[at] + 1
        _weigh(proof, part, begin, level, proof.looks[at, 0], look)
        _weigh(proof, part, begin + 0.5**level, level, look, proof.looks[at, 1])
