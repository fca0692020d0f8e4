"""How much plans change: a plan that is continued does not change at all."""

from dataclasses import dataclass

import numpy as np
import pytest

from elbowroom.experiment.replans import Replans, plan_change
from elbowroom.planning.command import Command
from elbowroom.planning.root.path import RootPath

WALK = Command(forward=1.0)


@dataclass
class MadeUp:
    """As much of a plan's report as is looked at."""

    start: float
    configurations: np.ndarray
    command: Command = WALK
    found: bool = True

    @property
    def root(self) -> "MadeUp":
        return self

    @property
    def local(self) -> "MadeUp":
        return self

    @property
    def path(self) -> RootPath:
        return RootPath(self.start, 0.25, np.zeros((len(self.configurations), 7)))


def test_a_plan_that_goes_on_as_before_has_not_changed() -> None:
    keys = np.random.default_rng(0).normal(size=(9, 11))
    assert plan_change(MadeUp(0.0, keys[:7]), MadeUp(0.5, keys[2:])) == 0.0  # type: ignore[arg-type]


def test_the_largest_difference_counts_where_both_plans_know_something() -> None:
    keys = np.zeros((7, 11))
    other = keys.copy()
    other[2, 5], other[6, 3] = -0.3, 9.0
    assert plan_change(MadeUp(0.0, keys), MadeUp(0.5, other)) == pytest.approx(0.3)  # type: ignore[arg-type]
    assert plan_change(MadeUp(0.0, keys), MadeUp(5.0, other)) == 0.0  # type: ignore[arg-type]


def test_a_new_command_is_no_jitter() -> None:
    replans = Replans()
    still, moved = np.zeros((5, 11)), np.ones((5, 11))
    for plan in (MadeUp(0.0, still), MadeUp(0.25, moved, Command()), MadeUp(0.5, still, Command())):
        replans.enter(plan)  # type: ignore[arg-type]
    assert replans.changes.tolist() == [1.0]
