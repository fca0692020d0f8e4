"""What the plan that was taken over last means for the next ones."""

import numpy as np

from elbowroom.body.dof import LOCAL
from elbowroom.control.plans.last_plan import LastPlan
from elbowroom.control.plans.wayfinder import Answer
from elbowroom.planning.command import Command
from elbowroom.planning.result import LocalPlan, PlanStatus
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan, RootPlanKind

PATH = RootPath(0.0, 0.25, np.zeros((5, 9)))


def _followed(kind: RootPlanKind, *, undecided: bool = False, before: LastPlan | None = None) -> LastPlan:
    root = RootPlan(PATH, kind, (0.0, 0.0), 0, 0, 0.0)
    answer = Answer(
        root,
        LocalPlan(PlanStatus.EXHAUSTED, np.empty((0, LOCAL)), np.empty((5, LOCAL)), ()),
        PATH,
        None,
        None,
        travel=0.5,
        undecided=undecided,
    )
    return (before or LastPlan()).followed_by(answer, root, Command(forward=1.0), 2.0)


def test_before_the_first_plan_nothing_is_wanted_and_nobody_stands_for_want_of_a_way() -> None:
    last = LastPlan()
    assert (last.number, last.command.idle, last.stops, last.is_new(0.0, 1.0)) == (0, True, False, False)


def test_plans_are_counted_and_are_new_for_an_interval() -> None:
    last = _followed(RootPlanKind.STRAIGHT, before=_followed(RootPlanKind.STRAIGHT))
    assert last.number == 2
    assert last.command == Command(forward=1.0)
    assert last.is_new(2.2, 0.25)
    assert not last.is_new(2.3, 0.25)


def test_who_may_climb_from_where_a_plan_stops_is_not_stopped_yet() -> None:
    assert _followed(RootPlanKind.STOPPED).stops
    assert not _followed(RootPlanKind.STOPPED, undecided=True).stops
    assert not _followed(RootPlanKind.SHORTENED).stops
