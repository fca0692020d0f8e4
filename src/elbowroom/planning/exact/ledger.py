"""What the searches of one plan cost, group by group."""

from collections.abc import Callable
from time import perf_counter_ns

from elbowroom.body.dof import DofGroup
from elbowroom.planning.exact.group import GroupTask, GroupWay, Weights
from elbowroom.planning.exact.group_search import search_group
from elbowroom.planning.exact.joint_step import JointStep
from elbowroom.planning.exact.shelves import Shelves
from elbowroom.planning.exact.ways import LimbWays
from elbowroom.planning.result import GroupEvidence, JointEvidence, PlanStatus

GoOn = Callable[[], None]


class Ledger:
    """Searches one group after the other and keeps what each group's searches cost together."""

    def __init__(self, shelves: Shelves, weights: Weights, go_on: GoOn) -> None:
        """`go_on` is called before each search, and raises an exception if it is of no use any more."""
        self._shelves, self._weights, self._go_on = shelves, weights, go_on
        self._rows: dict[DofGroup, GroupEvidence] = {}
        self.joint: JointEvidence | None = None

    def search(self, group: DofGroup, task: GroupTask) -> GroupWay:
        """`search_group`, entered under `group`."""
        self._go_on()
        began = perf_counter_ns()
        shelves = self._shelves
        waists: LimbWays = shelves.groups[DofGroup.WAIST].ways
        way: GroupWay = search_group(
            shelves.groups[group], shelves.roots, waists, shelves.chain, task, self._weights, shelves.works[group]
        )
        spent = perf_counter_ns() - began
        status = PlanStatus.FOUND if way.reached == len(task.goals) - 1 else PlanStatus.EXHAUSTED
        old = self._rows.get(group, GroupEvidence(group, status, 0, 0, 0, 0))
        checks, nodes, nanoseconds = old.checks + way.checks, old.nodes + way.nodes, old.nanoseconds + spent
        self._rows[group] = GroupEvidence(group, status, checks, nodes, 0, nanoseconds)
        return way

    def enter_joint(self, step: JointStep, status: PlanStatus, nanoseconds: int) -> None:
        """What the joint step cost until now."""
        before = 0 if self.joint is None else self.joint.nanoseconds
        self.joint = JointEvidence(status, step.states, step.checks, before + nanoseconds)

    def evidence(self) -> tuple[GroupEvidence, ...]:
        """A row for each group that was searched, in order."""
        return tuple(self._rows.values())
