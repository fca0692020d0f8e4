"""The ways of the arms under the waist's: clear of the obstacles, of the body, and the right arm of the left one."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS
from elbowroom.planning.exact.group.caches import PlanCaches
from elbowroom.planning.exact.group.own_contacts import Contact, rule_out_near
from elbowroom.planning.exact.group.path_problem import PathProblem
from elbowroom.planning.exact.group.problem import GroupPath, GroupTask, extra_postures
from elbowroom.planning.exact.joint.guide import Guide
from elbowroom.planning.exact.lattice.lattice import EXTRA
from elbowroom.planning.exact.plan.evidence import EvidenceLog
from elbowroom.planning.exact.sweep.own_body_nodes import own_body_costs

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_ALIKE = 0.15  # radians: postures that are ruled out with one that touches the body on its way
_ARMS = LOCAL_GROUPS[1:]
_NO_KEYS = np.zeros((0, LOCAL))


class Ways(NamedTuple):
    """The ways of the groups, in order, as far as they were found; and the one that ended it."""

    ways: tuple[GroupPath, ...]
    failed: GroupPath | None
    reached: int  # the key time that all groups reached
    keys: Floats = _NO_KEYS  # the key postures of the groups side by side, (n+1, 11) if none failed, and
    velocities: Floats = _NO_KEYS  # the velocities there

    @staticmethod
    def joined(ways: list[GroupPath], reached: int) -> "Ways":
        """The ways of all groups."""
        keys = np.concatenate([way.keys for way in ways], axis=1)
        velocities = np.concatenate([way.velocities for way in ways], axis=1)
        return Ways(tuple(ways), None, reached, keys, velocities)


class Arms:
    """Searches the arms' ways along one root path."""

    def __init__(
        self,
        caches: PlanCaches,
        problem: PathProblem,
        rounds: int,
    ) -> None:
        """At most `rounds` motions may turn out to run into the body."""
        self._caches, self._problem, self._rounds = caches, problem, rounds
        self._contacts: list[Contact] = []  # of all motions along this path

    def under(self, waist: GroupPath, guides: list[Guide] | None, evidence_log: EvidenceLog) -> Ways:
        """The arms' ways under the waist's, following `guides` of all groups, if there are any."""
        horizon = self._problem.path.horizon
        if waist.reached < horizon:
            return Ways((), waist, waist.reached)
        ways, first, whole, touching = [waist], 0, bool(self._contacts), 0
        for _ in range(self._rounds):
            del ways[1 + first :]
            for side in range(first, len(_ARMS)):
                way = self._way(side, ways, None if guides is None else guides[1 + side], evidence_log, whole=whole)
                if way.reached < horizon:
                    return Ways(tuple(ways), way, way.reached)
                ways.append(way)
            found = Ways.joined(ways, horizon)
            contact = self._self_contact(found)
            if contact is None:
                return found
            first, touching, whole = *contact, True
            self._remember(ways, *contact)
        return Ways(tuple(ways[:-1]), ways[-1], touching)

    def _way(
        self, side: int, ways: list[GroupPath], follow: Guide | None, evidence_log: EvidenceLog, *, whole: bool
    ) -> GroupPath:
        """The way of one arm among the ways of the groups before it; if `whole`, the body is where these have it."""
        task = self._problem.task(_ARMS[side], ways[0].entries, None if whole else self._resting(side), follow)
        if whole:
            touches_body = self._folded(side, ways, task)
            task = task._replace(extra=touches_body if follow is None else touches_body + task.extra)
        return evidence_log.search(_ARMS[side], task)

    def _resting(self, side: int) -> Floats32:
        """Infinite where a node (n+1, W+OWN) touches the naturally walking body."""
        resting = self._caches.own_nodes[_ARMS[side]].resting
        costs = np.zeros((len(self._problem.goals), len(resting) + EXTRA), np.float32)
        costs[:, : len(resting)][:, resting] = np.inf
        return costs

    def _folded(self, side: int, ways: list[GroupPath], task: GroupTask) -> Floats32:
        """Infinite where a node touches the body on its ways, or is near to one that did."""
        problem, made = self._problem, self._caches.group(_ARMS[side])
        around = np.concatenate([way.keys for way in ways[: 1 + side]], axis=1)
        costs = own_body_costs(
            self._caches.own_nodes[_ARMS[side]],
            task.goals,
            task.previous,
            task.start,
            task.settled,
            problem.goals,
            around,
            problem.path.states,
        )
        for contact in self._contacts:
            if contact.side == side and contact.happens(around[contact.depth]):
                own, _, _ = extra_postures(made, task)
                t = contact.depth
                rule_out_near(costs[t], made.postures.configurations, own[t], contact.posture, _ALIKE)
        return costs

    def _remember(self, ways: list[GroupPath], side: int, interval: int) -> None:
        """Remember what an arm did at both ends of an interval in which it ran into the body."""
        for t in range(max(interval, 1), interval + 2):
            around = np.concatenate([way.keys[t] for way in ways[: 1 + side]])
            self._contacts.append(Contact(side, t, around, ways[1 + side].keys[t].copy()))

    def _self_contact(self, found: Ways) -> tuple[int, int] | None:
        """The arm and the first interval in which the shown motion runs into the body, or None."""
        problem, keys, rates = self._problem, found.keys, found.velocities
        arms = self._caches.own_motion.contacts(problem.path, keys, rates, problem.goals, problem.begins.ahead)
        return next(((arm, k) for k, arm in enumerate(arms.tolist()) if arm >= 0), None)
