"""Feet on footholds: they stand where they came down whatever the root does, and come to rest beside each other."""

from collections.abc import Callable

import numpy as np
import pytest

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.gait.cycle import flat_place, foot_poses, home_of
from elbowroom.body.gait.foot_state import standing
from elbowroom.body.gait.footholds import beside, onward, settled
from elbowroom.body.gait.gliding import gliding
from elbowroom.body.gait.posed_feet import posed_feet
from elbowroom.body.gait.stride import stride_of
from elbowroom.body.pose.kinematics import body_model, leg_capsules, posture_capsules
from elbowroom.body.root import FOOT, ROOT_STATE, WITH_FEET
from feet_walks import DT, GAIT, WANTED, Velocities, in_world, path, random_wish, walked

MODEL = body_model(proportional_humanoid())
LIFT, SWING = ROOT_STATE + 4, ROOT_STATE + 5  # of the left foot
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


def test_an_even_walk_goes_where_the_cycle_does() -> None:
    """Only the roll of its feet is another one."""
    roots = path(lambda _: (1.1, 0.0, 0.0), 400)
    rows = walked(roots)
    stride = stride_of(GAIT.scale, 1.1, 0.0, 0.0)
    for row in rows[240:]:
        for side in range(2):
            foot = row[ROOT_STATE + FOOT * side :]
            place = flat_place(GAIT.legs, stride, side, (row[6] + 0.5 * side) % 1.0)
            assert np.abs(foot[:2] - place[:2]).max() < 0.02
    _, sinks = posed_feet(GAIT.legs, GAIT.scale, GAIT.half_leg, rows, np.zeros(len(rows)))
    _, drops = foot_poses(GAIT.legs, GAIT.scale, roots)
    assert np.abs(sinks[:, 0] - drops)[240:].max() < 0.02


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


def test_a_foot_that_goes_round_is_over_its_place_before_it_comes_down() -> None:
    """It would rub over the ground: in the last 4 mm it moves by no more than half a millimetre."""
    rows, moved = walked(path(WANTED["turn in place"])), []
    for side in range(2):
        low = (rows[:, SWING + FOOT * side] > 0.5) & (rows[:, LIFT + FOOT * side] < 0.004)
        moved += np.abs(np.diff(in_world(rows, side), axis=0))[low[1:] & low[:-1], :2].max(axis=1).tolist()
    assert len(moved) > 2
    assert max(moved) < 5e-4


@pytest.mark.parametrize("wanted", EVERY)
def test_a_foot_leaps_nowhere(wanted: Callable[[float], Velocities]) -> None:
    """Not in the last moment of its swing either, where the place that it goes to has changed."""
    rows = walked(path(wanted))
    fastest = 5.0 + 2.2 * np.hypot(rows[:, 3], rows[:, 4]).max()
    for side in range(2):
        moved = np.hypot(*np.diff(in_world(rows, side), axis=0)[:, :2].T)
        assert moved.max() < fastest * DT


@pytest.mark.parametrize("dt", [1 / 30, 1 / 60, 1 / 90])
def test_a_foot_lands_where_it_is_due_between_two_frames_too(dt: float) -> None:
    """In an even walk it is a stride ahead of where it stood, and under the root in the middle of its stance."""
    stride = stride_of(GAIT.scale, 1.1, 0.0, 0.0)
    roots = np.zeros((round(8.0 / dt), ROOT_STATE))
    roots[:, 3], roots[:, 1] = 1.1, 1.1 * dt * np.arange(len(roots))
    roots[:, 6] = dt / stride.period * np.arange(len(roots))
    rows = [beside(GAIT, roots[0])]
    for root in roots[1:]:
        rows.append(onward(GAIT, rows[-1], root, dt))
    even = np.array(rows)[round(4.0 / dt) :]
    for side in range(2):
        u = (even[:, 6] + 0.5 * side) % 1.0
        due = even[:, 1] + home_of(GAIT.legs, stride, side)[1] - 1.1 * stride.period * (u - 0.5 * stride.duty)
        apart = np.abs(in_world(even, side)[:, 1] - due)[(u > 0.1) & (u < 0.5)]
        assert apart.max() < 0.004


def test_feet_that_glide_and_hold_stand_until_the_cycle_lifts_them() -> None:
    """Whatever the root does; without it they slide as soon as velocities change."""
    rows = walked(path(WANTED["a bend"]))
    farthest = []
    for holds in (True, False):
        glides = [rows[70]]
        for row in rows[71:130]:
            glides.append(gliding(GAIT, glides[-1], row, DT, holds=holds))
        shown = np.array(glides)
        stays = standing(shown)[1:] & standing(shown)[:-1]
        moved = [np.abs(np.diff(in_world(shown, side), axis=0))[stays[:, side]].max() for side in range(2)]
        farthest.append(max(moved))
    assert farthest[0] < 1e-12
    assert farthest[1] > 1e-4


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
