"""Whether a shown motion keeps clear of the avatar's own body, at every moment: proven by `halving`.

A pair is two capsules, seen from the pelvis or from the chest. How far they can move against each other is what each
component of the body moves in a part of a key interval, times the pair's levers. An interval that was looked at for an
earlier plan is known by its content. It is one compiled call.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL, LOCAL_GROUPS, SEARCH_ORDER, DofGroup, columns_of
from elbowroom.body.kinematics import BodyModel
from elbowroom.body.root import ROOT_STATE
from elbowroom.body.whole_body import WholeBody, posed_body, whole_body
from elbowroom.jit import exact_kernel, helper, plain
from elbowroom.planning.exact.memory.row_contents import CONTENT, is_natural, set_bits, set_contents
from elbowroom.planning.exact.memory.row_index import RowIndex, admit, forget, new_row_index, place_of
from elbowroom.planning.exact.sweep.motion_bounds import moves_between, stride_moves
from elbowroom.planning.halving import ENOUGH, begun, due, settle
from elbowroom.planning.model.axis_distances import clear_pairs
from elbowroom.planning.model.levers import MOVES, BodyLevers
from elbowroom.planning.model.self_pairs import SelfPairs
from elbowroom.planning.root.path import RootPath, interpolate_root

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_ROOM = 512
_PARTS = plain(6)  # of a key interval, between first looks
_HALVINGS = plain(7)  # of these
_LOOKS = 32  # at once
_AFAR = 1e-3  # metres: proven far ahead; what was free from afar stays free when it is near
_SOON = 4  # key intervals ahead until which a motion is near
_COLUMNS = np.array([(columns_of(group).start, columns_of(group).stop) for group in LOCAL_GROUPS])


class OwnParts(NamedTuple):
    """A body and its pairs of parts that must not touch."""

    body: WholeBody
    first: Indices  # (P,) as in `SelfPairs`
    second: Indices
    kinds: Indices
    limits: Floats32
    levers: Floats  # (P, M) as `BodyLevers.between` has them


class Seen(NamedTuple):
    """Key intervals that were looked at, by the content of both their ends."""

    known: RowIndex
    gaps: Floats  # (S,) metres proven of all pairs, and
    groups: Indices  # (S,) the number in `SEARCH_ORDER` of the group of the pair that is nearest by what is proven


def own_parts(model: BodyModel, pairs: SelfPairs, levers_of_body: BodyLevers) -> OwnParts:
    """The parts of a body that must not run into each other."""
    levers = levers_of_body.between(pairs.first, pairs.second, model.roots.indices)
    return OwnParts(whole_body(model), pairs.first, pairs.second, pairs.kinds, pairs.limits, levers)


def parts_of(parts: OwnParts, group: DofGroup) -> OwnParts:
    """Only the pairs of one group and what it must keep clear of."""
    at = np.flatnonzero(parts.kinds == SEARCH_ORDER.index(group))
    return OwnParts(parts.body, parts.first[at], parts.second[at], parts.kinds[at], parts.limits[at], parts.levers[at])


class OwnMotion:
    """One avatar's motion among its own parts, and the key intervals of it that were looked at."""

    def __init__(self, parts: OwnParts, room: int = _ROOM) -> None:
        """So many intervals can be remembered; when half of them are, all are forgotten before the next plan."""
        self._parts = parts
        known = new_row_index(room, 2 * (CONTENT + 2 * LOCAL))
        self._seen = Seen(known, np.empty(room), np.empty(room, np.int64))

    def contacts(self, path: RootPath, keys: Floats, rates: Floats, goals: Floats, ahead: int) -> Indices:
        """The group, by its number in `SEARCH_ORDER`, that is not clear of the body in each interval (n,), or -1.

        `keys` (n+1, LOCAL) and `rates` (n+1, LOCAL) are the upper body and its velocity at the key times, the first of
        which is `ahead` key intervals from now. Where both ends of an interval are as the `goals` (n+1, LOCAL) have
        them, it does not touch. Farther ahead more is asked for.
        """
        gaps, groups = self.proven(path, keys, rates, goals)
        wanted = np.where(ahead + np.arange(len(gaps)) < _SOON, ENOUGH, _AFAR)
        found: Indices = np.where(gaps < wanted, groups, -1)
        return found

    def proven(self, path: RootPath, keys: Floats, rates: Floats, goals: Floats) -> tuple[Floats, Indices]:
        """The proven gaps (n,), metres, and whose (n,) they are: infinite and -1 where it is as the goals have it."""
        gaps, groups = _proven(self._parts, self._seen, path.states, keys, rates, goals, path.interval)
        return gaps, groups


@exact_kernel
def _proven(
    parts: OwnParts, seen: Seen, states: Floats, keys: Floats, rates: Floats, goals: Floats, interval: float
) -> tuple[Floats, Indices]:
    """See `OwnMotion.proven`."""
    gaps, groups = np.full(keys.shape[0] - 1, np.inf), np.full(keys.shape[0] - 1, -1)
    chosen = _beside(keys, goals, states)
    if not chosen.shape[0]:
        return gaps, groups
    width = CONTENT + 2 * LOCAL
    names = np.empty(keys.shape[0] * width, np.int64)
    contents = names.reshape(keys.shape[0], width)
    set_contents(states, keys, contents)
    for t in range(keys.shape[0]):
        set_bits(rates[t], contents[t, CONTENT + LOCAL :])
    if 2 * seen.known.taken[0] > seen.gaps.shape[0]:
        forget(seen.known)
    missing, count = np.empty(chosen.shape[0], np.int64), 0
    for k in chosen:
        place = place_of(seen.known, names[k * width : (k + 2) * width])
        if place < 0:
            missing[count] = k
            count += 1
        else:
            gaps[k], groups[k] = seen.gaps[place], seen.groups[place]
    if count:
        _prove(parts, states, keys, rates, interval, missing[:count], gaps, groups)
        for k in missing[:count]:
            place = admit(seen.known, names[k * width : (k + 2) * width])
            seen.gaps[place], seen.groups[place] = gaps[k], groups[k]
    return gaps, groups


@exact_kernel
def _beside(keys: Floats, goals: Floats, states: Floats) -> Indices:
    """The intervals (K,) at whose ends the upper body (n+1, LOCAL) is not as the goals (n+1, LOCAL) have it.

    Or where a foot of root states (n+1, 7 or more) is not on level ground.
    """
    chosen, count, natural = np.empty(keys.shape[0] - 1, np.int64), 0, is_natural(keys[0], goals[0], states[0])
    for k in range(chosen.shape[0]):
        before, natural = natural, is_natural(keys[k + 1], goals[k + 1], states[k + 1])
        if not (before and natural):
            chosen[count] = k
            count += 1
    return chosen[:count]


@exact_kernel
def _prove(
    parts: OwnParts,
    states: Floats,
    keys: Floats,
    rates: Floats,
    interval: float,
    chosen: Indices,
    least: Floats,
    groups: Indices,
) -> None:
    """Set the proven gaps `least` (n,) in chosen intervals (K,), and whose they are.

    Upper bodies lead through `keys` (n+1, LOCAL) with `rates` (n+1, LOCAL), roots through `states` (n+1, 7).
    """
    count, looks = chosen.shape[0], _PARTS + 1
    intervals, moments = np.empty(count * looks, np.int64), np.empty(count * looks)
    moves = np.empty((count * _PARTS, parts.levers.shape[1]))
    for i in range(count):
        for n in range(looks):
            intervals[i * looks + n], moments[i * looks + n] = chosen[i], n / _PARTS
        _set_moves(states, keys, rates, interval, chosen[i], moves[i * _PARTS : (i + 1) * _PARTS])
    gaps = _gaps(parts, states, keys, rates, interval, intervals, moments)
    proof = begun(gaps, _lengths(parts.levers, moves), _PARTS, _AFAR, _HALVINGS)
    wanted, shares = np.empty(_LOOKS, np.int64), np.empty(_LOOKS)
    more = due(proof, wanted, shares)
    while more > 0:
        for n in range(more):
            shares[n] = (wanted[n] % _PARTS + shares[n]) / _PARTS
            wanted[n] = chosen[wanted[n] // _PARTS]
        settle(proof, _gaps(parts, states, keys, rates, interval, wanted[:more], shares[:more]), more)
        more = due(proof, wanted, shares)
    for b in range(proof.least.shape[0]):
        k = chosen[b // _PARTS]
        for p in range(parts.kinds.shape[0]):
            if proof.least[b, p] < least[k]:
                least[k], groups[k] = proof.least[b, p], parts.kinds[p]


@helper
def _set_moves(states: Floats, keys: Floats, rates: Floats, interval: float, k: int, out: Floats) -> None:
    """What every component of the body moves at most in the parts of an interval: `out` (_PARTS, M)."""
    for g in range(_COLUMNS.shape[0]):
        low, high = _COLUMNS[g, 0], _COLUMNS[g, 1]
        ends = keys[k, low:high], rates[k, low:high], keys[k + 1, low:high], rates[k + 1, low:high]
        out[:, g * MOVES : (g + 1) * MOVES] = moves_between(ends, interval, _PARTS)
    out[:, _COLUMNS.shape[0] * MOVES :] = stride_moves(states[k], states[k + 1], interval, _PARTS)


@exact_kernel
def _lengths(levers: Floats, moves: Floats) -> Floats:
    """How far pairs with levers (P, M) can move against each other in parts with moves (B, M): shape (B, P)."""
    out = np.zeros((moves.shape[0], levers.shape[0]))
    for b in range(out.shape[0]):
        for p in range(out.shape[1]):
            for m in range(moves.shape[1]):
                out[b, p] += levers[p, m] * moves[b, m]
    return out


@exact_kernel
def _gaps(
    parts: OwnParts, states: Floats, keys: Floats, rates: Floats, interval: float, intervals: Indices, shares: Floats
) -> Floats32:
    """The gaps (N, P) of the pairs at shares (N,) of `intervals` (N,), metres beyond what they may come near."""
    count, first = shares.shape[0], DOF - keys.shape[1]
    postures, roots = np.zeros((count, DOF)), np.zeros((count, ROOT_STATE))
    for n in range(count):
        k, u = intervals[n], shares[n]
        for j in range(keys.shape[1]):
            a, b, m, e = keys[k, j], keys[k + 1, j], interval * rates[k, j], interval * rates[k + 1, j]
            postures[n, first + j] = a + u * (m + u * (3.0 * (b - a) - 2.0 * m - e + u * (2.0 * (a - b) + m + e)))
        shown = interpolate_root(states[k], states[k + 1], u, interval)
        for j in range(3, shown.shape[0]):
            roots[n, j] = shown[j]
    capsules, _, _ = posed_body(parts.body, postures, roots)
    gaps = np.empty((count, parts.first.shape[0]), np.float32)
    for p in range(parts.first.shape[0]):
        found = clear_pairs(capsules[parts.first[p]], capsules[parts.second[p]])
        for n in range(count):
            gaps[n, p] = found[n] - parts.limits[p]
    return gaps
