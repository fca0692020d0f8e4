"""Arms make way for legs that stand otherwise than the walking cycle has them, and only then."""

import numpy as np

from elbowroom.body.dof import ARMS, LOCAL, columns_of, limits
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.gait.footholds import beside
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import FOOT, ROOT_STATE
from elbowroom.clips.motion_set import STOCK
from elbowroom.control.feet.arms_beside_legs import ArmsBesideLegs
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.root.path import RootPath

MODEL = body_model(proportional_humanoid())
ARMS_BESIDE = ArmsBesideLegs(MODEL, STOCK)
HANGING = natural_walk()(RootPath(0.0, 1.0, np.zeros((2, ROOT_STATE))))[0]


def gap(root: np.ndarray, upper: np.ndarray) -> float:
    """How much nearer any part could come to another, metres."""
    return float(self_clearances(MODEL, self_pairs(MODEL), root[None], upper[None]).min())


def test_arms_that_are_clear_stay_as_they_are() -> None:
    upper = np.zeros(LOCAL) + HANGING
    assert ARMS_BESIDE.apart(beside(MODEL.gait, np.zeros(ROOT_STATE)), upper) is upper


def test_arms_are_spread_where_a_thigh_stands_aside() -> None:
    moved = 0
    for aside in np.linspace(0.0, 0.35, 15):
        for side in range(2):
            root = beside(MODEL.gait, np.zeros(ROOT_STATE))
            root[ROOT_STATE + FOOT * side] += (1.0 - 2.0 * side) * aside
            spread = ARMS_BESIDE.apart(root, HANGING)
            assert gap(root, spread) >= -1e-6
            assert np.flatnonzero(spread - HANGING).tolist() in ([], [columns_of(ARMS[side]).start + 1])
            moved += spread is not HANGING
    assert moved > 4


def test_no_arm_is_spread_beyond_its_limits() -> None:
    upper = HANGING.copy()
    for arm in ARMS:
        upper[columns_of(arm)] = 1.2, limits(arm)[1, 1], 0.0, 0.0  # it is as far out as it goes
    root = beside(MODEL.gait, np.zeros(ROOT_STATE))
    np.testing.assert_array_equal(ARMS_BESIDE.apart(root, upper), upper)


def test_arms_that_have_no_room_for_more_leave_legs_just_what_they_need() -> None:
    moved = 0
    for aside in np.linspace(0.0, 0.35, 15):
        root = beside(MODEL.gait, np.zeros(ROOT_STATE))
        root[ROOT_STATE] += aside
        barely, spread = ARMS_BESIDE.barely_apart(root, HANGING), ARMS_BESIDE.apart(root, HANGING)
        assert ARMS_BESIDE.are_clear(root, barely)
        assert np.all(np.abs(barely - HANGING) <= np.abs(spread - HANGING) + 1e-9)
        moved += barely is not HANGING
    assert moved > 2


def test_arms_that_have_made_way_come_back_softly_and_are_back_soon() -> None:
    column, made, upper = columns_of(ARMS[1]).start + 1, np.zeros(LOCAL), HANGING
    made[column], spread = 0.03, [0.0, 0.03]
    for _ in range(60):
        upper = ARMS_BESIDE.coming_back(HANGING, HANGING, made, 1 / 60)
        made = upper - HANGING
        spread.append(float(made[column]))
    assert upper is HANGING
    assert np.abs(np.diff(spread, 2)).max() < 0.036, "less than by both, to and fro"
    assert np.all(np.diff(spread[1:]) <= 0.0)
    wide = HANGING + 0.1
    assert ARMS_BESIDE.coming_back(wide, HANGING, wide - HANGING, 1 / 60) is wide, "who has to make way does so"
