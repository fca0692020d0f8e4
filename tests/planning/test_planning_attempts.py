"""What one plan may cost is counted, and what is left over is for the next plan, if that wants the same."""

import numpy as np

from elbowroom.body.dof import LOCAL
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.exact.plan.attempts import Attempts, LeftOff
from elbowroom.planning.motion import MotionQuery

STILL = np.zeros(LOCAL)
QUERY = MotionQuery(0.0, RootState(), STILL, STILL, Command(forward=1.0), 5, 0.15)


def checks_until_spent(*, uneven: bool = False, hurry: bool = False, moving: bool = False) -> int:
    attempts, checks = Attempts(), 0
    attempts.begin(QUERY, hurry=hurry, stands=False, uneven=uneven, moving=moving)
    while not attempts.spent:
        attempts.enter_root(100)
        checks += 100
    return checks


def test_a_plan_is_spent_sooner_where_it_is_looked_up_what_feet_stand_on_and_in_a_hurry_later_among_what_moves() -> (
    None
):
    for moving in (False, True):
        usual = checks_until_spent(moving=moving)
        assert 5 * checks_until_spent(uneven=True, moving=moving) < usual
        assert checks_until_spent(hurry=True, moving=moving) < usual
    assert checks_until_spent(moving=True) > checks_until_spent()


def test_who_walks_and_wants_the_same_goes_on_where_the_plan_before_left_off() -> None:
    left_off, other = LeftOff(2, (0.0, 1.0)), QUERY._replace(command=Command(forward=0.5))
    for query, stands, hurry, moving, goes_on in (
        (QUERY, False, False, False, True),
        (other, False, False, False, False),
        (QUERY, True, False, False, False),
        (QUERY, False, True, False, False),
        (QUERY, False, False, True, False),
    ):
        attempts = Attempts()
        attempts.begin(QUERY, hurry=False, stands=False)
        attempts.left_off = left_off
        attempts.begin(query, hurry=hurry, stands=stands, moving=moving)
        assert (attempts.left_off == left_off) is goes_on
