"""Samples of a shown motion, close enough to tell where it runs into the avatar's own body: one entry for a plan.

A key interval has 72 moments. Of some of them it is known that nothing touches, without a sample: between two samples
every part goes nearly straight, and how nearly is seen from the samples beside. Parts that a plane keeps apart at both
samples are apart between them by as much, less what both their paths bend. So most intervals are sampled six times.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import CHILDREN, DOF
from elbowroom.body.root import ROOT_STATE
from elbowroom.body.whole_body import WholeBody, posed_body
from elbowroom.jit import exact_kernel, helper
from elbowroom.planning.model.axis_distances import clear_pairs
from elbowroom.planning.root.path import interpolate_root

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

# Moments so many apart are sampled, and where any of them leaves less than so many metres more are. Between two samples
# dt apart a gap bends by less than a dt^2 / 8: at a = 340 m/s^2, what waist and arm may do to a hand, and turning,
# 26 mm, 3 mm and 0.2 mm.
MOMENTS = 72
STEPS = np.array([12, 4, 1])
NEAR = np.array([0.04, 0.003, 0.0])
CLEAR = np.array([0.003, 4e-4])  # metres: what is surely left between two samples is not sampled more closely
_GROUPS = len(CHILDREN)
_FAR = 0.06  # metres: what is as far at both of two samples does not come near between them
_BENT = (
    0.5  # of the second difference of three samples: a path between two of them bends by an eighth if it bends evenly
)


class OwnParts(NamedTuple):
    """A body and its pairs of parts that must not touch."""

    body: WholeBody
    first: Indices  # (P,) as in `SelfPairs`
    second: Indices
    kinds: Indices
    limits: Floats32


class _Samples(NamedTuple):
    """The samples of K chosen intervals, as far as they are made, M at most."""

    at: Indices  # (K, MOMENTS+1) the sample of each moment, -1 for none
    moments: Indices  # (M, 2) the interval's place among the chosen, and the moment
    segments: Floats32  # (M, C, 6) capsules, metres
    gaps: Floats32  # (M, P) of the pairs, metres; infinite where a pair is far at all samples before
    near: Bools  # (P,) pairs that are not far at all samples


@helper
def least_gaps(
    parts: OwnParts, states: Floats, keys: Floats, rates: Floats, interval: float, chosen: Indices
) -> Floats32:
    """The least gaps (len(CHILDREN), K) of each group and what it must keep clear of, in chosen intervals (K,).

    Upper bodies lead through `keys` (n+1, 11) with `rates` (n+1, 11), roots through `states` (n+1, 7). A gap of less
    than 0.4 mm is the least of all moments; a wider one is the least that was sampled.
    """
    count, pairs = chosen.shape[0], parts.first.shape[0]
    most = count * (MOMENTS + 1)
    it = _Samples(
        np.empty((count, MOMENTS + 1), np.int64),
        np.empty((most, 2), np.int64),
        np.empty((most, parts.body.capsules.joints.shape[0], 6), np.float32),
        np.empty((most, pairs), np.float32),
        np.empty(pairs, np.bool_),
    )
    least = np.empty((_GROUPS, count), np.float32)
    least[:], it.at[:], it.near[:] = np.inf, -1, True
    known, made = 0, _first_samples(it, chosen)
    for level in range(STEPS.shape[0]):
        postures, roots = _shown(states, keys, rates, interval, chosen, it.moments[known:made])
        capsules, _, _ = posed_body(parts.body, postures, roots)
        _measure(parts, capsules, it, known, least)
        if level == STEPS.shape[0] - 1:
            break
        known = made
        for i in range(count):
            low = least[0, i]
            for g in range(1, _GROUPS):
                low = min(low, least[g, i])
            if low >= 0.0 and low < NEAR[level]:
                made = _closer_samples(parts, it, level, i, made)
        if made == known:
            break
    return least


@exact_kernel
def _first_samples(it: _Samples, chosen: Indices) -> int:
    """Write down the samples that come first; their number."""
    made = 0
    for i in range(chosen.shape[0]):
        if i > 0 and chosen[i] == chosen[i - 1] + 1:
            it.at[i, 0] = it.at[i - 1, MOMENTS]
        for moment in range(0 if it.at[i, 0] < 0 else STEPS[0], MOMENTS + 1, STEPS[0]):
            it.at[i, moment], it.moments[made, 0], it.moments[made, 1] = made, i, moment
            made += 1
    return made


@exact_kernel
def _closer_samples(parts: OwnParts, it: _Samples, level: int, i: int, made: int) -> int:
    """Write down the samples that interval `i` needs after those of a level; the number of all."""
    step, finer = STEPS[level], STEPS[level + 1]
    for moment in range(0, MOMENTS, step):
        a, b = it.at[i, moment], it.at[i, moment + step]
        if a < 0 or b < 0:
            continue
        before = it.at[i, moment - step] if moment > 0 else -1
        after = it.at[i, moment + 2 * step] if moment + step < MOMENTS else -1
        if not _clear_between(parts, it, before, a, b, after, CLEAR[level]):
            for between in range(moment + finer, moment + step, finer):
                it.at[i, between], it.moments[made, 0], it.moments[made, 1] = made, i, between
                made += 1
    return made


@exact_kernel
def _shown(
    states: Floats, keys: Floats, rates: Floats, interval: float, chosen: Indices, samples: Indices
) -> tuple[Floats, Floats]:
    """Postures (N, DOF) at the origin and root states (N, 7) there, for `samples` (N, 2) of chosen intervals."""
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
def _measure(parts: OwnParts, capsules: Floats32, it: _Samples, known: int, least: Floats32) -> None:
    """Enter the capsules (C, 6, N) of the samples from `known` on, and the gaps of pairs that are near.

    The `least` (len(CHILDREN), K) of each kind are lowered to them, but for samples at the start of an interval. Pairs
    that are far at all of these samples are near no more; their gaps are infinite from then on.
    """
    count = capsules.shape[2]
    for c in range(capsules.shape[0]):
        for j in range(6):
            for n in range(count):
                it.segments[known + n, c, j] = capsules[c, j, n]
    for p in range(it.near.shape[0]):
        if not it.near[p]:
            for n in range(count):
                it.gaps[known + n, p] = np.inf
            continue
        found, kind, nearest = clear_pairs(capsules[parts.first[p]], capsules[parts.second[p]]), parts.kinds[p], np.inf
        for n in range(count):
            gap, i = found[n] - parts.limits[p], it.moments[known + n, 0]
            it.gaps[known + n, p], nearest = gap, min(nearest, gap)
            if it.moments[known + n, 1] > 0:
                least[kind, i] = min(least[kind, i], gap)
        it.near[p] = nearest < _FAR


@helper
def _clear_between(parts: OwnParts, it: _Samples, before: int, a: int, b: int, after: int, margin: float) -> bool:
    """Whether the near pairs surely keep a `margin` (metres) between samples a and b; -1: none `before` or `after`."""
    for p in range(it.near.shape[0]):
        if not it.near[p] or min(it.gaps[a, p], it.gaps[b, p]) >= _FAR:
            continue
        one, other, bent = parts.first[p], parts.second[p], 0.0
        if before >= 0:
            bent = _bend_of_both(it.segments, one, other, before, a, b)
        if after >= 0:
            bent = max(bent, _bend_of_both(it.segments, one, other, a, b, after))
        least = margin + parts.limits[p] + _BENT * bent
        if _kept_apart(it.segments, one, other, a, b) < least and _kept_apart(it.segments, one, other, b, a) < least:
            return False
    return True


@helper
def _bend_of_both(segments: Floats32, one: int, other: int, before: int, at: int, after: int) -> float:
    """The second differences of two capsules added up, metres."""
    first = _second_difference(segments, one, before, at, after)
    return first + _second_difference(segments, other, before, at, after)


@helper
def _second_difference(segments: Floats32, c: int, before: int, at: int, after: int) -> float:
    """How far the ends of capsule `c` at a sample are from halfway between two others, twice that, metres."""
    most = 0.0
    for end in range(0, 6, 3):
        x = segments[before, c, end] - 2.0 * segments[at, c, end] + segments[after, c, end]
        y = segments[before, c, end + 1] - 2.0 * segments[at, c, end + 1] + segments[after, c, end + 1]
        z = segments[before, c, end + 2] - 2.0 * segments[at, c, end + 2] + segments[after, c, end + 2]
        most = max(most, x * x + y * y + z * z)
    return float(np.sqrt(most))


@helper
def _kept_apart(segments: Floats32, one: int, other: int, at: int, then: int) -> float:
    """How wide a gap (metres) planes keep open between the axes of two capsules at both of two samples.

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
