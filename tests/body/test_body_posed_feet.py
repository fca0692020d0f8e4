"""Feet that are posed: a leg that would be too short gets what it lacks from the heel, the air, or the hips, gently."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.gait.footholds import beside, onward
from elbowroom.body.gait.posed_feet import posed_feet
from elbowroom.body.root import RISES, ROOT_STATE
from feet_walks import DT, GAIT, WANTED, Velocities, path, random_feet, random_wish, walked

Floats = NDArray[np.float64]

HIP, BALL, THIGH, SHIN, TOES = 0, 6, 8, 9, 10  # columns of the legs
Z, PITCH, LIFT, SWING = ROOT_STATE + 1, ROOT_STATE + 3, ROOT_STATE + 4, ROOT_STATE + 5  # of the left foot
EVERY = [*WANTED.values(), *(random_wish(seed) for seed in range(6))]


def posed(rows: Floats) -> tuple[Floats, Floats]:
    return posed_feet(GAIT.legs, GAIT.scale, GAIT.half_leg, rows, np.zeros(len(rows)))


def lengths(feet: Floats, sinks: Floats, side: int) -> Floats:
    """From hip to ankle, in parts of the leg."""
    hips = GAIT.legs[side, HIP : HIP + 3] - np.column_stack([np.zeros(len(sinks)), sinks[:, :2]])
    length = GAIT.legs[side, THIGH] + GAIT.legs[side, SHIN]
    found: Floats = np.linalg.norm(feet[:, side, :3] - hips, axis=1) / length
    return found


def flexions(parts: Floats, side: int) -> Floats:
    """Of a knee, degrees, by how long its leg is, as it is drawn: never quite straight."""
    thigh, shin = GAIT.legs[side, THIGH], GAIT.legs[side, SHIN]
    far = np.minimum(parts, 0.9985) * (thigh + shin)
    return np.asarray(np.degrees(np.arccos((far**2 - thigh**2 - shin**2) / (2.0 * thigh * shin))))


def stood_behind(ways: Floats) -> Floats:
    """The left foot stands so far behind a body at rest, flat as its state has it."""
    rows = np.repeat(beside(GAIT, np.zeros(ROOT_STATE))[None], len(ways), axis=0)
    rows[:, Z] -= ways
    return rows


def test_the_heel_of_a_foot_that_is_left_behind_rises_over_its_ball() -> None:
    """And hips hardly come down to it: without, they would by 9 cm."""
    rows = stood_behind(np.linspace(0.0, 0.4, 81))
    feet, sinks = posed(rows)
    pitch = feet[:, 0, 4]
    assert np.abs(pitch[:20]).max() < 1e-9
    assert np.diff(pitch).min() > -1e-9
    assert 0.5 < pitch[-1] < 1.1
    assert (sinks[:, 0] - sinks[0, 0]).max() < 0.01
    assert lengths(feet, sinks, 0).max() < 1.003
    ball, above = GAIT.legs[0, BALL], GAIT.legs[0, TOES]
    height = GAIT.legs[0, 4] - above
    toes = feet[:, 0, 2] + ball * np.cos(pitch) - height * np.sin(pitch)
    assert toes - rows[:, Z] == pytest.approx(np.full(81, ball), abs=2e-3)
    assert feet[:, 0, 1] - ball * np.sin(pitch) - height * np.cos(pitch) == pytest.approx(np.full(81, above), abs=2e-3)


def test_a_foot_ahead_or_beside_keeps_its_heel_down_and_hips_come() -> None:
    rows = stood_behind(-np.linspace(0.0, 0.5, 51))
    feet, sinks = posed(rows)
    assert np.abs(feet[:, 0, 4]).max() < 1e-9
    assert sinks[-1, 0] > sinks[0, 0] + 0.05
    assert lengths(feet, sinks, 0).max() < 1.003


def test_hips_do_not_come_down_to_a_foot_in_the_air() -> None:
    """In the middle of its swing: as it lands they do, and there is no step in between."""
    rows = stood_behind(-np.full(101, 0.35))
    rows[:, SWING], rows[:, LIFT] = np.linspace(0.0, 0.999, 101), 0.0
    feet, sinks = posed(rows)
    assert sinks[50, 0] < sinks[0, 0] - 0.025
    assert feet[50, 0, 1] > feet[0, 0, 1] + 0.025
    assert np.abs(np.diff(sinks[:, 0])).max() < 0.008
    assert sinks[-1, 0] == pytest.approx(sinks[0, 0], abs=1e-3)


def test_feet_on_uneven_ground_are_pitched_and_lifted_as_in_the_same_stride_on_the_plane() -> None:
    """That stride tells how deep the capsules of a foot lie: feet are held higher by as much (`planning.footing`)."""
    rng = np.random.default_rng(4)
    flat = random_feet(rng, np.zeros((300, ROOT_STATE)))
    flat[:, 3] = rng.uniform(0.0, 1.4, 300)
    uneven, rises = flat.copy(), rng.uniform(-0.2, 0.2, (300, 2))
    uneven[:, RISES : RISES + 4 : 2] = rises
    on_plane, on_ground = posed(flat)[0], posed(uneven)[0]
    on_ground[:, :, 1] -= rises
    assert on_ground == pytest.approx(on_plane, abs=1e-12)


@pytest.mark.parametrize("wanted", EVERY)
def test_no_leg_is_let_go_in_one_frame(wanted: Callable[[float], Velocities]) -> None:
    """Recorded knees have 13,000 to 24,000 degrees/s² in 99.5 % of their frames; it was 46,000 in a start."""
    feet, sinks = posed(walked(path(wanted)))
    bent = np.array([flexions(lengths(feet, sinks, side), side) for side in range(2)])
    assert np.percentile(np.abs(np.diff(bent, 2, axis=1)) / DT**2, 99.5) < 33_000.0
    assert np.abs(np.diff(bent, axis=1)).max() / DT < 1000.0


def test_no_leg_is_quite_straight_as_its_foot_lands_at_two_metres_a_second() -> None:
    """A millimetre more and its knee, which bends as the foot comes to a stand, would do so more suddenly."""
    feet, sinks = posed(walked(path(lambda _: (2.0, 0.0, 0.0))))
    assert max(lengths(feet, sinks, side)[150:].max() for side in range(2)) < 0.995


def test_what_a_foot_is_pitched_otherwise_than_it_should_be_fades_as_by_a_critically_damped_spring() -> None:
    """Under a body at rest, which wants it flat; and then it is, or who rests would never stand still."""
    row, angle, soon = beside(GAIT, np.zeros(ROOT_STATE)), 0.3, 25.0
    row[PITCH] = angle
    for frame in range(1, 61):
        row = onward(GAIT, row, row[:ROOT_STATE].copy(), DT)
        after = soon * frame * DT
        assert row[PITCH] == pytest.approx(angle * (1.0 + after) * np.exp(-after), abs=2e-4)
    assert abs(row[PITCH]) < 1e-12
