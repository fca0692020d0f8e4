"""Hips, chest and head that live: as much as published at each speed, without a jump, on feet that stay."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.gait.carriage import ASIDE, CHEST_BEND, CHEST_TURN, HEAD_TURN, LIST, POSING, TURN
from elbowroom.body.gait.footholds import UNKNOWN
from elbowroom.body.gait.living import SHARE, lively, living
from elbowroom.body.pose.kinematics import body_model, hips_position, posture_capsules
from elbowroom.body.root import CARRIAGE, WITH_FEET
from feet_walks import BODY, DT, WANTED, Velocities, alive, path, random_wish, walked

Floats = NDArray[np.float64]

HUMANOID = proportional_humanoid()
MODEL = body_model(HUMANOID)
FEET = [i for i, name in enumerate(HUMANOID.capsules.names) if "oot" in name or "toe" in name.lower()]
EVERY = [*WANTED.values(), *(random_wish(seed) for seed in range(4))]
QUICKEST = np.array([0.6, 0.4, 0.5, 2.4, 2.0, 2.4, 0.8, 0.7, 4.1, 0.5])  # m/s, rad/s


def at(speed: float) -> Callable[[float], Velocities]:
    return lambda _: (speed, 0.0, 0.0)


def carried(rows: Floats) -> Floats:
    return rows[:, WITH_FEET : WITH_FEET + POSING]


@pytest.mark.parametrize("speed", [0.5, 0.8, 1.1, 1.4, 2.0])
def test_amounts_are_those_of_people_at_that_speed(speed: float) -> None:
    """Whole ranges of a stride: 3 to 7 cm aside, 4 to 14 degrees turned, 3 to 11 degrees of list."""
    steady = alive(walked(path(at(speed))))[150:]
    aside, turn, raised = (np.ptp(steady[:, column]) for column in (ASIDE, TURN, LIST))
    assert 0.025 < aside < 0.07
    assert 4.0 < np.degrees(turn) < 14.0
    assert 3.0 < np.degrees(raised) < 11.0
    assert np.corrcoef(steady[:, TURN], steady[:, CHEST_TURN])[0, 1] < -0.9


def test_hips_are_over_the_foot_that_stands_alone() -> None:
    """And forward on the side of the foot that has just come down, and high on that of the one that stands."""
    rows = alive(walked(path(at(1.1))))[150:]
    phase = rows[:, 6] % 1.0
    left_alone = (phase > 0.15) & (phase < 0.45)
    assert (rows[left_alone, ASIDE] > 0.0).all()
    assert rows[np.abs(phase - 0.5) > 0.48, TURN].max() < 0.0
    assert (rows[(phase > 0.05) & (phase < 0.25), LIST] > 0.0).all()


@pytest.mark.parametrize("wanted", EVERY)
def test_nothing_jumps(wanted: Callable[[float], Velocities]) -> None:
    rows = alive(walked(path(wanted)), lambda k: 0.3 if (k // 40) % 3 else 0.0)
    assert (np.abs(np.diff(carried(rows), axis=0)).max(axis=0) <= DT * QUICKEST).all()


@pytest.mark.parametrize("speed", [0.6, 1.1, 1.6])
def test_feet_stay_where_they_are(speed: float) -> None:
    rows = alive(walked(path(at(speed))))[60:]
    q = np.zeros((len(rows), DOF))
    with_life, without = (posture_capsules(MODEL, q, roots)[FEET] for roots in (rows, rows[:, :WITH_FEET]))
    assert np.abs(with_life - without).max() < 0.012  # a leg that is nearly straight gives a little
    assert np.median(np.abs(with_life - without).max(axis=(0, 1))) < 1e-4


def test_hips_go_where_they_are_carried_and_legs_reach_the_ground() -> None:
    row = np.concatenate([walked(path(at(1.1)))[200], np.zeros(CARRIAGE)])
    planned = hips_position(MODEL, np.zeros(DOF), row)
    row[ASIDE] = 0.02
    shift = hips_position(MODEL, np.zeros(DOF), row) - planned
    assert shift[0] == pytest.approx(0.02)
    assert -0.01 < shift[1] <= 1e-9


def test_where_there_is_no_room_hips_are_where_they_were_planned() -> None:
    rows = walked(path(at(1.1)))
    assert not carried(alive(rows, lambda _: 0.02)).any()
    free = alive(rows)
    assert lively(free[-1])
    assert not lively(living(BODY, free[-1], rows[-1], DT, -1.0, UNKNOWN))  # at once
    shrinking = [free[-1]]
    while lively(shrinking[-1]):
        shrinking.append(living(BODY, shrinking[-1], rows[-1], DT, 0.0, UNKNOWN))
    assert len(shrinking) < 14
    assert (np.diff(np.array(shrinking)[:, SHARE]) < 0.0).all()


def test_the_head_turns_before_the_root() -> None:
    row = walked(path(at(1.1)))[200]
    soon = np.array([[0.3, *row[:13]], [0.9, *row[:13]]])
    soon[1, 3] += 0.5
    shown = np.concatenate([row, np.zeros(CARRIAGE)])
    for _ in range(40):
        shown = living(BODY, shown, row, DT, np.inf, soon)
    assert 0.2 < shown[HEAD_TURN] < 0.5


def test_who_rests_breathes_and_shifts_weight() -> None:
    rows = alive(walked(path(lambda _: (0.0, 0.0, 0.0), 1500)))[200:]
    assert 0.01 < np.ptp(rows[:, ASIDE]) < 0.06
    assert 0.01 < np.ptp(rows[:, CHEST_BEND]) < 0.03
    assert np.abs(np.diff(carried(rows), 2, axis=0)).max() / DT**2 < 0.5
