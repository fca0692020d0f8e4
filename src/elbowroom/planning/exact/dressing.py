"""One plan of the upper body along one root path: group after group, and all together where that fails.

The groups are searched in the order of the paper, each arm under the waist's way and clear of the body, the right arm
of the left one too. Where an arm has no way, the waist's last way is tried, under which the arms had theirs; then the
joint step decides.
"""

from dataclasses import dataclass
from time import perf_counter_ns
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, DofGroup, columns_of
from elbowroom.planning.exact.crouch import ROUNDS, Crouch, node_lowerings
from elbowroom.planning.exact.group import GroupTask, GroupWay, Weights, own_postures
from elbowroom.planning.exact.joint_step import JointSettings, JointStep
from elbowroom.planning.exact.kept import Asked, Kept
from elbowroom.planning.exact.lattice import KEPT, OWN
from elbowroom.planning.exact.ledger import Ledger
from elbowroom.planning.exact.near_boxes import NearBoxes
from elbowroom.planning.exact.own_body import OwnBody
from elbowroom.planning.exact.reaching import Blocked
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.shelves import Shelves
from elbowroom.planning.exact.tables import HELD_AT_START, held_clearance
from elbowroom.planning.exact.together import Guide, arm_nodes, guide, surroundings, waist_nodes
from elbowroom.planning.exact.why_not import blockade
from elbowroom.planning.lowered_legs import LoweredLegs
from elbowroom.planning.result import Blockade, LocalPlan, PlanStatus
from elbowroom.planning.root_path import RootPath

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Longs = NDArray[np.int64]

_DEARER = np.float32(0.5)  # squared radians: what leaving the last plan's way costs the waist that is held to it
_NATURAL = 1e-6  # radians from the goal
_ALERT = 16  # plans after one that ran into the body that look at it from the beginning
_JOLT = 0.5  # squared radians that another motion must be better than one under the last plan's waist
_ALIKE = 0.15  # radians: postures that are ruled out with one that touches the body on its way


class Ways(NamedTuple):
    """The ways of the groups, in order, as far as they were found; and the one that ended it."""

    ways: tuple[GroupWay, ...]
    failed: GroupWay | None
    asked: Asked | None = None  # what clearances were asked for; None if a group failed


@dataclass(eq=False)
class Dressing:
    """One root path to be dressed."""

    shelves: Shelves
    weights: Weights
    settings: ExactSettings
    own_body: OwnBody
    legs: LoweredLegs
    path: RootPath
    goals: Floats  # (n+1, 10)
    last: Kept | None  # the last plan
    start: Floats  # (10,)
    velocity: Floats  # (10,)
    roots: Longs  # (n,)
    near: NearBoxes
    margins: Floats  # (n+1,)
    skins: Floats  # (n,)

    def __post_init__(self) -> None:
        self.kept = self.goals if self.last is None else self.last.keys  # (n+1, 11)
        self.asked: Asked | None = None  # of the way that was found
        self.ledger = Ledger(self.shelves, self.weights)
        self.deepest = 0  # key time that all groups reached in the best attempt
        self.blocked = 0, 0  # the group, as a number, that failed first, and the key time that it did not reach
        self._waist: GroupWay | None = None
        self._crouching = self._none(DofGroup.WAIST)  # infinite where the legs have no room to crouch as a node does

    def motion(self, rounds: int) -> LocalPlan | None:
        """The motion, if there is one: group after group, then in so many rounds of the joint step.

        One that would jolt what was planned gives way to one under the last plan's waist that costs no more, or hardly.
        """
        found = self.apart()
        if self.last is not None and (found.failed is not None or self._jolts(found)):
            kept = self.with_kept_waist()
            if found.failed is not None or (kept.failed is None and self._cost(kept) <= self._cost(found) + _JOLT):
                found = kept
        if found.failed is not None and rounds > 0:
            found = self.together(rounds)
        if found.failed is not None:
            return None
        self.asked = found.asked
        keys = np.concatenate([way.keys for way in found.ways], axis=1)
        velocities = np.concatenate([way.velocities for way in found.ways], axis=1)
        return LocalPlan(
            PlanStatus.FOUND, keys, self.goals, self.ledger.evidence(), velocities=velocities, joint=self.ledger.joint
        )

    def _jolts(self, found: Ways) -> bool:
        """Whether the waist has left the last plan's way, and some joint by more than a little."""
        assert self.last is not None
        known = min(self.last.known, len(self.kept))
        away = [
            way.keys[:known] - self.kept[:known, columns_of(g)] for way, g in zip(found.ways, LOCAL_GROUPS, strict=True)
        ]
        return bool(np.any(away[0])) and max(float(np.abs(one).max()) for one in away) > _ALIKE

    def _cost(self, found: Ways) -> float:
        """What ways cost that are free: distance from the goals and its changes, squared radians."""
        away = np.concatenate([way.keys for way in found.ways], axis=1) - self.goals
        return float(np.sum(away**2) + self.weights.step * np.sum(np.diff(away, axis=0) ** 2))

    def apart(self) -> Ways:
        """Each group by itself."""
        self.own_body.alert = max(self.own_body.alert - 1, 0)
        self._waist = self._waist_way(self._crouching)
        found = self._arms(self._waist, None)
        self.blocked = len(found.ways), min(self.last_reached + 1, self.path.horizon)
        return found

    def with_kept_waist(self) -> Ways:
        """The waist held to the last plan's way while there is one."""
        prices = np.full_like(self._crouching, _DEARER)
        task = self._task(DofGroup.WAIST, self.roots, None, None)
        _, _, kept = own_postures(self.shelves.groups[DofGroup.WAIST], task)
        prices[np.arange(len(prices)), kept] = 0.0
        return self._arms(self._waist_way(prices + self._crouching), None)

    def together(self, rounds: int) -> Ways:
        """All groups at once, guided by the joint step; at most so many of its answers may turn out to touch."""
        waist = self._waist
        assert waist is not None
        if waist.reached < self.path.horizon:
            return Ways((), waist)
        step = self.joint_step(waist)
        ways = Ways((), waist)
        for _ in range(rounds):
            began = perf_counter_ns()
            answer = step.search()
            self.ledger.enter_joint(step, answer.status, perf_counter_ns() - began)
            if answer.status is not PlanStatus.FOUND:
                break
            guides = [guide(nodes, answer.nodes[:, g]) for g, nodes in enumerate(step.nodes)]
            ways = self._arms(self._waist_way(self._crouching, guides[0]), guides)
            if len(ways.ways) == len(LOCAL_GROUPS):
                break
            failed, at = len(ways.ways), min(self.last_reached, self.path.horizon - 1)
            step.close(failed, at, answer.nodes[at : at + 2, failed])
        return ways

    def blockade(self) -> Blockade:
        """Why there is no way."""
        assert self._waist is not None
        return blockade(self.joint_step(self._waist), self.path, self.blocked[1], self.near.rows)

    def blocked_slice(self) -> Blocked:
        """The slice that the first group to fail could not get through."""
        number, depth = self.blocked
        waist = self._waist
        assert waist is not None
        at, known = columns_of(LOCAL_GROUPS[number]), self.shelves.groups[DofGroup.WAIST].postures.configurations
        prices = waist.price[depth, : len(known)]
        order = np.argsort(prices, kind="stable")
        waists = known[order[np.isfinite(prices[order])]]
        if depth < len(waist.keys):
            waists = np.concatenate([waist.keys[depth : depth + 1], waists])
        around = surroundings(self.path.states, self.shelves.roots, self.roots, self.near.slices)
        return Blocked(depth, around, self.goals[depth, at], float(self.margins[depth]), waists)

    def waist_at(self, depth: int) -> Floats:
        """The waist (d,) that was chosen for itself at a key time that it reached."""
        assert self._waist is not None
        key: Floats = self._waist.keys[depth]
        return key

    def joint_step(self, waist: GroupWay) -> JointStep:
        """The joint step of this path, nothing filled in yet."""
        groups, task = self.shelves.groups, self._task(DofGroup.WAIST, self.roots, None, None)
        arms = []
        for group in LOCAL_GROUPS[1:]:
            arm_task, most = self._task(group, waist.slots, None, None), np.inf
            if waist.reached == self.path.horizon:
                most = self._room_at_start(group, arm_task, waist)
            arms.append(arm_nodes(groups[group], arm_task, self.weights.keeping, most))
        return JointStep(
            self.own_body,
            waist_nodes(groups[DofGroup.WAIST], task, waist, self.weights.keeping),
            (arms[0], arms[1]),
            surroundings(self.path.states, self.shelves.roots, self.roots, self.near.slices),
            JointSettings(self.weights.step, self.weights.near, self.weights.comfort),
        )

    def _waist_way(self, prices: Floats32, follow: Guide | None = None) -> GroupWay:
        """The waist's way on which the legs have room to crouch as it does."""
        at, postures = columns_of(DofGroup.WAIST), self.shelves.groups[DofGroup.WAIST].postures
        kept, closed = self.kept[:, at], prices.copy()
        if follow is not None:
            kept = follow.keys
            closed[:, closed.shape[1] - OWN + KEPT] = 0.0
        lanes = np.zeros((postures.moves.shape[1], DofGroup.WAIST.size))
        lanes[: len(postures.configurations)] = postures.configurations
        crouch = Crouch(self.legs, self.path, node_lowerings(lanes, self.goals[:, at], kept, self.start[at]))
        for _ in range(ROUNDS):
            way = self._search(DofGroup.WAIST, self.roots, closed, follow)
            if way.reached < self.path.horizon or not crouch.rules_out(way.keys, way.velocities, closed):
                if follow is None:
                    self._crouching[np.isinf(closed)] = np.inf
                return way
        return way._replace(reached=0)

    def _arms(self, waist: GroupWay, guides: list[Guide] | None) -> Ways:
        """The arms under the waist's way."""
        self.last_reached = waist.reached
        if waist.reached < self.path.horizon:
            self.deepest = max(self.deepest, waist.reached)
            return Ways((), waist)
        ways, touched = [waist], [self._none(group) for group in LOCAL_GROUPS[1:]]
        whole = self.own_body.alert > 0
        for attempt in range(self.settings.self_rounds):
            ways = [waist]
            for side, group in enumerate(LOCAL_GROUPS[1:]):
                follow = None if guides is None else guides[1 + side]
                extra = self._folded(side, ways, follow, whole=whole or attempt > 0) + touched[side]
                way = self._search(group, waist.slots, extra, follow)
                self.last_reached = way.reached
                if way.reached < self.path.horizon:
                    self.deepest = max(self.deepest, way.reached)
                    return Ways(tuple(ways), way)
                ways.append(way)
            contact = self._self_contact(ways)
            if contact is None:
                return Ways(tuple(ways), None, self._asked(waist))
            self.own_body.alert = _ALERT
            self._rule_out(touched, ways, *contact)
            self.last_reached = contact[1]
        self.deepest = max(self.deepest, self.last_reached)
        return Ways(tuple(ways[:-1]), ways[-1])

    def _asked(self, waist: GroupWay) -> Asked:
        """The clearances that were asked for along the waist's way: less where the start has less."""
        asked = Asked(np.empty((3, len(self.margins))), np.empty((3, len(self.skins))))
        for number, group in enumerate(LOCAL_GROUPS):
            task = self._task(group, waist.slots, None, None)
            most = self._room_at_start(group, task, waist)
            asked.margins[number] = np.minimum(task.margins, most)
            asked.skins[number] = np.minimum(task.skins, most)
        return asked

    def _room_at_start(self, group: DofGroup, task: GroupTask, waist: GroupWay) -> float:
        """The clearance that may be asked of a group, half of what it has at the start."""
        shelves = self.shelves
        places, turns = shelves.roots.places[self.roots[0]], shelves.roots.turns[self.roots[0]]
        if group is not DofGroup.WAIST:
            carriers = shelves.groups[DofGroup.WAIST].ways
            places, turns = carriers.places[waist.slots[0]], carriers.turns[waist.slots[0]]
        postures, boxes = shelves.groups[group].postures, self.near.intervals[0]
        clearance, _ = held_clearance(postures, task.start, places, turns, boxes, HELD_AT_START)
        return max(0.5 * clearance, 0.0)

    def _rule_out(self, touched: list[Floats32], ways: list[GroupWay], side: int, interval: int) -> None:
        """Rule out the postures at the ends of an interval in which an arm runs into the body, and those like them."""
        way, group = ways[1 + side], self.shelves.groups[LOCAL_GROUPS[1 + side]]
        width = group.postures.moves.shape[1]
        own, _, _ = own_postures(group, self._task(LOCAL_GROUPS[1 + side], ways[0].slots, None, None))
        for t in range(max(interval, 1), interval + 2):
            nodes = np.concatenate([group.postures.configurations, own[t]])
            near = np.linalg.norm(nodes - way.keys[t], axis=1) < _ALIKE
            size = len(group.postures.configurations)
            touched[side][t, np.flatnonzero(near[:size])] = np.inf
            touched[side][t, width + np.flatnonzero(near[size:])] = np.inf

    def _folded(self, side: int, ways: list[GroupWay], follow: Guide | None, *, whole: bool) -> Floats32:
        """Infinite where a node of an arm touches the naturally walking body; if `whole`, the body on its ways."""
        group = LOCAL_GROUPS[1 + side]
        if not whole:
            return self.own_body.resting_prices(side, self.shelves.groups[group].postures, len(self.goals))
        own, _, _ = own_postures(self.shelves.groups[group], self._task(group, ways[0].slots, None, follow))
        waists = ways[0].keys
        natural = np.abs(waists - self.goals[:, columns_of(DofGroup.WAIST)]).max(axis=1) < _NATURAL
        other = None
        if side == 1:
            other = ways[1].keys
            natural &= np.abs(other - self.goals[:, columns_of(LOCAL_GROUPS[1])]).max(axis=1) < _NATURAL
        postures = self.shelves.groups[group].postures
        folded = self.own_body.folded_nodes(side, postures, own, natural, waists, self.path.states, other)
        return np.where(folded, np.float32(np.inf), np.float32(0.0))

    def _self_contact(self, ways: list[GroupWay]) -> tuple[int, int] | None:
        """The arm and the first interval in which the shown motion runs into the body, or None."""
        keys = np.concatenate([way.keys for way in ways], axis=1)
        natural = np.abs(keys - self.goals).max(axis=1) < _NATURAL
        if natural.all():
            return None
        rates = np.concatenate([way.velocities for way in ways], axis=1)
        arms = self.own_body.contacts(self.path, keys, rates, ~(natural[:-1] & natural[1:]))
        touching = np.flatnonzero(arms >= 0)
        return None if not len(touching) else (int(arms[touching[0]]), int(touching[0]))

    def _none(self, group: DofGroup) -> Floats32:
        return np.zeros((len(self.goals), self.shelves.groups[group].postures.moves.shape[1] + OWN), np.float32)

    def _task(self, group: DofGroup, carriers: Longs, extra: Floats32 | None, follow: Guide | None) -> GroupTask:
        at = columns_of(group)
        kept = self.kept[:, at] if follow is None else follow.keys
        margins, skins = self.margins, self.skins
        if self.last is not None:
            number = LOCAL_GROUPS.index(group)
            margins = np.minimum(margins, self.last.asked.margins[number])
            skins = np.minimum(skins, self.last.asked.skins[number])
        return GroupTask(
            np.ascontiguousarray(self.goals[:, at]), np.ascontiguousarray(kept), self.start[at], self.velocity[at],
            margins, skins, self._none(group) if extra is None else extra, self.roots, carriers,
            self.near.intervals, self.path.interval,
        )  # fmt: skip

    def _search(
        self, group: DofGroup, carriers: Longs, extra: Floats32 | None = None, follow: Guide | None = None
    ) -> GroupWay:
        prices = extra if follow is None else follow.extra + (0.0 if extra is None else extra)
        return self.ledger.search(group, self._task(group, carriers, prices, follow))
