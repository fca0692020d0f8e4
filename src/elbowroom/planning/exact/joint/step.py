"""The joint step along a root path: the product of waist and arms, filled in as far as it is needed.

What the waist's children cost under a waist has to be computed for every waist. So the waists that are cheapest by
themselves are filled in first, and the product among them is searched exactly (`product`). A path that is found
costs U: every waist through which a path could be cheaper, were nothing near its children, is filled in too and the
product searched again. So the answer is that of all waists, though most were never filled in; and there is none only
when all of them were.
"""

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, SEARCH_ORDER
from elbowroom.body.pose.kinematics import BodyModel, chest_frames
from elbowroom.jit import kernel
from elbowroom.planning.exact.joint.bounds import Problem, path_costs
from elbowroom.planning.exact.joint.clearances import Lanes, clearances_under
from elbowroom.planning.exact.joint.product import NO_PATH, OUT_OF_BUDGET, JointPath, joint_path
from elbowroom.planning.exact.lattice.postures import BLOCK, Postures, blocks_of
from elbowroom.planning.exact.sweep.own_body import OwnBody
from elbowroom.planning.exact.sweep.own_body_nodes import SPARE, touches_body
from elbowroom.planning.model.axis_distances import arm_clearances
from elbowroom.planning.model.frames import compose
from elbowroom.planning.model.limb import pose
from elbowroom.planning.model.self_pairs import carriers_of, with_waist
from elbowroom.planning.motion import GoOn, keep_going
from elbowroom.planning.result import PlanStatus
from elbowroom.world.obstacles.layout import Spans
from elbowroom.world.obstacles.rows import span_of

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

# The groups whose postures are combined, by their numbers in the order of search: the waist, and those of its children
# that may run into each other. Every other child is as well as it can be under each waist.
PRODUCT = (0, *(SEARCH_ORDER.index(arm) for arm in ARMS))
_PAIR = PRODUCT[1:]
ALONE = tuple(g for g in range(1, len(SEARCH_ORDER)) if g not in PRODUCT)
_FIRST = 8  # waists of each slice that are filled in at first
_GROWTH = 3
_FEW = 8  # waists of a slice that are filled in together
_ALIKE = 0.1  # radians, of both ends together: edges so near to one that touches are closed with it
_INFINITE = np.float32(np.inf)


class JointSettings(NamedTuple):
    """What a joint step prefers and where it ends."""

    step: float  # weight of edges
    near: float  # weight of lacking comfort
    comfort: float  # metres
    budget: int = 400_000  # triples settled
    # No waists more are filled in after so many waists and capsules, or so many triples settled.
    waists: int = 300
    checks: int = 1_000_000
    triples: int = 300_000


class GroupNodes(NamedTuple):
    """The nodes of a group: W postures, the last one repeated to whole blocks, and E extra ones of each key time."""

    postures: Postures
    extras: Floats  # (n+1, E, d)
    base: Floats32  # (n+1, W+E) their costs; a child's as if nothing were near; infinite: not to be used
    costs_alone: Floats32  # (n+1, W+E) the same, for the waist too as if nothing were near
    goals: Floats  # (n+1, d)
    margins: Floats  # (n+1,) metres of clearance that a node needs


class PathSurroundings(NamedTuple):
    """Where the avatar goes."""

    states: Floats  # (n+1, 7) the root at the key times
    places: Floats  # (n+1, m, 3) pelvis at m moments around each key time, in the world
    turns: Floats  # (n+1, m, 4)
    obstacles: Spans  # in the world, around each key time

    def chests(self, model: BodyModel, depth: int, waists: Floats) -> tuple[Floats, Floats]:
        """The chest's frames (F, m, 3), (F, m, 4) in the world under waists (F, d), at a slice's moments."""
        inner, inner_turns = chest_frames(model, waists)
        places, turns = self.places[depth], self.turns[depth]
        moments = len(places)
        found = compose(
            np.tile(places, (len(waists), 1)), np.tile(turns, (len(waists), 1)),
            np.repeat(inner, moments, axis=0), np.repeat(inner_turns, moments, axis=0),
        )  # fmt: skip
        return found[0].reshape(len(waists), moments, 3), found[1].reshape(len(waists), moments, 4)


class JointStep:
    """One joint step: the tables that it has filled in."""

    def __init__(
        self,
        body: OwnBody,
        nodes: tuple[GroupNodes, ...],
        around: PathSurroundings,
        settings: JointSettings,
    ) -> None:
        """The `nodes` of all groups in the order of search."""
        self.nodes = nodes
        self.around, self.settings = around, settings
        self.checks, self.states = 0, 0
        self._waists = 0  # that were filled in, of all slices
        self._body = body
        depths, waists = nodes[0].base.shape
        self.filled = np.zeros((depths, waists), np.bool_)
        # What the nodes of the pair cost under each waist, and what the other children cost there at least.
        self.costs = [np.full((depths, waists, nodes[g].base.shape[1]), _INFINITE, np.float32) for g in _PAIR]
        self._others = np.zeros((depths, waists), np.float32)
        self._lanes: dict[tuple[int, int], Lanes] = {}
        self._alone: dict[int, Floats32] = {}  # what paths of a group cost by themselves

    def search(self, go_on: GoOn = keep_going) -> JointPath:
        """The cheapest path for all three groups; nodes count as in `GroupNodes`. `go_on` is called now and then."""
        for g in PRODUCT:
            if g not in self._alone:
                self._alone[g] = path_costs(self.nodes[g].base, self.edges[g])
        alone = self._alone[0] + self._alone[_PAIR[0]].min() + self._alone[_PAIR[1]].min()
        count = _FIRST
        while True:
            whole = count >= alone.shape[1]
            wanted = np.isfinite(alone)
            if not whole:
                wanted &= alone <= np.partition(alone, count - 1, axis=1)[:, count - 1 : count]
            go_on()
            path = self._among(wanted)
            if path.status is PlanStatus.FOUND:
                break
            if whole or path.status is PlanStatus.OUT_OF_BUDGET or self.spent:
                return path
            count *= _GROWTH
        needed = np.isfinite(alone) & (alone <= path.cost)
        if self.spent or (wanted >= needed).all():
            return path
        go_on()
        better = self._among(self.filled | needed)
        return path if better.status is PlanStatus.OUT_OF_BUDGET else better

    @property
    def spent(self) -> bool:
        """Whether so much was done that nothing more is begun."""
        s = self.settings
        return self._waists > s.waists or self.checks > s.checks or self.states > s.triples

    def _among(self, waists: Bools) -> JointPath:
        """The cheapest path among some waists (n+1, W+E), filled in first, as far as each group has paths."""
        alive: list[Bools] = [np.isfinite(self.nodes[g].base[0]) for g in PRODUCT]
        for depth in range(len(waists)):
            if depth > 0:
                alive = [_led_to(edges[depth - 1], here) for edges, here in zip(self._all_edges, alive, strict=True)]
            for some in a_few(waists[depth] & alive[0]):
                self.fill(depth, some)
                if self.spent:
                    return OUT_OF_BUDGET
            alive = [here & open_ for here, open_ in zip(alive, self._open(depth, alive[0]), strict=True)]
            if not all(here.any() for here in alive):
                return NO_PATH
        path = joint_path(self.problem(), self.settings.budget - self.states)
        self.states += path.states
        return path

    @property
    def _all_edges(self) -> list[Floats32]:
        """The edges of the groups that are combined, in the order of `PRODUCT`."""
        return [self.edges[g] for g in PRODUCT]

    def _open(self, depth: int, alive: Bools) -> list[Bools]:
        """Nodes of a slice that are in some free triple under waists that are `alive` (W+E,), by each arm itself."""
        waists = np.flatnonzero(alive & self.filled[depth])
        free = [np.isfinite(costs[depth, waists]) for costs in self.costs]
        under = np.isfinite(self.nodes[0].base[depth, waists] + self._others[depth, waists])
        usable = under & free[0].any(axis=1) & free[1].any(axis=1)
        waist = np.zeros(len(alive), np.bool_)
        waist[waists[usable]] = True
        return [waist, *(arm[usable].any(axis=0) for arm in free)]

    def problem(self) -> Problem:
        """The product as far as it is filled in."""
        waist = np.where(self.filled, self.nodes[0].base + self._others, _INFINITE)
        of_waist, of_left, of_right = (self.edges[g] for g in PRODUCT)
        return Problem(waist, self.costs[0], self.costs[1], of_waist, of_left, of_right, self.apart)

    def fill(self, depth: int, waists: Bools) -> None:
        """Compute the children's costs under some waists (W+E,) of a slice, those that are not known yet."""
        chosen = np.flatnonzero(waists & ~self.filled[depth] & np.isfinite(self.nodes[0].base[depth]))
        if not len(chosen):
            return
        self.filled[depth, chosen] = True
        self._waists += len(chosen)
        inner = self.configurations(0, depth)[chosen]
        frames, body = self.chests(depth, inner), self._body_under(depth, chosen)
        for g in range(1, len(self.nodes)):
            group, lanes, every = self.nodes[g], self.lanes(g, depth), np.ones(len(chosen), np.bool_)
            clear, checks = clearances_under(lanes, *frames, span_of(self.around.obstacles, depth), every)
            self.checks += checks
            clear = clear[:, : group.base.shape[1]]
            if depth > 0:
                clear[self._touching(g, depth, body)] = -np.inf
            lack = np.maximum(np.float32(self.settings.comfort) - clear, np.float32(0.0))
            cost = group.base[depth] + np.float32(self.settings.near) * np.minimum(lack, 1.0) ** 2
            cost[clear < group.margins[depth]] = _INFINITE
            if g in _PAIR:
                self.costs[_PAIR.index(g)][depth, chosen] = cost
            else:
                self._others[depth, chosen] += cost.min(axis=1)

    def touches_body(self, g: int, depth: int, waists: Indices) -> Bools:
        """Which nodes of a child touch what the waist alone poses under some waists (F,) of a slice, (F, W+E)."""
        return self._touching(g, depth, self._body_under(depth, waists))

    def _body_under(self, depth: int, waists: Indices) -> Floats32:
        """All capsules (F, all, 6) in the chest frame under some waists (F,) of a slice."""
        states = np.repeat(self.around.states[depth : depth + 1], len(waists), axis=0)
        return self._body.seen(with_waist(self.configurations(0, depth)[waists]), states)

    def _touching(self, g: int, depth: int, body: Floats32) -> Bools:
        """Which nodes of a child touch what the waist alone poses of a `body` (F, all, 6), (F, W+E)."""
        lanes, size, group = self.lanes(g, depth), self.nodes[g].base.shape[1], SEARCH_ORDER[g]
        out = np.zeros((len(body), size), np.bool_)
        if carriers := carriers_of(group):
            parts = self._body.parts(group, carriers, body)
            for row, axes in enumerate(parts.axes):
                out[row] = touches_body(lanes.lanes, lanes.balls, axes, parts.allowed, SPARE)[:size]
        return out

    def configurations(self, group: int, depth: int) -> Floats:
        """The configurations (W+E, d) of a group's nodes at a depth."""
        nodes = self.nodes[group]
        return np.concatenate([_padded(nodes.postures), nodes.extras[depth]])

    def chests(self, depth: int, waists: Floats) -> tuple[Floats, Floats]:
        """`PathSurroundings.chests` of this body."""
        return self.around.chests(self._body.model, depth, waists)

    def lanes(self, group: int, depth: int) -> Lanes:
        """All of a group's nodes at a depth as lanes."""
        if (group, depth) not in self._lanes:
            known, extras = self.nodes[group].postures, self.nodes[group].extras[depth]
            lanes, balls = blocks_of(pose(known.limb, extras), known.limb.radii)
            both = np.concatenate([known.lanes, lanes]), np.concatenate([known.balls, balls])
            self._lanes[group, depth] = Lanes(*both, known.reach)
        return self._lanes[group, depth]

    def close(self, group: int, depth: int, nodes: Indices) -> None:
        """Close the edge of a group between two nodes (2,) from `depth` to the next, and those that are like it."""
        near = []
        for at, node in enumerate(nodes):
            known = self.configurations(group, depth + at)
            near.append(np.sum((known - known[node]) ** 2, axis=1))
        self.edges[group][depth][near[0][:, None] + near[1] <= _ALIKE * _ALIKE] = np.inf
        self._alone.pop(group, None)

    @cached_property
    def edges(self) -> list[Floats32]:
        """What the groups' edges cost, each (n, W+E, W+E)."""
        return [_edge_costs_of(group, self.settings.step) for group in self.nodes]

    @cached_property
    def apart(self) -> Bools:
        """Which arms keep clear of each other, (n+1, L, R); at the start they are as they are."""
        depths = range(1, len(self.filled))
        start = np.ones((1, self.costs[0].shape[2], self.costs[1].shape[2]), np.bool_)
        return np.concatenate([start, *(self.apart_at(depth)[None] for depth in depths)])

    @cached_property
    def _known_apart(self) -> tuple[list[Floats32], Bools]:
        segments = [_padded_segments(self.nodes[g].postures) for g in _PAIR]
        return segments, arm_clearances(segments[0], segments[1], self._between) >= SPARE

    @cached_property
    def _between(self) -> Floats32:
        """How near the axes of the pair's capsules may come to each other, (C, C) metres."""
        left, right = (SEARCH_ORDER[g] for g in _PAIR)
        return np.ascontiguousarray(self._body.pairs.beside(left, (right,))[1])

    def apart_at(self, depth: int) -> Bools:
        """Which arms keep clear of each other in a slice, (L, R)."""
        segments, known = self._known_apart
        own = [
            np.ascontiguousarray(pose(group.postures.limb, group.extras[depth]))
            for group in (self.nodes[g] for g in _PAIR)
        ]
        apart = np.empty((self.costs[0].shape[2], self.costs[1].shape[2]), np.bool_)
        apart[: known.shape[0], : known.shape[1]] = known
        every, between = np.concatenate([segments[1], own[1]], axis=2), self._between
        apart[known.shape[0] :] = arm_clearances(own[0], every, between) >= SPARE
        apart[: known.shape[0], known.shape[1] :] = arm_clearances(segments[0], own[1], between) >= SPARE
        return apart


def a_few(waists: Bools) -> Iterator[Bools]:
    """Some waists (W,) in parts of a few each."""
    numbers = np.flatnonzero(waists)
    for first in range(0, len(numbers), _FEW):
        part = np.zeros_like(waists)
        part[numbers[first : first + _FEW]] = True
        yield part


def _led_to(edges: Floats32, nodes: Bools) -> Bools:
    """The nodes (V,) to which edges (V, V) lead from some `nodes` (V,)."""
    return np.asarray(np.isfinite(edges[nodes]).any(axis=0))


def _padded(postures: Postures) -> Floats:
    """The configurations (W, d), the last one repeated to whole blocks."""
    width = len(postures.lanes) * BLOCK
    return postures.configurations[np.minimum(np.arange(width), len(postures.configurations) - 1)]


def _padded_segments(postures: Postures) -> Floats32:
    """The capsules (C, 6, W), the last posture's repeated to whole blocks."""
    width = len(postures.lanes) * BLOCK
    return np.ascontiguousarray(postures.segments[:, :, np.minimum(np.arange(width), postures.segments.shape[2] - 1)])


def _edge_costs_of(group: GroupNodes, weight: float) -> Floats32:
    """What edges cost, (n, W+E, W+E): `weight` times the squared change of the deviation from the goal."""
    longest = group.postures.step**2 * (1.0 + 1e-6)
    known = np.repeat(_padded(group.postures)[None], len(group.extras), axis=0)
    nodes = np.concatenate([known, group.extras], axis=1)
    return _edge_costs(nodes, group.extras.shape[1], group.postures.moves, group.goals, longest, weight)


@kernel
def _edge_costs(nodes: Floats, extra: int, moves: Floats32, goals: Floats, longest: float, weight: float) -> Floats32:
    """`_edge_costs_of` for nodes (n+1, W+E, d), the last `extra` are extra nodes; `moves` (V, W) squared lengths."""
    count, size = nodes.shape[1], nodes.shape[2]
    width = count - extra
    out, slopes = np.empty((nodes.shape[0] - 1, count, count), np.float32), np.empty((2, count))
    for t in range(nodes.shape[0] - 1):
        square = 0.0
        slopes[:] = 0.0
        for j in range(size):
            change = goals[t + 1, j] - goals[t, j]
            square += weight * change * change
            for i in range(2):
                for v in range(count):
                    slopes[i, v] += 2.0 * weight * change * nodes[t + i, v, j]
        for v in range(count):
            row = out[t, v]
            for u in range(count):
                move = 0.0
                if v < width and u < width:
                    move = moves[v, u] if v < moves.shape[0] else np.inf
                else:
                    for j in range(size):
                        move += (nodes[t + 1, u, j] - nodes[t, v, j]) ** 2
                cost = max(weight * move + square + slopes[0, v] - slopes[1, u], 0.0)
                row[u] = cost if move <= longest else np.inf
    return out
