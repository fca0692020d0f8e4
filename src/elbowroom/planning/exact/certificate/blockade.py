"""The certificate of a plan that was not found: the slice where it ends, and the obstacles that end it.

First it is asked whether obstacles leave any posture of the whole upper body in the slice at all; if some are left,
whether any of them can be reached within the speed limits from what was reached before. Where the key times allow a
path and only the motion between them touches, no obstacles are named.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.exact.certificate.closed_nodes import Closed, SliceNodes
from elbowroom.planning.exact.certificate.obstacles import blocking_obstacles, contacts_of
from elbowroom.planning.exact.joint.bounds import Problem
from elbowroom.planning.exact.joint.reachability import next_triples, reach
from elbowroom.planning.exact.joint.step import PRODUCT, JointStep, a_few
from elbowroom.planning.result import Blockade, BlockadeKind
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.rows import number_of, numbered, span_of

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]


def blockade(step: JointStep, path: RootPath, depth: int, rows: Indices) -> Blockade:
    """Why there is no path into the slice at `depth`; `rows` (B,) are its obstacles' numbers.

    Where a joint step would not fill in so much, what can be reached is not asked.
    """
    named, kind = _named(step, depth, _possible(step, depth)), BlockadeKind.NO_POSTURE
    if named is None and _fill_until(step, depth):
        problem = _until(step.problem(), depth)
        reached = reach(problem)
        if 0 <= reached.depth < depth:
            depth = reached.depth + 1
            possible = _possible(step, depth)
            named = _named(step, depth, possible)
            if named is None:
                kind = BlockadeKind.OUT_OF_REACH
                near = next_triples(problem, reached.depth, reached.triples)
                named = _named(step, depth, possible & near)
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


def _fill_until(step: JointStep, depth: int) -> bool:
    """Fill in the slices up to a depth with all waists; whether that was no more than a joint step does."""
    for before in range(depth + 1):
        for waists in a_few(np.ones(step.filled.shape[1], np.bool_)):
            if step.checks > step.settings.checks:
                return False
            step.fill(before, waists)
    return True


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


def _named(step: JointStep, depth: int, candidates: Bools) -> Indices | None:
    """The obstacles that close all candidates (W, L, R) of a slice, each of them needed; None where one stays open.

    Most slices are open and most things close nothing. So it is first asked of all things together, under a few waists
    at a time; then of half of the things, of a quarter, as long as these close anything.
    """
    near, used = span_of(step.around.obstacles, depth), np.asarray(candidates.any(axis=(1, 2)))
    for waists in a_few(used):
        together = SliceNodes(step, depth, waists).closed_by(near)
        if blocking_obstacles(contacts_of(candidates & waists[:, None, None], [together])) is None:
            return None
    nodes, halves = SliceNodes(step, depth, used), [np.arange(number_of(near))]
    numbers, closing = list[int](), list[Closed]()
    while halves:
        some = halves.pop()
        closed = nodes.closed_by(numbered(near, some))
        if closed.any and len(some) > 1:
            halves += [some[len(some) // 2 :], some[: len(some) // 2]]
        elif closed.any:
            numbers.append(int(some[0]))
            closing.append(closed)
    blocking = blocking_obstacles(contacts_of(candidates, closing))
    return None if blocking is None else np.array(numbers, np.int64)[blocking]


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
