"""One plan of the upper body along one root path: group after group, and all together where that fails.

The groups are searched in the order of the paper, head and arms under the waist's way, each arm clear of the body, the
right one of the left one too. So the head ducks first. Where it has no room, or none to look ahead, the trunk is
searched again as one limb with a head that follows the waist, and the head by itself under that. Where an arm has no
way, the waist's last way is tried, under which the arms had theirs; then the joint step decides.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from time import perf_counter_ns
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import CHILDREN, SEARCH_ORDER, DofGroup, columns_of, followed, followers_of
from elbowroom.planning.exact.certificate.blockade import blockade
from elbowroom.planning.exact.group.caches import PlanCaches
from elbowroom.planning.exact.group.path_problem import PathProblem, no_costs
from elbowroom.planning.exact.group.problem import GroupPath, GroupTask, Guide, Weights, extras_of
from elbowroom.planning.exact.group.upper_body_model import UpperBodyModel
from elbowroom.planning.exact.joint.guide import child_nodes, guide, surroundings, waist_nodes
from elbowroom.planning.exact.joint.step import PRODUCT, JointSettings, JointStep, PathSurroundings
from elbowroom.planning.exact.lattice.lattice import EXTRA, PREVIOUS
from elbowroom.planning.exact.memory.previous_plan import RequiredMargins, jolts
from elbowroom.planning.exact.plan.children import ChildSearch, GroupPaths
from elbowroom.planning.exact.plan.evidence import EvidenceLog
from elbowroom.planning.exact.plan.unhindered import unhindered
from elbowroom.planning.exact.refine.blocked_slice import BlockedSlice
from elbowroom.planning.exact.sweep.crouch import ROUNDS, Crouch, node_waists, too_deep
from elbowroom.planning.exact.sweep.node_clearances import HELD_AT_START, held_clearance
from elbowroom.planning.model.lowered_legs import LoweredLegs
from elbowroom.planning.motion import GoOn, keep_going
from elbowroom.planning.result import Blockade, LocalPlan, PlanStatus
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.rows import span_of

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Longs = NDArray[np.int64]

_DEARER = np.float32(0.5)  # squared radians: what leaving the last plan's way costs the waist that is held to it
_PRESSED = 0.6  # radians from its goal: so far the head goes by itself before the whole trunk is searched as one limb
_JOLT = 0.5  # squared radians that another motion must be better than one under the last plan's waist


class Effort(Enum):
    """What is tried before it is said that there is no way."""

    __hash__ = object.__hash__  # as `DofGroup` has it

    GLANCE = "glance"  # the groups one after the other
    QUICK = "quick"  # where these find none, once more under the last plan's waist, or with the waist held
    JOINT = "joint"  # then all together
    REFINED = "refined"  # then with more postures


class _WaistPath(NamedTuple):
    """A path of the waist, or of the trunk as one limb, and what it was asked for."""

    path: GroupPath
    task: GroupTask
    trunk: bool


class _Trunk(NamedTuple):
    """Paths of the waist and of what could follow it."""

    waist: _WaistPath  # as it was found
    found: GroupPaths
    guides: Mapping[DofGroup, Guide]  # that the waist's children follow


@dataclass(eq=False)
class UpperBodySearch:
    """One root path to be dressed."""

    caches: PlanCaches
    weights: Weights
    model: UpperBodyModel
    legs: LoweredLegs
    problem: PathProblem
    go_on: GoOn = keep_going  # called before each search

    def __post_init__(self) -> None:
        self.margins: RequiredMargins | None = None  # of the way that was found
        self._children = ChildSearch(self.caches, self.problem, self.model.settings.self_rounds)
        self.evidence_log = EvidenceLog(self.caches, self.weights, self.go_on)
        self.deepest = 0  # key time that all groups reached in the best attempt
        self.blocked = 0, 0  # the group, as a number, that failed first, and the key time that it did not reach
        self.spent = False  # whether the joint step did as much as it may
        self._waist: _WaistPath | None = None
        # infinite where the legs have no room to crouch as a node does
        self._crouching = no_costs(self.caches, DofGroup.WAIST, self.path.horizon)

    @property
    def path(self) -> RootPath:
        """The root path."""
        return self.problem.path

    @cached_property
    def _shown(self) -> Floats:
        """What feet stand on as the path is shown, for all ways of the waist."""
        return self.legs.shown(self.path)

    @property
    def goals(self) -> Floats:
        """The goals (n+1, LOCAL)."""
        return self.problem.goals

    @property
    def barred(self) -> bool:
        """Whether no path is left that the waist could try: then there is none for all groups together either."""
        if self._waist is None:
            return False
        way = self._waist.path
        return way.reached < self.path.horizon and way.rounds < self.weights.rounds

    def go_on_with(self, roots: Longs) -> None:
        """The root's sweeps are in these cache entries (n,) now: other searches may have taken those they were in."""
        self.problem = self.problem._replace(roots=roots)
        if self._waist is not None:
            self._waist = self._waist._replace(task=self._waist.task._replace(roots=roots, carriers=roots))

    def too_deep(self, depth: int, waists: Floats) -> Bools:
        """Which of some waists (N, d) crouch deeper at a key time than the legs can there."""
        return too_deep(self.legs, self.path.states[depth], waists)

    def motion(self, rounds: int, *, again: bool = True) -> LocalPlan | None:
        """The motion, if there is one: group after group, `again` under another waist, then in so many rounds of the
        joint step.

        One that would jolt what was planned gives way to one under the last plan's waist that costs no more, or hardly.
        """
        free = unhindered(self.problem, self.caches)
        if free is not None:
            self.margins = self.problem.required
            return free
        found = self.apart()
        if found.failed is not None and not again:
            return None
        if self._waist is not None and self._waist.path.reached == self.path.horizon:
            found = self._under_another_waist(found)
        if found.failed is not None and rounds > 0:
            found = self.together(rounds)
        if found.failed is not None:
            return None
        self.margins = self._margins(found)
        evidence, joint = self.evidence_log.evidence(), self.evidence_log.joint
        return LocalPlan(PlanStatus.FOUND, found.keys, found.goals, evidence, joint, velocities=found.velocities)

    def _under_another_waist(self, found: GroupPaths) -> GroupPaths:
        """What was found, or what is better under the last plan's waist, or where there is none one that is held."""
        last = self.problem.last
        if last is None:
            held = found if found.failed is None else self.with_waist_held()
            return held if held.failed is None else found
        if found.failed is None and not jolts(found.keys, last.keys, last.known):
            return found
        previous = self.with_previous_waist()
        if found.failed is not None:
            return previous
        gives_way = previous.failed is None and self._cost(previous) <= self._cost(found) + _JOLT
        return previous if gives_way else found

    def _margins(self, found: GroupPaths) -> RequiredMargins:
        """The clearances that were asked for: less where the start has less."""
        most, settings = [way.most for way in found.paths], self.model.settings
        enough = min(most) >= max(settings.margin, settings.motion_margin)
        return self.problem.required if enough else self.problem.required.at_most(most)

    def _cost(self, found: GroupPaths) -> float:
        """What paths cost that are free: distance from the goals and its changes, squared radians."""
        cost, goals = 0.0, self.problem.under(found.paths[0].keys).goals
        for group, path in zip(SEARCH_ORDER, found.paths, strict=False):
            away = path.keys - goals[:, columns_of(group)]
            cost += float(np.sum(away**2) + self.weights.step * np.sum(np.diff(away, axis=0) ** 2))
        return cost

    def apart(self) -> GroupPaths:
        """Each group by itself: the waist and what could follow it, or both as one limb; then the arms."""
        self._waist = self._waist_path(self._crouching)
        trunks = [_Trunk(self._waist, self._children.followers(self._waist.path, {}, self.evidence_log), {})]
        if self._is_pressed(trunks[0].found):
            trunks += self._as_one()
        if len(trunks) > 1 and self._is_better(trunks[1].found, trunks[0].found):
            trunks.reverse()
        found = self._with_arms(trunks[0])
        if found.failed is not None and len(trunks) > 1:
            other = self._with_arms(trunks[1])
            if self._is_better(other, found):
                found = other
                trunks.reverse()
        self._waist = trunks[0].waist
        self.blocked = len(found.paths), min(found.reached + 1, self.path.horizon)
        return found

    def _is_pressed(self, found: GroupPaths) -> bool:
        """Whether a group that could follow the waist finds no path under it, or only one far from its goals."""
        if found.failed is not None:
            return len(found.paths) > 0
        goals = self.problem.under(found.paths[0].keys).goals
        for group, path in zip(SEARCH_ORDER[1:], found.paths[1:], strict=False):
            if np.linalg.norm(path.keys - goals[:, columns_of(group)], axis=1).max() > _PRESSED:
                return True
        return False

    def _as_one(self) -> list[_Trunk]:
        """The path of waist and followers as one limb, each of them guided by it; nothing if there is none."""
        trunk = self._waist_path(self._crouching, trunk=True)
        if trunk.path.reached < self.path.horizon:
            return []
        waist = self._waist_path(self._crouching, self._only(trunk.path.keys)).path
        guides = self._following(trunk.path.keys)
        found = self._children.followers(waist, guides, self.evidence_log)
        path = trunk.path._replace(velocities=waist.velocities, entries=waist.entries)
        return [_Trunk(trunk._replace(path=path), found, guides)]

    def _only(self, keys: Floats) -> Guide:
        """A guide of the waist that leaves it no other path than through `keys` (n+1, d)."""
        group, added = self.caches.group(DofGroup.WAIST), np.full_like(self._crouching, np.inf)
        task = self.problem.task(DofGroup.WAIST, self.problem.roots, follow=Guide(keys, added))
        added[np.arange(len(added)), extras_of(group, task).previous] = 0.0
        added[0] = 0.0
        return Guide(keys, added)

    def _following(self, waists: Floats) -> Mapping[DofGroup, Guide]:
        """What the followers of a waist on a path (n+1, d) would do if nobody planned them: they may do that too."""
        uppers = np.zeros_like(self.goals)
        uppers[:, columns_of(DofGroup.WAIST)] = waists
        keys, horizon = followed(uppers), self.path.horizon
        return {
            group: Guide(np.ascontiguousarray(keys[:, columns_of(group)]), no_costs(self.caches, group, horizon))
            for group in followers_of(DofGroup.WAIST)
        }

    def _is_better(self, found: GroupPaths, other: GroupPaths) -> bool:
        """Whether paths lead farther than others, or both to the end and cost less."""
        if found.failed is None and other.failed is None:
            return self._cost(found) < self._cost(other)
        return (found.failed is None, len(found.paths), found.reached) > (
            other.failed is None,
            len(other.paths),
            other.reached,
        )

    def _under(self, waist: _WaistPath, guides: Mapping[DofGroup, Guide] | None = None) -> GroupPaths:
        """The waist's children under a path of it."""
        guides = guides or {}
        return self._with_arms(_Trunk(waist, self._children.followers(waist.path, guides, self.evidence_log), guides))

    def _with_arms(self, trunk: _Trunk) -> GroupPaths:
        """A trunk's path, and those of the arms under it."""
        found = self._children.under(trunk.found, trunk.guides, self.evidence_log)
        if found.failed is not None:
            self.deepest = max(self.deepest, found.reached)
        return found

    def with_previous_waist(self) -> GroupPaths:
        """The waist held to the last plan's way while there is one."""
        costs = np.full_like(self._crouching, _DEARER)
        task = self.problem.task(DofGroup.WAIST, self.problem.roots)
        previous = extras_of(self.caches.group(DofGroup.WAIST), task).previous
        costs[np.arange(len(costs)), previous] = 0.0
        waist = self._waist_path(costs + self._crouching)
        return self._under(waist)

    def with_waist_held(self) -> GroupPaths:
        """The waist held as it is, while it can be.

        Where there is no last plan, who has stopped bent stays so until there is a way out from there.
        """
        waist, shape = columns_of(DofGroup.WAIST), self._crouching.shape
        keys, added = np.tile(self.problem.begins.upper[waist], (shape[0], 1)), np.full(shape, _DEARER, np.float32)
        task = self.problem.task(DofGroup.WAIST, self.problem.roots, follow=Guide(keys, added))
        added[np.arange(len(added)), extras_of(self.caches.group(DofGroup.WAIST), task).previous] = 0.0
        return self._under(self._waist_path(self._crouching, Guide(keys, added)))

    def together(self, rounds: int) -> GroupPaths:
        """All groups at once, guided by the joint step; at most so many of its answers may turn out to touch."""
        waist = self._waist
        assert waist is not None
        if waist.path.reached < self.path.horizon:
            return GroupPaths((), waist.path, waist.path.reached)
        step = self.joint_step()
        ways = GroupPaths((), waist.path, 0)
        for _ in range(rounds):
            began = perf_counter_ns()
            answer = step.search(self.evidence_log.go_on)
            self.evidence_log.enter_joint(step, answer.status, perf_counter_ns() - began)
            self.spent = step.spent
            if answer.status is not PlanStatus.FOUND:
                break
            guides = {
                SEARCH_ORDER[g]: guide(step.nodes[g], answer.nodes[:, column]) for column, g in enumerate(PRODUCT)
            }
            way = self._waist_path(self._crouching, guides[DofGroup.WAIST])
            if way.path.reached == self.path.horizon:
                guides |= self._following(way.path.keys)
            ways = self._under(way, guides)
            if len(ways.paths) == len(SEARCH_ORDER):
                break
            if step.spent:
                break
            failed, at = len(ways.paths), min(ways.reached, self.path.horizon - 1)
            column = PRODUCT.index(failed) if failed in PRODUCT else 0
            step.close(PRODUCT[column], at, answer.nodes[at : at + 2, column])
        return ways

    def blockade(self) -> Blockade:
        """Why there is no way."""
        return blockade(self.joint_step(), self.path, self.blocked[1], self.problem.near.numbers)

    def blocked_slice(self) -> BlockedSlice:
        """The slice that the first group to fail could not get through."""
        number, depth = self.blocked
        waist = self._waist
        assert waist is not None
        at, known = columns_of(SEARCH_ORDER[number]), self.caches.group(DofGroup.WAIST).postures.configurations
        costs = self._looked_at(waist).cost[depth, : len(known)]
        order = np.argsort(costs, kind="stable")
        waists = known[order[np.isfinite(costs[order])]]
        if depth < len(waist.path.keys):
            waists = np.concatenate([waist.path.keys[depth : depth + 1], waists])
        margin = float(self.problem.anew.margins[number, depth])
        return BlockedSlice(depth, self._surroundings(), self.goals[depth, at], margin, waists)

    def waist_at(self, depth: int) -> Floats:
        """The waist (d,) that was chosen for itself at a key time that it reached."""
        assert self._waist is not None
        key: Floats = self._waist.path.keys[depth]
        return key

    def _looked_at(self, waist: _WaistPath) -> GroupPath:
        """The waist's path with the costs of all its nodes, also of those that its search could do without."""
        looked_at = self.evidence_log.search(DofGroup.WAIST, waist.task._replace(whole=True), trunk=waist.trunk)
        return waist.path._replace(cost=looked_at.cost)

    def joint_step(self) -> JointStep:
        """The joint step of this path, nothing filled in yet."""
        assert self._waist is not None
        waist = self._looked_at(self._waist)
        caches, whole = self.caches, waist.reached == self.path.horizon
        problem = self.problem.under(waist.keys) if whole else self.problem
        task, children = problem.task(DofGroup.WAIST, problem.roots), []
        for group in CHILDREN:
            child_task, most = problem.task(group, waist.entries), np.inf
            if whole:
                most = self._room_at_start(group, child_task, waist)
            children.append(child_nodes(caches.group(group), child_task, self.weights.keeping, most))
        return JointStep(
            self.model.own_body,
            (waist_nodes(caches.group(DofGroup.WAIST), task, waist, self.weights.keeping), *children),
            self._surroundings(),
            JointSettings(self.weights.step, self.weights.near, self.weights.comfort),
        )

    def _surroundings(self) -> PathSurroundings:
        problem = self.problem
        return surroundings(self.path.states, self.caches.roots, problem.roots, problem.near.moments)

    def _waist_path(self, costs: Floats32, follow: Guide | None = None, *, trunk: bool = False) -> _WaistPath:
        """The way of the waist, or of the `trunk` as one limb, on which the legs have room to crouch as it does."""
        at, postures = columns_of(DofGroup.WAIST), self.caches.group(DofGroup.WAIST).postures
        previous, closed = self.problem.previous[:, at], costs.copy()
        if follow is not None:
            previous = follow.keys
            closed[:, closed.shape[1] - EXTRA + PREVIOUS] = 0.0

        def nodes() -> Floats:
            lanes = np.zeros((postures.moves.shape[1], DofGroup.WAIST.size))
            lanes[: len(postures.configurations)] = postures.configurations
            return node_waists(lanes, self.goals[:, at], previous, self.problem.begins.upper[at])

        def folds(keys: Floats, velocities: Floats) -> Bools:
            uppers, rates = self.goals.copy(), np.zeros_like(self.goals)
            uppers[:, at], rates[:, at] = keys, velocities
            begin = self.problem.begins.ahead
            return self.caches.own_trunk.contacts(self.path, uppers, rates, self.problem.walk, begin) >= 0

        crouch = Crouch(self.legs, self.path, nodes, folds, lambda: self._shown)
        for attempt in range(ROUNDS):
            way = self._search(closed, follow, trunk=trunk)
            path = way.path
            if path.reached < self.path.horizon or not crouch.rules_out(path.keys, path.velocities, closed):
                if follow is None and attempt > 0:
                    self._crouching[np.isinf(closed)] = np.inf
                return way
        return way._replace(path=path._replace(reached=0))

    def _room_at_start(self, group: DofGroup, task: GroupTask, waist: GroupPath) -> float:
        """The clearance that may be asked of a group, half of what it has at the start; all if that is proven."""
        if task.settled:
            return np.inf
        caches, root = self.caches, self.problem.roots[0]
        places, turns = caches.roots.places[root], caches.roots.turns[root]
        if group is not DofGroup.WAIST:
            carriers = caches.group(DofGroup.WAIST).sweeps
            places, turns = carriers.places[waist.entries[0]], carriers.turns[waist.entries[0]]
        postures, obstacles = caches.group(group).postures, span_of(self.problem.near.spans, 0)
        with caches.groups[group].scratch.taken(obstacles) as scratch:
            clearance, _ = held_clearance(scratch, postures, task.start, places, turns, obstacles, HELD_AT_START)
        return max(0.5 * clearance, 0.0)

    def _search(self, extra: Floats32, follow: Guide | None, *, trunk: bool) -> _WaistPath:
        """The waist's way with `extra` (n+1, W+OWN) added to the prices of its nodes."""
        task = self.problem.task(DofGroup.WAIST, self.problem.roots, extra.copy(), follow)
        return _WaistPath(self.evidence_log.search(DofGroup.WAIST, task, trunk=trunk), task, trunk)


class UpperPlan(NamedTuple):
    """A local plan and how far it got."""

    plan: LocalPlan
    reached: int  # n if found, else the deepest key time with a way for every group
    search: UpperBodySearch  # the last attempt, which can say why there is no way
    margins: RequiredMargins | None = None  # that it was found with; None unless found
