"""The paths of the groups that hang on the waist, under its path: clear of the obstacles and of the body."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import CHILDREN, LOCAL, SEARCH_ORDER, DofGroup, columns_of, followers_of, side_by_side
from elbowroom.planning.exact.group.caches import PlanCaches
from elbowroom.planning.exact.group.own_contacts import OwnContact, rule_out_near
from elbowroom.planning.exact.group.path_problem import PathProblem
from elbowroom.planning.exact.group.problem import GroupPath, GroupTask, Guide, extras_of
from elbowroom.planning.exact.lattice.closed_edges import ClosedEdges
from elbowroom.planning.exact.lattice.lattice import EXTRA
from elbowroom.planning.exact.plan.evidence import EvidenceLog
from elbowroom.planning.exact.sweep.own_body_nodes import OwnBodyTask, own_body_costs

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_ALIKE = 0.15  # radians: postures that are ruled out with one that touches the body between key times, and
_MORE_ALIKE = 0.075  # so much farther about each that touches later
_NO_KEYS = np.zeros((0, LOCAL))


class GroupPaths(NamedTuple):
    """The paths of the groups, in the order of their search, as far as they were found; and the one that ended it."""

    paths: tuple[GroupPath, ...]
    failed: GroupPath | None
    reached: int  # the key time that all groups reached
    keys: Floats = _NO_KEYS  # (n+1, LOCAL) the upper body's key postures if none failed, and
    velocities: Floats = _NO_KEYS  # (n+1, LOCAL) its velocities there
    goals: Floats = _NO_KEYS  # (n+1, LOCAL) what was asked for under this waist

    @staticmethod
    def joined(paths: list[GroupPath], reached: int, goals: Floats) -> "GroupPaths":
        """The paths of all groups."""
        keys = side_by_side({group: path.keys for group, path in zip(SEARCH_ORDER, paths, strict=True)})
        velocities = side_by_side({group: path.velocities for group, path in zip(SEARCH_ORDER, paths, strict=True)})
        return GroupPaths(tuple(paths), None, reached, keys, velocities, goals)


class ChildSearch:
    """Searches the paths of the waist's children along one root path."""

    def __init__(self, caches: PlanCaches, problem: PathProblem, rounds: int) -> None:
        """At most `rounds` motions may turn out to run into the body."""
        self._caches, self._rounds = caches, rounds
        self._given = problem
        self._problem = problem  # with the goals under the waist's path
        self._contacts: list[OwnContact] = []  # of all motions along this path

    def followers(self, waist: GroupPath, guides: Mapping[DofGroup, Guide], evidence_log: EvidenceLog) -> GroupPaths:
        """The paths of those children that could follow the waist; they come first, and depend on no other child."""
        if waist.reached < self._given.path.horizon:
            return GroupPaths((), waist, waist.reached)
        self._take(waist)
        paths = [waist]
        failed = self._searched(followers_of(DofGroup.WAIST), paths, guides, evidence_log, {})
        return failed or GroupPaths(tuple(paths), None, self._given.path.horizon)

    def under(self, followers: GroupPaths, guides: Mapping[DofGroup, Guide], evidence_log: EvidenceLog) -> GroupPaths:
        """The children's paths under the waist's, those of its `followers` known; who has a guide follows it.

        A child that is searched again, since the motion ran into the body, knows which edges were closed before.
        """
        if followers.failed is not None:
            return followers
        closed: dict[DofGroup, ClosedEdges] = {}
        horizon, (waist, *_) = self._problem.path.horizon, followers.paths
        self._take(waist)
        paths, first, touching = list(followers.paths), len(followers.paths) - 1, 0
        for turn in range(self._rounds):
            del paths[1 + first :]
            if failed := self._searched(CHILDREN[first:], paths, guides, evidence_log, closed):
                return failed
            found = GroupPaths.joined(paths, horizon, self._problem.goals)
            contacts = self._self_contacts(found)
            if not contacts:
                return found
            touching, lowest = contacts[0][1], min(number for number, _ in contacts)
            if lowest == 0:
                return GroupPaths((), waist, touching)
            first = lowest - 1
            for number, interval in contacts:
                self._remember(paths, number, interval, _ALIKE + turn * _MORE_ALIKE)
        return GroupPaths(tuple(paths[:-1]), paths[-1], touching)

    def _take(self, waist: GroupPath) -> None:
        """Search under this path of the waist from now on."""
        self._problem = self._given.under(waist.keys)

    def _searched(
        self,
        groups: tuple[DofGroup, ...],
        paths: list[GroupPath],
        guides: Mapping[DofGroup, Guide],
        evidence_log: EvidenceLog,
        closed: dict[DofGroup, ClosedEdges],
    ) -> GroupPaths | None:
        """Add the paths of some groups to those of the groups before them; how far they led if one has none.

        Edges that were `closed` under this waist stay so, and those that are closed now are added.
        """
        for group in groups:
            task = self._task(group, paths, guides.get(group), whole=bool(self._contacts))
            path, closed[group] = evidence_log.search_again(group, task, closed.get(group))
            if path.reached < self._problem.path.horizon:
                return GroupPaths(tuple(paths), path, path.reached)
            paths.append(path)
        return None

    def _task(self, group: DofGroup, paths: list[GroupPath], follow: Guide | None, *, whole: bool) -> GroupTask:
        """What one group has to do among the groups before it; if `whole`, the body is where their paths have it."""
        whole = whole and bool(group.clear_of)
        resting = None if whole else self._resting(group)
        task = self._problem.task(group, paths[0].entries, resting, follow)
        if whole:
            costs = self._own_body_costs(group, paths, task)
            task = task._replace(added=costs if follow is None else costs + task.added)
        return task

    def _resting(self, group: DofGroup) -> Floats32:
        """Infinite where a node touches the naturally walking body, (n+1, W+EXTRA)."""
        resting = self._caches.own_nodes[group].resting
        costs = np.zeros((len(self._problem.goals), len(resting) + EXTRA), np.float32)
        costs[:, : len(resting)][:, resting] = np.inf
        return costs

    def _own_body_costs(self, group: DofGroup, paths: list[GroupPath], task: GroupTask) -> Floats32:
        """Infinite where a node touches the body as the groups before have it, or is near to one that did."""
        problem, made = self._problem, self._caches.group(group)
        around, walk = self._around(paths), np.zeros_like(problem.walk)
        for other, _ in zip(SEARCH_ORDER, paths, strict=False):
            walk[:, columns_of(other)] = problem.walk[:, columns_of(other)]
        usual, states = np.ascontiguousarray(problem.walk[:, columns_of(group)]), problem.path.states
        costs = own_body_costs(
            self._caches.own_nodes[group],
            OwnBodyTask(task.goals, task.previous, task.start, task.settled, usual, walk, around, states),
        )
        for contact in self._contacts:
            t = contact.depth
            if contact.group is group and contact.happens(around[t]):
                extras = extras_of(made, task).postures[t]
                rule_out_near(costs[t], made.postures.configurations, extras, contact.posture, contact.near)
        return costs

    def _around(self, paths: list[GroupPath]) -> Floats:
        """The upper body (n+1, LOCAL) of the groups that have a path, zero elsewhere."""
        around = np.zeros_like(self._problem.goals)
        for group, path in zip(SEARCH_ORDER, paths, strict=False):
            around[:, columns_of(group)] = path.keys
        return around

    def _remember(self, paths: list[GroupPath], number: int, interval: int, near: float) -> None:
        """Remember what a child did at both ends of an interval in which it ran into the body."""
        around = self._around(paths[:number])
        for t in range(max(interval, 1), interval + 2):
            posture = paths[number].keys[t].copy()
            self._contacts.append(OwnContact(SEARCH_ORDER[number], t, around[t], posture, near))

    def _self_contacts(self, found: GroupPaths) -> list[tuple[int, int]]:
        """The groups, by their number, and the intervals in which their motion runs into the body, in order."""
        problem, keys, rates = self._problem, found.keys, found.velocities
        groups = self._caches.own_motion.contacts(problem.path, keys, rates, problem.walk, problem.begins.ahead)
        return [(group, k) for k, group in enumerate(groups.tolist()) if group >= 0]
