"""The plan that was taken over last, and what it means for those that come after it."""

from dataclasses import dataclass

from elbowroom.control.frame import PlanReport
from elbowroom.control.plans.wayfinder import Answer
from elbowroom.planning.command import Command
from elbowroom.planning.root.plan import RootPlan, RootPlanKind

_NOTHING = Command()


@dataclass(frozen=True)
class LastPlan:
    """The plan that was taken over last; before the first one, none, made for a command that wants nothing."""

    report: PlanReport | None = None
    travel: float | None = None  # radians, the heading that it means to travel; None where that is nowhere
    undecided: bool = False  # it leads to a stand from where one may climb: that is looked at there

    def followed_by(self, answer: Answer, root: RootPlan, command: Command, time: float) -> "LastPlan":
        """The next one: an answer for a command, taken over at a `time`, in seconds, along the path `root`."""
        report = PlanReport(self.number + 1, time, command, root, answer.local)
        return LastPlan(report, answer.travel, answer.undecided)

    @property
    def number(self) -> int:
        """How many plans there have been; 0 before the first."""
        return 0 if self.report is None else self.report.number

    @property
    def command(self) -> Command:
        """What it was made for."""
        return _NOTHING if self.report is None else self.report.command

    @property
    def stops(self) -> bool:
        """Whether it leads to a stand because there is no way on, climbing included."""
        return self.report is not None and self.report.root.kind is RootPlanKind.STOPPED and not self.undecided

    def is_new(self, now: float, interval: float) -> bool:
        """Whether it was taken over less than an `interval` ago, in seconds."""
        return self.report is not None and now - self.report.time < interval
