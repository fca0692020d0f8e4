"""What one plan may cost is counted: where the ground is uneven a place of the root costs more, so fewer are tried."""

import numpy as np

from elbowroom.body.dof import LOCAL
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.exact.plan.attempts import Attempts
from elbowroom.planning.motion import MotionQuery

STILL = np.zeros(LOCAL)
QUERY = MotionQuery(0.0, RootState(), STILL, STILL, Command(forward=1.0), 5, 0.15)


def checks_until_spent(*, stands: bool, uneven: bool) -> int:
    attempts, checks = Attempts(), 0
    attempts.begin(QUERY, hurry=False, stands=stands, uneven=uneven)
    while not attempts.spent:
        attempts.enter_root(100)
        checks += 100
    return checks


def test_a_plan_is_spent_sooner_where_it_is_looked_up_what_feet_stand_on() -> None:
    for stands in (False, True):
        assert 5 * checks_until_spent(stands=stands, uneven=True) < checks_until_spent(stands=stands, uneven=False)
    assert checks_until_spent(stands=True, uneven=True) > checks_until_spent(stands=False, uneven=True)
