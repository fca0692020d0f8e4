"""The certificate of a plan that was not found: the slice where it ends, and the obstacles that end it.

First it is asked whether obstacles leave any posture of the whole upper body in the slice at all; if some are left,
whether any of them can be reached within the speed limits from what was reached before. Where the key times allow a
path and only the motion between them touches, no obstacles are named.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.exact.certificate.obstacles import SliceContacts, blocking_obstacles
from elbowroom.planning.exact.joint.bounds import Problem
from elbowroom.planning.exact.joint.clearances import clearances_under
from elbowroom.planning.exact.joint.reachability import next_triples, reach
from elbowroom.planning.exact.joint.step import PRODUCT, JointStep
from elbowroom.planning.result import Blockade, BlockadeKind
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.rows import each_of, span_of

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]


def blockade(step: JointStep, path: RootPath, depth: int, rows: Indices) -> Blockade:
    """Why there is no path into the slice at `depth`; `rows` (B,) are its obstacles' numbers."""
    named, kind = blocking_obstacles(_contacts(step, depth, _possible(step, depth))), BlockadeKind.NO_POSTURE
    if named is None:
        for before in range(depth + 1):
            step.fill(before, np.ones(step.filled.shape[1], np.bool_))
        problem = _until(step.problem(), depth)
        reached = reach(problem)
        if 0 <= reached.depth < depth:
            depth = reached.depth + 1
            possible = _possible(step, depth)
            named = blocking_obstacles(_contacts(step, depth, possible))
            if named is None:
                kind = BlockadeKind.OUT_OF_REACH
                near = next_triples(problem, reached.depth, reached.triples)
                named = blocking_obstacles(_contacts(step, depth, possible & near))
    obstacles = () if named is None else tuple(int(rows[b]) for b in named)
    state = path.states[depth]
    ahead = np.linalg.norm(np.diff(path.states[: depth + 1, :2], axis=0), axis=1).sum()
    return Blockade(
        kind if obstacles else BlockadeKind.MOTION,
        path.start_time + path.interval * depth,
        (float(state[0]), float(state[1])),
        float(ahead),
        obstacles,
    )


def _possible(step: JointStep, depth: int) -> Bools:
    """The triples (W, L, R) that the body itself allows in a slice, whatever is near."""
    usable = [np.isfinite(step.nodes[g].costs_alone[depth]) for g in PRODUCT]
    touches_body = [step.touches_body(g, depth, np.flatnonzero(usable[0])) for g in PRODUCT[1:]]
    apart = step.apart_at(depth)
    possible: Bools = np.zeros((len(usable[0]), len(usable[1]), len(usable[2])), np.bool_)
    for row, w in enumerate(np.flatnonzero(usable[0])):
        both = (usable[1] & ~touches_body[0][row])[:, None] & (usable[2] & ~touches_body[1][row])
        possible[w] = both & apart
    return possible


def _contacts(step: JointStep, depth: int, candidates: Bools) -> SliceContacts:
    """Which obstacle closes which node of a slice."""
    around, waist = step.around, step.nodes[0]
    obstacles, count = list(each_of(span_of(around.obstacles, depth))), candidates.shape[0]
    used = candidates.any(axis=(1, 2))
    pelvis = around.places[depth][None], around.turns[depth][None]
    chests = step.chests(depth, step.configurations(0, depth))
    one = np.ones(1, np.bool_)
    by_waist = np.zeros((len(obstacles), count), np.bool_)
    by_pair = [np.zeros((len(obstacles), count, step.nodes[g].base.shape[1]), np.bool_) for g in PRODUCT[1:]]
    for b, obstacle in enumerate(obstacles):
        clear, _ = clearances_under(step.lanes(0, depth), *pelvis, obstacle, one)
        by_waist[b] = clear[0, :count] < waist.margins[depth]
        for g in range(1, len(step.nodes)):
            child = step.nodes[g]
            found, _ = clearances_under(step.lanes(g, depth), *chests, obstacle, used & ~by_waist[b])
            closed = found[:, : child.base.shape[1]] < child.margins[depth]
            if g in PRODUCT:
                by_pair[PRODUCT.index(g) - 1][b] = closed
            else:
                by_waist[b] |= (closed | ~np.isfinite(child.base[depth])).all(axis=1)
    return SliceContacts(candidates, by_waist, by_pair[0], by_pair[1])


def _until(problem: Problem, depth: int) -> Problem:
    """The product's first slices, up to a depth."""
    return Problem(
        waist=problem.waist[: depth + 1],
        left=problem.left[: depth + 1],
        right=problem.right[: depth + 1],
        waist_edges=problem.waist_edges[:depth],
        left_edges=problem.left_edges[:depth],
        right_edges=problem.right_edges[:depth],
        apart=problem.apart[: depth + 1],
    )
