"""Looks at a shown motion, close enough to tell where it runs into the avatar's own body: one entry for a plan.

A key interval has 72 moments. Of some of them it is known that nothing touches, without a look: between two looks every
part goes nearly straight, and how nearly is seen from the looks beside. Parts that a plane keeps apart at both looks
are apart between them by as much, less what both their ways bend. So most intervals are looked at six times only.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF
from elbowroom.body.root import ROOT_STATE
from elbowroom.body.whole_body import WholeBody, posed_body
from elbowroom.jit import exact_kernel, helper
from elbowroom.planning.model.axis_distances import clear_pairs
from elbowroom.planning.root.path import interpolate_root

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

# Between moments so many apart there is a look, and the room in metres that all of them have to leave: where there is
# less it is looked at more often. Between two looks dt apart a gap bends by less than a dt^2 / 8: at a = 340 m/s^2,
# what waist and arm may do to a hand, and turning, 26 mm, 3 mm and 0.2 mm.
MOMENTS = 72
STEPS = np.array([12, 4, 1])
ROOMS = np.array([0.04, 0.003, 0.0])
CLEAR = np.array([0.003, 4e-4])  # metres: what is surely left between two looks is not looked at more closely
_FAR = 0.06  # metres: what is as far at both of two looks does not come near between them
_BENT = 0.5  # of the second difference of three looks: a way between two of them bends by an eighth if it bends evenly


class OwnParts(NamedTuple):
    """A body and its pairs of parts that must not touch."""

    body: WholeBody
    first: Indices  # (P,) as in `SelfPairs`
    second: Indices
    kinds: Indices
    limits: Floats32


@helper
def least_gaps(
    parts: OwnParts, states: Floats, keys: Floats, rates: Floats, interval: float, chosen: Indices
) -> Floats32:
    """The least gaps (3, K) of left arm and body, right arm and body, and both arms, in chosen intervals (K,).

    Upper bodies lead through `keys` (n+1, 11) with `rates` (n+1, 11), roots through `states` (n+1, 7). A gap of less
    than 0.4 mm is the least of all moments; of more room it is the least that was seen.
    """
    own, count = parts, chosen.shape[0]
    least, at = np.empty((3, count), np.float32), np.empty((count, MOMENTS + 1), np.int64)
    samples = np.empty((at.size, 2), np.int64)
    segments = np.empty((at.size, own.body.joints.shape[0], 6), np.float32)
    gaps = np.empty((at.size, own.first.shape[0]), np.float32)
    near = np.empty(own.first.shape[0], np.bool_)
    least[:], at[:], near[:] = np.inf, -1, True
    known, made = 0, _first_looks(chosen, at, samples)
    for level in range(STEPS.shape[0]):
        postures, roots = _shown(states, keys, rates, interval, chosen, samples[known:made])
        capsules, _, _ = posed_body(own.body, postures, roots)
        _measure(
            capsules, own.first, own.second, own.limits, own.kinds, samples[known:made], near, segments[known:made],
            gaps[known:made], least,
        )  # fmt: skip
        if level == STEPS.shape[0] - 1:
            break
        known = made
        for i in range(count):
            low = min(least[0, i], least[1, i], least[2, i])
            if low >= 0.0 and low < ROOMS[level]:
                made = _closer_looks(own, segments, gaps, near, level, i, at, samples, made)
        if made == known:
            break
    return least


@exact_kernel
def _first_looks(chosen: Indices, at: Indices, samples: Indices) -> int:
    """Write down the looks (M, 2), an interval's place among the chosen and a moment, that come first; their number."""
    made = 0
    for i in range(chosen.shape[0]):
        if i > 0 and chosen[i] == chosen[i - 1] + 1:
            at[i, 0] = at[i - 1, MOMENTS]
        for moment in range(0 if at[i, 0] < 0 else STEPS[0], MOMENTS + 1, STEPS[0]):
            at[i, moment], samples[made, 0], samples[made, 1] = made, i, moment
            made += 1
    return made


@exact_kernel
def _closer_looks(
    own: OwnParts,
    segments: Floats32,
    gaps: Floats32,
    near: Bools,
    level: int,
    i: int,
    at: Indices,
    samples: Indices,
    made: int,
) -> int:
    """Write down the looks that an interval needs after those of a level; the number of all."""
    step, finer = STEPS[level], STEPS[level + 1]
    for moment in range(0, MOMENTS, step):
        a, b = at[i, moment], at[i, moment + step]
        if a < 0 or b < 0:
            continue
        before = at[i, moment - step] if moment > 0 else -1
        after = at[i, moment + 2 * step] if moment + step < MOMENTS else -1
        if not _clear_between(
            own.first, own.second, own.limits, segments, gaps, near, before, a, b, after, CLEAR[level]
        ):
            for between in range(moment + finer, moment + step, finer):
                at[i, between], samples[made, 0], samples[made, 1] = made, i, between
                made += 1
    return made


@exact_kernel
def _shown(
    states: Floats, keys: Floats, rates: Floats, interval: float, chosen: Indices, samples: Indices
) -> tuple[Floats, Floats]:
    """Postures (N, 14) at the origin and root states (N, 7) there, for `looks` (N, 2) into chosen intervals."""
    count, first = samples.shape[0], DOF - keys.shape[1]
    postures, roots = np.zeros((count, DOF)), np.empty((count, ROOT_STATE))
    for n in range(count):
        k, u = chosen[samples[n, 0]], samples[n, 1] / MOMENTS
        for j in range(keys.shape[1]):
            a, b, m, e = keys[k, j], keys[k + 1, j], interval * rates[k, j], interval * rates[k + 1, j]
            postures[n, first + j] = a + u * (m + u * (3.0 * (b - a) - 2.0 * m - e + u * (2.0 * (a - b) + m + e)))
        root = interpolate_root(states[k], states[k + 1], u, interval)
        for j in range(ROOT_STATE):
            roots[n, j] = 0.0 if j < 3 else root[j]
    return postures, roots


@helper
def _measure(
    capsules: Floats32,
    first: Indices,
    second: Indices,
    limits: Floats32,
    kinds: Indices,
    samples: Indices,
    near: Bools,
    segments: Floats32,
    gaps: Floats32,
    least: Floats32,
) -> None:
    """Put capsules (C, 6, N) into `segments` (N, C, 6), and the gaps of pairs that are `near` (P,) into `gaps` (N, P).

    The `least` (3, K) of each kind are lowered to them, but for looks (N, 2) at the start of an interval. Pairs that
    are far at all looks are near no more; their gaps are infinite from then on.
    """
    for c in range(capsules.shape[0]):
        for j in range(6):
            for n in range(capsules.shape[2]):
                segments[n, c, j] = capsules[c, j, n]
    for p in range(near.shape[0]):
        if not near[p]:
            for n in range(gaps.shape[0]):
                gaps[n, p] = np.inf
            continue
        found, kind, nearest = clear_pairs(capsules[first[p]], capsules[second[p]]), kinds[p], np.inf
        for n in range(gaps.shape[0]):
            gap = found[n] - limits[p]
            gaps[n, p], nearest = gap, min(nearest, gap)
            if samples[n, 1] > 0:
                least[kind, samples[n, 0]] = min(least[kind, samples[n, 0]], gap)
        near[p] = nearest < _FAR


@helper
def _clear_between(
    first: Indices,
    second: Indices,
    limits: Floats32,
    segments: Floats32,
    gaps: Floats32,
    near: Bools,
    before: int,
    a: int,
    b: int,
    after: int,
    scratch: float,
) -> bool:
    """Whether pairs that are `near` (P,) surely keep `room` between looks `a` and `b`; -1: none `before` or `after`."""
    for p in range(near.shape[0]):
        if not near[p] or min(gaps[a, p], gaps[b, p]) >= _FAR:
            continue
        one, other, bent = first[p], second[p], 0.0
        if before >= 0:
            bent = _second_difference(segments, one, before, a, b) + _second_difference(segments, other, before, a, b)
        if after >= 0:
            here = _second_difference(segments, one, a, b, after) + _second_difference(segments, other, a, b, after)
            bent = max(bent, here)
        least = scratch + limits[p] + _BENT * bent
        if _kept_apart(segments, one, other, a, b) < least and _kept_apart(segments, one, other, b, a) < least:
            return False
    return True


@helper
def _second_difference(segments: Floats32, c: int, before: int, at: int, after: int) -> float:
    """How far the ends of capsule `c` at a look are from halfway between two others, twice that, metres."""
    most = 0.0
    for end in range(0, 6, 3):
        x = segments[before, c, end] - 2.0 * segments[at, c, end] + segments[after, c, end]
        y = segments[before, c, end + 1] - 2.0 * segments[at, c, end + 1] + segments[after, c, end + 1]
        z = segments[before, c, end + 2] - 2.0 * segments[at, c, end + 2] + segments[after, c, end + 2]
        most = max(most, x * x + y * y + z * z)
    return float(np.sqrt(most))


@helper
def _kept_apart(segments: Floats32, one: int, other: int, at: int, then: int) -> float:
    """How wide a gap (metres) planes keep open between the axes of two capsules at both of two looks.

    The planes are perpendicular to the shortest way between the two at the first.
    """
    uu, uv, vv, uw, vw = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        u = segments[at, one, 3 + i] - segments[at, one, i]
        v = segments[at, other, 3 + i] - segments[at, other, i]
        w = segments[at, one, i] - segments[at, other, i]
        uu, uv, vv, uw, vw = uu + u * u, uv + u * v, vv + v * v, uw + u * w, vw + v * w
    s = min(max((uv * vw - vv * uw) / max(uu * vv - uv * uv, 1e-12), 0.0), 1.0)
    t = min(max((uv * s + vw) / max(vv, 1e-12), 0.0), 1.0)
    s = min(max((uv * t - uw) / max(uu, 1e-12), 0.0), 1.0)
    x = _on_axis(segments, at, one, s, 0) - _on_axis(segments, at, other, t, 0)
    y = _on_axis(segments, at, one, s, 1) - _on_axis(segments, at, other, t, 1)
    z = _on_axis(segments, at, one, s, 2) - _on_axis(segments, at, other, t, 2)
    here = _least_along(segments, at, one, x, y, z) + _least_along(segments, at, other, -x, -y, -z)
    there = _least_along(segments, then, one, x, y, z) + _least_along(segments, then, other, -x, -y, -z)
    return float(min(here, there) / np.sqrt(max(x * x + y * y + z * z, 1e-18)))


@helper
def _on_axis(segments: Floats32, sample: int, c: int, share: float, i: int) -> float:
    """A coordinate of the point at a share of a capsule's axis."""
    return float(segments[sample, c, i] + share * (segments[sample, c, 3 + i] - segments[sample, c, i]))


@helper
def _least_along(segments: Floats32, sample: int, c: int, x: float, y: float, z: float) -> float:
    """The least of a capsule's axis along a direction."""
    start = segments[sample, c, 0] * x + segments[sample, c, 1] * y + segments[sample, c, 2] * z
    end = segments[sample, c, 3] * x + segments[sample, c, 4] * y + segments[sample, c, 5] * z
    return float(min(start, end))
