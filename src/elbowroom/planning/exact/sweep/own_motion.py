"""Whether a shown motion keeps clear of the avatar's own body, at every moment: proven by `halving`.

A pair is two capsules, seen from the pelvis or from the chest. How far they can move against each other is what each
component of the body moves in a part of a key interval, times the pair's levers. Feet are looked at on what they stand
on at that moment, and what that alone makes of the legs from look to look is measured and added. Where that raises a
thigh to an upright trunk, a bent one may come as near. An interval that was looked at for an earlier plan is known by
its content, on uneven ground by its place too. It is one compiled call.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL, LOCAL_GROUPS, SEARCH_ORDER, DofGroup, columns_of
from elbowroom.body.gait.stride import CLIMB
from elbowroom.body.pose.kinematics import BodyModel
from elbowroom.body.pose.whole_body import WholeBody, posed_body
from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE
from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.exact.memory.known_rises import KnownRises, new_known_rises, recall_rises
from elbowroom.planning.exact.memory.row_contents import CONTENT, is_natural, set_bits, set_contents
from elbowroom.planning.exact.memory.row_index import RowIndex, admit, forget, new_row_index, place_of
from elbowroom.planning.exact.sweep.motion_bounds import moves_between, stride_moves
from elbowroom.planning.halving import ENOUGH, begun, due, settle
from elbowroom.planning.model.axis_distances import clear_pairs
from elbowroom.planning.model.footing import ON_PLANE, Underfoot
from elbowroom.planning.model.levers import MOVES, SPARE, BodyLevers
from elbowroom.planning.model.self_pairs import OVERLAP, SelfPairs
from elbowroom.planning.root.path import RootPath, interpolate_root

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_ROOM = 192  # key intervals that are remembered: most of what is known again was looked at a few plans ago
_PARTS = plain(6)  # of a key interval, between first looks
_HALVINGS = plain(7)  # of these
_LOOKS = 32  # at once
_AFAR = 1e-3  # metres: proven far ahead; what was free from afar stays free when it is near
_SOON = 4  # key intervals ahead until which a motion is near
_CARRIED = plain(2)  # the first groups in `SEARCH_ORDER`, waist and head: only legs are in their way
_COLUMNS = np.array([(columns_of(group).start, columns_of(group).stop) for group in LOCAL_GROUPS])
_PLACE = plain(5)  # numbers of a root state that tell where it is, and how high
_WIDTH = plain(CONTENT + 2 * LOCAL + 5)  # numbers that a key time is known by


@by_reference
class OwnParts(NamedTuple):
    """A body and its pairs of parts that must not touch."""

    body: WholeBody
    first: Indices  # (P,) as in `SelfPairs`
    second: Indices
    kinds: Indices
    limits: Floats32
    levers: Floats  # (P, M) as `BodyLevers.between` has them


class KeyedMotion(NamedTuple):
    """A motion as it is shown."""

    states: Floats  # (n+1, 7) of the root, and
    keys: Floats  # (n+1, LOCAL) the upper body at the key times, and
    rates: Floats  # (n+1, LOCAL) its velocities there
    interval: float  # seconds between them


@by_reference
class Seen(NamedTuple):
    """Key intervals that were looked at, by the content of both their ends, and what feet stood on in them."""

    known: RowIndex
    gaps: Floats  # (S,) metres proven of all pairs, and
    groups: Indices  # (S,) the number in `SEARCH_ORDER` of the group of the pair that is nearest by what is proven
    rises: KnownRises


class _Feet(NamedTuple):
    """What feet stand on."""

    under: Underfoot
    known: KnownRises


def own_parts(model: BodyModel, pairs: SelfPairs, levers_of_body: BodyLevers) -> OwnParts:
    """The parts of a body that must not run into each other."""
    levers = levers_of_body.between(pairs.first, pairs.second, model.roots.indices)
    return OwnParts(model.whole, pairs.first, pairs.second, pairs.kinds, pairs.limits, levers)


def parts_of(parts: OwnParts, group: DofGroup) -> OwnParts:
    """Only the pairs of one group and what it must keep clear of."""
    at = np.flatnonzero(parts.kinds == SEARCH_ORDER.index(group))
    return OwnParts(parts.body, parts.first[at], parts.second[at], parts.kinds[at], parts.limits[at], parts.levers[at])


class OwnMotion:
    """One avatar's motion among its own parts, and the key intervals of it that were looked at."""

    def __init__(
        self,
        parts: OwnParts,
        underfoot: Underfoot = ON_PLANE,
        room: int = _ROOM,
        rises: KnownRises | None = None,
    ) -> None:
        """So many intervals can be remembered; when half of them are, all are forgotten before the next plan.

        What is known of feet may be shared.
        """
        self._parts, self._underfoot = parts, underfoot
        known, rises = new_row_index(room, 2 * _WIDTH), rises or new_known_rises(underfoot)
        self._seen = Seen(known, np.empty(room), np.empty(room, np.int64), rises)

    def contacts(self, path: RootPath, keys: Floats, rates: Floats, walk: Floats, ahead: int) -> Indices:
        """The group, by its number in `SEARCH_ORDER`, that is not clear of the body in each interval (n,), or -1.

        `keys` (n+1, LOCAL) and `rates` (n+1, LOCAL) are the upper body and its velocity at the key times, the first of
        which is `ahead` key intervals from now. Where both ends of an interval do as in the natural `walk`
        (n+1, LOCAL), it does not touch. Farther ahead more is asked for.
        """
        gaps, groups = self.proven(path, keys, rates, walk)
        wanted = np.where(ahead + np.arange(len(gaps)) < _SOON, ENOUGH, _AFAR)
        found: Indices = np.where(gaps < wanted, groups, -1)
        return found

    def proven(self, path: RootPath, keys: Floats, rates: Floats, walk: Floats) -> tuple[Floats, Indices]:
        """The proven gaps (n,), metres, and whose (n,) they are: infinite and -1 where it does as in the walk."""
        shown = KeyedMotion(path.states, keys, rates, path.interval)
        gaps, groups = _proven(self._parts, self._underfoot, self._seen, shown, walk)
        return gaps, groups


@exact_kernel
def _proven(
    parts: OwnParts, underfoot: Underfoot, seen: Seen, shown: KeyedMotion, walk: Floats
) -> tuple[Floats, Indices]:
    """See `OwnMotion.proven`."""
    gaps, groups = np.full(shown.keys.shape[0] - 1, np.inf), np.full(shown.keys.shape[0] - 1, -1)
    chosen = _beside(shown.keys, walk)
    if not chosen.shape[0]:
        return gaps, groups
    names = _names(shown, underfoot.ground.plain)
    if 2 * seen.known.taken[0] > seen.gaps.shape[0]:
        forget(seen.known)
    missing, count = np.empty(chosen.shape[0], np.int64), 0
    for k in chosen:
        place = place_of(seen.known, names[k * _WIDTH : (k + 2) * _WIDTH])
        if place < 0:
            missing[count] = k
            count += 1
        else:
            gaps[k], groups[k] = seen.gaps[place], seen.groups[place]
    if count:
        _prove(parts, _Feet(underfoot, seen.rises), shown, missing[:count], gaps, groups)
        for k in missing[:count]:
            place = admit(seen.known, names[k * _WIDTH : (k + 2) * _WIDTH])
            seen.gaps[place], seen.groups[place] = gaps[k], groups[k]
    return gaps, groups


@helper
def _names(shown: KeyedMotion, plain_ground: bool) -> Indices:
    """What the key times are known by, one after the other, ((n+1) _WIDTH,)."""
    names = np.zeros(shown.keys.shape[0] * _WIDTH, np.int64)
    contents = names.reshape(shown.keys.shape[0], _WIDTH)
    set_contents(shown.states, shown.keys, contents)
    for t in range(shown.keys.shape[0]):
        set_bits(shown.rates[t], contents[t, CONTENT + LOCAL :])
        if not plain_ground:
            set_bits(shown.states[t, :3], contents[t, _WIDTH - _PLACE :])
            set_bits(shown.states[t, HEIGHT:RISES], contents[t, _WIDTH - _PLACE + 3 :])
    return names


@helper
def _beside(keys: Floats, walk: Floats) -> Indices:
    """The intervals (K,) at whose ends the upper body (n+1, LOCAL) does not do as in the `walk` (n+1, LOCAL)."""
    chosen, count, natural = np.empty(keys.shape[0] - 1, np.int64), 0, is_natural(keys[0], walk[0])
    for k in range(chosen.shape[0]):
        before, natural = natural, is_natural(keys[k + 1], walk[k + 1])
        if not (before and natural):
            chosen[count] = k
            count += 1
    return chosen[:count]


@helper
def _prove(parts: OwnParts, feet: _Feet, shown: KeyedMotion, chosen: Indices, least: Floats, groups: Indices) -> None:
    """Set the proven gaps `least` (n,) in chosen intervals (K,), and whose they are."""
    count, looks = chosen.shape[0], _PARTS + 1
    intervals, moments = np.empty(count * looks, np.int64), np.empty(count * looks)
    moves = np.empty((count * _PARTS, parts.levers.shape[1]))
    for i in range(count):
        for n in range(looks):
            intervals[i * looks + n], moments[i * looks + n] = chosen[i], n / _PARTS
        _set_moves(shown, chosen[i], moves[i * _PARTS : (i + 1) * _PARTS])
    roots, postures = _roots_at(parts, feet, shown, intervals, moments), _postures(shown, intervals, moments)
    lengths, limits = _lengths(parts.levers, moves), np.empty((count, parts.limits.shape[0]), np.float32)
    limits[:] = parts.limits
    if not feet.under.ground.plain:
        _add_raising(parts, postures, roots, lengths)
        _lower_to_upright(parts, roots, limits)
    owner = np.arange(count * looks) // looks
    proof = begun(_gaps(parts, postures, roots, limits, owner), lengths, _PARTS, _AFAR, _HALVINGS)
    wanted, shares, owner = np.empty(_LOOKS, np.int64), np.empty(_LOOKS), np.empty(_LOOKS, np.int64)
    more = due(proof, wanted, shares)
    while more > 0:
        for n in range(more):
            shares[n] = (wanted[n] % _PARTS + shares[n]) / _PARTS
            owner[n] = wanted[n] // _PARTS
            wanted[n] = chosen[owner[n]]
        roots = _roots_at(parts, feet, shown, wanted[:more], shares[:more])
        postures = _postures(shown, wanted[:more], shares[:more])
        settle(proof, _gaps(parts, postures, roots, limits, owner), more)
        more = due(proof, wanted, shares)
    for b in range(proof.least.shape[0]):
        k = chosen[b // _PARTS]
        for p in range(parts.kinds.shape[0]):
            if proof.least[b, p] < least[k]:
                least[k], groups[k] = proof.least[b, p], parts.kinds[p]


@helper
def _set_moves(shown: KeyedMotion, k: int, out: Floats) -> None:
    """What every component of the body moves at most in the parts of an interval: `out` (_PARTS, M)."""
    states, keys, rates, interval = shown
    for g in range(_COLUMNS.shape[0]):
        low, high = _COLUMNS[g, 0], _COLUMNS[g, 1]
        ends = keys[k, low:high], rates[k, low:high], keys[k + 1, low:high], rates[k + 1, low:high]
        out[:, g * MOVES : (g + 1) * MOVES] = moves_between(ends, interval, _PARTS)
    out[:, _COLUMNS.shape[0] * MOVES :] = stride_moves(states[k], states[k + 1], interval, _PARTS)


@helper
def _lengths(levers: Floats, moves: Floats) -> Floats:
    """How far pairs with levers (P, M) can move against each other in parts with moves (B, M): shape (B, P)."""
    out = np.zeros((moves.shape[0], levers.shape[0]))
    for b in range(out.shape[0]):
        for p in range(out.shape[1]):
            for m in range(moves.shape[1]):
                out[b, p] += levers[p, m] * moves[b, m]
    return out


@helper
def _add_raising(parts: OwnParts, postures: Floats, roots: Floats, lengths: Floats) -> None:
    """Add to `lengths` (B, P) what moves legs against the pelvis from look to look because the ground under feet does.

    That is measured: each posture (N, DOF) is held, in its root state (N, ROOT_STATE), over the ground of the next.
    """
    over = roots.copy()
    over[:-1, CLIMB:] = roots[1:, CLIMB:]
    before, chests, _ = posed_body(parts.body, postures, roots)
    after, raised, _ = posed_body(parts.body, postures, over)
    moved = np.empty(before.shape[0])
    for b in range(lengths.shape[0]):
        n = b + b // _PARTS
        shift = raised[n] - chests[n]
        for c in range(moved.shape[0]):
            moved[c] = SPARE * _moved(before[c, :, n], after[c, :, n], shift)
        for p in range(lengths.shape[1]):
            lengths[b, p] += moved[parts.first[p]] + moved[parts.second[p]]


@helper
def _lower_to_upright(parts: OwnParts, roots: Floats, limits: Floats32) -> None:
    """Let trunk and head come as near to the legs as they are upright somewhere in the same interval, as in a walk.

    `limits` (K, P) of the intervals; root states (N, ROOT_STATE), N / K of each.
    """
    axes, _, _ = posed_body(parts.body, np.zeros((roots.shape[0], DOF)), roots)
    looks = roots.shape[0] // limits.shape[0]
    for p in range(limits.shape[1]):
        if parts.kinds[p] < _CARRIED:
            found = clear_pairs(axes[parts.first[p]], axes[parts.second[p]])
            for n in range(roots.shape[0]):
                limits[n // looks, p] = min(limits[n // looks, p], found[n] - OVERLAP)


@helper
def _moved(before: Floats32, after: Floats32, shift: Floats) -> float:
    """How far an axis (6,) is moved, beyond a shift (3,) of all, at that of its ends which goes farther."""
    farthest = 0.0
    for end in range(2):
        square = 0.0
        for k in range(3):
            square += (after[3 * end + k] - before[3 * end + k] - shift[k]) ** 2
        farthest = max(farthest, square)
    return float(np.sqrt(farthest))


@inner_exact_kernel
def _roots_at(parts: OwnParts, feet: _Feet, shown: KeyedMotion, intervals: Indices, shares: Floats) -> Floats:
    """The root states (N, ROOT_STATE) at shares (N,) of `intervals` (N,), on what the feet stand on, at the origin."""
    roots = np.zeros((shares.shape[0], ROOT_STATE))
    for n in range(roots.shape[0]):
        k = intervals[n]
        state = interpolate_root(shown.states[k], shown.states[k + 1], shares[n], shown.interval)
        for j in range(state.shape[0]):
            roots[n, j] = state[j]
    if not feet.under.ground.plain:
        recall_rises(feet.known, feet.under, parts.body.gait_legs, parts.body.scale, roots)
    roots[:, :3] = 0.0
    return roots


@inner_exact_kernel
def _postures(shown: KeyedMotion, intervals: Indices, shares: Floats) -> Floats:
    """The postures (N, DOF) at shares (N,) of `intervals` (N,), of a root at the origin."""
    keys, rates, interval = shown.keys, shown.rates, shown.interval
    count, first = shares.shape[0], DOF - keys.shape[1]
    postures = np.zeros((count, DOF))
    for n in range(count):
        k, u = intervals[n], shares[n]
        for j in range(keys.shape[1]):
            a, b, m, e = keys[k, j], keys[k + 1, j], interval * rates[k, j], interval * rates[k + 1, j]
            postures[n, first + j] = a + u * (m + u * (3.0 * (b - a) - 2.0 * m - e + u * (2.0 * (a - b) + m + e)))
    return postures


@exact_kernel
def _gaps(parts: OwnParts, postures: Floats, roots: Floats, limits: Floats32, owner: Indices) -> Floats32:
    """The gaps (N, P) of the pairs in postures (N, DOF) and root states, metres beyond what they may come near.

    That is a row of `limits` (K, P), told for each posture by `owner` (N or more,).
    """
    capsules, _, _ = posed_body(parts.body, postures, roots)
    count = roots.shape[0]
    gaps = np.empty((count, parts.first.shape[0]), np.float32)
    for p in range(parts.first.shape[0]):
        found = clear_pairs(capsules[parts.first[p]], capsules[parts.second[p]])
        for n in range(count):
            gaps[n, p] = found[n] - limits[owner[n], p]
    return gaps
