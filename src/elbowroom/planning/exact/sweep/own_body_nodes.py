"""The kernels of `OwnBody`: a group's postures held against the parts of the body, by blocks of sixteen."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, DofGroup
from elbowroom.body.pose.whole_body import WholeBody, posed_body
from elbowroom.body.root import ROOT_STATE
from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper
from elbowroom.planning.exact.lattice.extra_nodes import extra_nodes
from elbowroom.planning.exact.lattice.postures import BLOCK, Postures
from elbowroom.planning.exact.memory.row_contents import is_natural, set_contents
from elbowroom.planning.exact.memory.row_index import RowIndex, admit, forget
from elbowroom.planning.model.axis_distances import lower_to_axis, lower_to_body
from elbowroom.planning.model.limb import pose

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

SPARE = 0.01  # metres that a posture keeps beyond what is allowed, so that the edge to the next keeps it too
_LOCAL = DofGroup.ROOT.size


@by_reference
class OwnBodyNodes(NamedTuple):
    """A group's postures and the rest of the body, and H surroundings in which they were checked."""

    body: WholeBody
    wanted: Indices  # (P,) capsules that it must keep away from
    allowed: Floats32  # (C, P) metres: how near the axes may come
    postures: Postures
    resting: Bools  # (W,) which of them touch the walking body
    known: RowIndex  # the surroundings, by their content
    axes: Floats32  # (H, P, 6) the parts in the chest frame
    marks: Bools  # (H, W) which postures come too near to them


class OwnBodyTask(NamedTuple):
    """One group's nodes along a path, and the body around them."""

    goals: Floats  # (n+1, d) of the group
    previous: Floats  # (n+1, d) what the last plan had
    start: Floats  # (d,)
    settled: bool  # whether it goes on from a path that is proven
    usual: Floats  # (n+1, d) what the group does in the natural walk
    walk: Floats  # (n+1, LOCAL) what all groups do in it, zero where a group is not posed yet
    uppers: Floats  # (n+1, LOCAL) the groups that are posed already, zero elsewhere
    states: Floats  # (n+1, 7) of the root


@exact_kernel
def touches_body(lanes: Floats32, balls: Floats, axes: Floats32, allowed: Floats32, spare: float) -> Bools:
    """Which postures, `lanes` (B, C, 7, 16) with their `balls` (B, C, 4), come too near to the parts: shape (16 B,).

    Parts are `axes` (P, 6), `allowed` (C, P) how near the axes may come, less `spare`.
    """
    out = np.empty(lanes.shape[0] * BLOCK, np.bool_)
    out[:] = False
    spheres, near = _spheres(lanes, balls), np.empty(lanes.shape[0], np.bool_)
    gaps = np.empty(BLOCK, np.float32)
    for c in range(lanes.shape[1]):
        for p in range(axes.shape[0]):
            least = allowed[c, p] + spare
            if least <= 0.0 or not _any_near(axes[p], spheres[c], least, near):
                continue
            for b in range(lanes.shape[0]):
                if near[b]:
                    for i in range(BLOCK):
                        gaps[i] = np.inf
                    lower_to_axis(lanes[b, c], axes[p], least, gaps)
                    for i in range(BLOCK):
                        out[b * BLOCK + i] |= gaps[i] < 0.0
    return out


@helper
def _spheres(lanes: Floats32, balls: Floats) -> Floats:
    """The balls of the axes (C, 4, B): centre and radius without the capsule's own."""
    out = np.empty((balls.shape[1], 4, balls.shape[0]))
    for b in range(balls.shape[0]):
        for c in range(balls.shape[1]):
            for i in range(4):
                out[c, i, b] = balls[b, c, i]
            out[c, 3, b] -= lanes[b, c, 6, 0]
    return out


@helper
def _any_near(axis: Floats32, spheres: Floats, least: float, near: Bools) -> bool:
    """Whether a segment (6,) comes within `least` of any ball (4, B); which of them, into `near` (B,)."""
    ax, ay, az = float(axis[0]), float(axis[1]), float(axis[2])
    ux, uy, uz = axis[3] - ax, axis[4] - ay, axis[5] - az
    whole = max(ux * ux + uy * uy + uz * uz, 1e-18)
    found = 0
    for b in range(np.uint64(near.shape[0])):
        wx, wy, wz = spheres[0, b] - ax, spheres[1, b] - ay, spheres[2, b] - az
        t = min(max((ux * wx + uy * wy + uz * wz) / whole, 0.0), 1.0)
        x, y, z, reach = wx - t * ux, wy - t * uy, wz - t * uz, spheres[3, b] + least
        near[b] = x * x + y * y + z * z <= reach * reach
        found += near[b]
    return found > 0


@exact_kernel
def own_body_costs(own_body_nodes: OwnBodyNodes, task: OwnBodyTask) -> Floats32:
    """What a group's nodes (n+1, W + EXTRA) cost for the body's sake: nothing, or infinity.

    Where the groups before it do as in the natural walk, the group's goal is free if that is what it does in it.
    """
    it, uppers, states = own_body_nodes, task.uppers, task.states
    width, known = it.resting.shape[0], it.postures
    extras, needed, _ = extra_nodes(
        known.configurations, known.columns, known.step, task.goals, task.previous, task.start, task.settled
    )
    depths = extras.shape[0]
    natural, usual = np.empty(depths, np.bool_), np.empty(depths, np.bool_)
    contents = np.empty((depths, it.known.rows.shape[1]), np.int64)
    for t in range(natural.shape[0]):
        natural[t] = is_natural(uppers[t], task.walk[t])
        usual[t] = natural[t] and is_natural(task.goals[t], task.usual[t])
    set_contents(states, uppers, contents)
    rows, fresh = np.empty(depths, np.int64), np.empty(depths, np.int64)
    rows = rows[: _rows_to_check(usual, needed, rows)]
    places = np.empty(rows.shape[0], np.int64)
    fresh = fresh[: _set_places(it.known, contents, rows, places, fresh)]
    if fresh.shape[0]:
        _check(it, uppers, states, rows, places, fresh)
    costs = np.empty((depths, width + extras.shape[1]), np.float32)
    for t in range(costs.shape[0]):
        for v in range(costs.shape[1]):
            costs[t, v] = np.inf if v < width and it.resting[v] else 0.0
    gaps = _extra_gaps(it, extras, rows, places)
    for i in range(rows.shape[0]):
        t, place = rows[i], places[i]
        for e in range(extras.shape[1]):
            if gaps[i, e] < SPARE and not (e == 0 and usual[t]):
                costs[t, width + e] = np.inf
        if not natural[t]:
            for v in range(width):
                if it.marks[place, v]:
                    costs[t, v] = np.inf
    return costs


@helper
def _rows_to_check(usual: Bools, needed: Bools, rows: Indices) -> int:
    """Write down the key times `rows` at which more is asked for than the goal in a natural walk; their number."""
    count = 0
    for t in range(usual.shape[0]):
        asked = not usual[t]
        for e in range(1, needed.shape[1]):
            asked = asked or needed[t, e]
        if asked:
            rows[count] = t
            count += 1
    return count


@helper
def _set_places(known: RowIndex, contents: Indices, rows: Indices, places: Indices, fresh: Indices) -> int:
    """Write down the `places` (R,) of what surrounds the group at `rows` (R,), and the `fresh` ones; their number."""
    if known.taken[0] + rows.shape[0] > known.rows.shape[0]:
        forget(known)
    count = 0
    for i in range(rows.shape[0]):
        before = known.taken[0]
        places[i] = admit(known, contents[rows[i]])
        if places[i] == before:
            fresh[count] = i
            count += 1
    return count


@helper
def _check(it: OwnBodyNodes, uppers: Floats, states: Floats, rows: Indices, places: Indices, fresh: Indices) -> None:
    """Remember what surrounds the group at `fresh` rows, and which postures come too near to it."""
    postures, roots = np.zeros((fresh.shape[0], DOF)), np.zeros((fresh.shape[0], ROOT_STATE))
    for n in range(fresh.shape[0]):
        t = rows[fresh[n]]
        for j in range(uppers.shape[1]):
            postures[n, _LOCAL + j] = uppers[t, j]
        for j in range(3, min(ROOT_STATE, states.shape[1])):
            roots[n, j] = states[t, j]
    capsules, chests, turns = posed_body(it.body, postures, roots)
    for n in range(fresh.shape[0]):
        place = places[fresh[n]]
        _from_chest(capsules, it.wanted, n, chests[n], turns[n], it.axes[place])
        marks = touches_body(it.postures.lanes, it.postures.balls, it.axes[place], it.allowed, SPARE)
        for v in range(marks.shape[0]):
            it.marks[place, v] = marks[v]


@helper
def _from_chest(capsules: Floats32, wanted: Indices, n: int, place: Floats, turn: Floats, out: Floats32) -> None:
    """Some capsules (P,) of posture `n` of (C, 6, N) as seen from a frame, into `out` (P, 6)."""
    x, y, z, w = -turn[0], -turn[1], -turn[2], turn[3]
    for p in range(wanted.shape[0]):
        for e in range(0, 6, 3):
            a = capsules[wanted[p], e, n] - place[0]
            b = capsules[wanted[p], e + 1, n] - place[1]
            c = capsules[wanted[p], e + 2, n] - place[2]
            tx, ty, tz = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
            out[p, e] = a + w * tx + y * tz - z * ty
            out[p, e + 1] = b + w * ty + z * tx - x * tz
            out[p, e + 2] = c + w * tz + x * ty - y * tx


@helper
def _extra_gaps(it: OwnBodyNodes, extras: Floats, rows: Indices, places: Indices) -> Floats32:
    """How far beyond what is allowed extra nodes (n+1, E, d) at R rows are from what surrounds them, metres (R, E)."""
    extra, size = extras.shape[1], extras.shape[2]
    gaps = np.empty((rows.shape[0], extra), np.float32)
    postures, every = np.empty((gaps.size, size)), np.empty(it.wanted.shape[0], np.bool_)
    gaps[:], every[:] = np.inf, True
    for i in range(rows.shape[0]):
        for e in range(extra):
            for j in range(size):
                postures[i * extra + e, j] = extras[rows[i], e, j]
    segments = pose(it.postures.limb, postures)
    mine = np.empty((segments.shape[0], 6, extra), np.float32)
    for i in range(rows.shape[0]):
        for c in range(segments.shape[0]):
            for j in range(6):
                for e in range(extra):
                    mine[c, j, e] = segments[c, j, i * extra + e]
        lower_to_body(mine, it.axes[places[i]], it.allowed, every, gaps[i])
    return gaps
