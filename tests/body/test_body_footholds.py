"""Feet on footholds: they stand where they came down whatever the root does, and come to rest beside each other."""

from collections.abc import Callable

import numpy as np
import pytest

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.gait.cycle import foot_poses, home_of, stride_of
from elbowroom.body.gait.footholds import gliding, onward, settled, standing
from elbowroom.body.gait.posed_feet import posed_feet
from elbowroom.body.pose.kinematics import body_model, leg_capsules, posture_capsules
from elbowroom.body.root import FOOT, ROOT_STATE, WITH_FEET
from feet_walks import DT, GAIT, WANTED, Velocities, in_world, path, random_wish, walked

MODEL = body_model(proportional_humanoid())
EVERY = [*WANTED.values(), *(random_wish(seed) for seed in range(6))]


@pytest.mark.parametrize("wanted", EVERY)
def test_a_standing_foot_does_not_move(wanted: Callable[[float], Velocities]) -> None:
    rows = walked(path(wanted))
    stands = standing(rows)
    for side in range(2):
        stays = stands[1:, side] & stands[:-1, side]
        assert np.abs(np.diff(in_world(rows, side), axis=0)[stays]).max() < 1e-12
    assert stands.any(axis=1).all()  # one of them stands at any time


@pytest.mark.parametrize("wanted", EVERY)
def test_who_stops_comes_to_stand_with_the_feet_beside_each_other(wanted: Callable[[float], Velocities]) -> None:
    roots = path(wanted, 420)
    rows = walked(roots)
    rests = int(np.flatnonzero(np.abs(roots[:, 3:6]).sum(axis=1) > 1e-3)[-1]) + 1
    landings = np.diff(standing(rows[rests:]).astype(int), axis=0) > 0
    assert landings.sum() <= 3  # the step that is under way, and one of each foot
    assert settled(GAIT, rows[rests + 90])
    stride = stride_of(GAIT.scale, 0.0, 0.0, 0.0)
    for side in range(2):
        home = home_of(GAIT.legs, stride, side)
        assert np.linalg.norm(rows[-1, ROOT_STATE + FOOT * side :][:2] - home) < 0.013
    assert not np.diff(rows[-10:], axis=0).any()


@pytest.mark.parametrize("wanted", EVERY)
def test_who_stops_without_room_for_steps_comes_to_stand_too(wanted: Callable[[float], Velocities]) -> None:
    roots = path(wanted, 300)
    row = walked(roots)[-1]
    for phase in np.linspace(0.0, 1.0, 12):
        swung = row.copy()
        swung[6] = phase
        rows = [swung]
        for _ in range(90):
            rows.append(gliding(GAIT, rows[-1], swung, DT))
        assert standing(rows[-1]).all()
        assert settled(GAIT, rows[-1])
        feet, _ = posed_feet(GAIT.legs, GAIT.scale, GAIT.half_leg, np.array(rows), np.zeros(len(rows)))
        assert np.abs(np.diff(feet[-30:], axis=0)).max() < 1e-9


@pytest.mark.parametrize("wanted", EVERY)
def test_feet_and_hips_move_without_a_jump(wanted: Callable[[float], Velocities]) -> None:
    rows = walked(path(wanted))
    feet, sinks = posed_feet(GAIT.legs, GAIT.scale, GAIT.half_leg, rows, np.zeros(len(rows)))
    roots = np.linalg.norm(np.diff(rows[:, :2], axis=0), axis=1)
    steps = np.linalg.norm(np.diff(feet[:, :, :3], axis=0), axis=2) - roots[:, None]
    assert steps.max() < 7.0 * DT
    assert np.abs(np.diff(sinks[:, 0])).max() < 2.0 * DT


def test_an_even_walk_is_that_of_the_cycle() -> None:
    roots = path(lambda _: (1.1, 0.0, 0.0), 400)
    rows = walked(roots)
    feet, sinks = posed_feet(GAIT.legs, GAIT.scale, GAIT.half_leg, rows, np.zeros(len(rows)))
    cycle, drops = foot_poses(GAIT.legs, GAIT.scale, roots)
    assert np.abs(feet - cycle)[240:, :, :3].max() < 0.02
    assert np.abs(sinks[:, 0] - drops)[240:].max() < 0.01


@pytest.mark.parametrize("at", [25, 95, 110])
def test_feet_that_glide_are_soon_where_the_cycle_has_them_and_do_not_jump(at: int) -> None:
    roots = path(WANTED["a bend"])
    rows = [walked(roots[: at + 1])[-1]]
    for root in roots[at + 1 : at + 40]:
        rows.append(gliding(GAIT, rows[-1], root, DT))
    feet, _ = posed_feet(GAIT.legs, GAIT.scale, GAIT.half_leg, np.array(rows), np.zeros(40))
    cycle, _ = foot_poses(GAIT.legs, GAIT.scale, roots[at : at + 40])
    off = np.abs(feet - cycle)[:, :, :3]
    assert off[0].max() > 0.01
    assert off[25:].max() < 0.005
    ways = np.linalg.norm(np.diff(feet - cycle, axis=0)[:, :, :3], axis=2)
    assert ways.max() < 3.0 * DT


def test_who_turns_in_place_steps() -> None:
    landings = np.diff(standing(walked(path(WANTED["turn in place"]))).astype(int), axis=0) > 0
    assert landings.sum(axis=0).min() >= 2


def test_no_time_moves_no_foot_over_the_ground() -> None:
    rows = walked(path(WANTED["a bend"]))
    for row in rows[::17]:
        moved = row[:ROOT_STATE] + 0.1
        later = np.stack([row, onward(GAIT, row, moved, 0.0)])
        for side in range(2):
            before, after = in_world(later, side)
            np.testing.assert_allclose(before, after, atol=1e-12)
        np.testing.assert_array_equal(onward(GAIT, row, row, 0.0), row)


def test_a_body_is_posed_on_its_feet() -> None:
    rows = walked(path(WANTED["start and stop"]))
    assert rows.shape[1] == WITH_FEET
    legs = leg_capsules(MODEL, rows)
    whole = posture_capsules(MODEL, np.zeros((len(rows), 16)), rows)
    np.testing.assert_array_equal(whole[MODEL.roots.indices], legs)
    assert np.abs(legs - leg_capsules(MODEL, rows[:, :ROOT_STATE])).max() > 0.05
