"""What the searches of one plan cost, group by group."""

from collections.abc import Iterable
from time import perf_counter_ns

from elbowroom.body.dof import DofGroup
from elbowroom.planning.exact.group.caches import PlanCaches, Searched
from elbowroom.planning.exact.group.problem import GroupPath, GroupTask, Weights
from elbowroom.planning.exact.group.search import search_group
from elbowroom.planning.exact.joint.step import JointStep
from elbowroom.planning.exact.lattice.closed_edges import ClosedEdges, new_closed_edges
from elbowroom.planning.exact.lattice.lattice import EXTRA
from elbowroom.planning.motion import GoOn
from elbowroom.planning.result import GroupEvidence, JointEvidence, PlanStatus
from elbowroom.world.obstacles.rows import span_of


class EvidenceLog:
    """Searches one group after the other and keeps what each group's searches cost together."""

    def __init__(self, caches: PlanCaches, weights: Weights, go_on: GoOn) -> None:
        """`go_on` is called before each search, and raises an exception to call the plan off."""
        self._caches, self._weights, self.go_on = caches, weights, go_on
        self._rows: list[GroupEvidence] = []
        self._joint_before: JointEvidence | None = None
        self.joint: JointEvidence | None = None

    def begin_after(self, earlier: "EvidenceLog") -> None:
        """Keep what earlier searches of the same path cost too."""
        self._rows = list(earlier._rows)
        self.joint = self._joint_before = earlier.joint

    def search(self, group: DofGroup, task: GroupTask, *, trunk: bool = False) -> GroupPath:
        """`search_group` with all edges open, entered under `group`; of the whole trunk, if told so, as one limb."""
        searched = self._caches.trunk.searched if trunk else self._caches.groups[group]
        return self._searched(group, searched, task, None)[0]

    def search_again(
        self, group: DofGroup, task: GroupTask, closed: ClosedEdges | None
    ) -> tuple[GroupPath, ClosedEdges]:
        """The same with the edges that were `closed` before, under the same carrier for the same goals; and those that
        are now.
        """
        return self._searched(group, self._caches.groups[group], task, closed)

    def _searched(
        self, group: DofGroup, searched: Searched, task: GroupTask, closed: ClosedEdges | None
    ) -> tuple[GroupPath, ClosedEdges]:
        self.go_on()
        began, horizon, (cache, scratch) = perf_counter_ns(), len(task.goals) - 1, searched
        edges = closed or new_closed_edges(horizon, cache.group.postures.moves.shape[1] + EXTRA)
        with scratch.taken(span_of(task.obstacles, 0)) as room:
            path, edges = search_group(room, cache, task, self._weights, edges)
        spent = perf_counter_ns() - began
        status = PlanStatus.FOUND if path.reached == horizon else PlanStatus.EXHAUSTED
        self._rows.append(GroupEvidence(group, status, path.checks, path.nodes, 0, spent))
        return path, edges

    def enter_joint(self, step: JointStep, status: PlanStatus, nanoseconds: int) -> None:
        """What the joint step of this search cost until now."""
        states, checks, spent = step.states, step.checks, nanoseconds
        if self._joint_before is not None:
            states, checks = states + self._joint_before.states, checks + self._joint_before.checks
        if self.joint is not None:
            spent += self.joint.nanoseconds
        self.joint = JointEvidence(status, states, checks, spent)

    def evidence(self) -> tuple[GroupEvidence, ...]:
        """A row for each group that was searched, in order."""
        return by_group(self._rows)


def by_group(rows: Iterable[GroupEvidence]) -> tuple[GroupEvidence, ...]:
    """What searches cost, those of one group together, which ended as the last of them."""
    found: dict[DofGroup, GroupEvidence] = {}
    for row in rows:
        old = found.get(row.group)
        found[row.group] = row if old is None else _both(old, row)
    return tuple(found.values())


def _both(one: GroupEvidence, then: GroupEvidence) -> GroupEvidence:
    checks, nodes, enhanced = one.checks + then.checks, one.nodes + then.nodes, one.enhanced + then.enhanced
    return GroupEvidence(then.group, then.status, checks, nodes, enhanced, one.nanoseconds + then.nanoseconds)
