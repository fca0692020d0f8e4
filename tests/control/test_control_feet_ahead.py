"""Feet foreseen at once are those that step, or glide, on one row after the other."""

import numpy as np
import pytest

from elbowroom.body.dof import LOCAL, LOWERING, DofGroup
from elbowroom.body.gait.footholds import UNKNOWN, beside, onward
from elbowroom.body.gait.gliding import gliding
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import ROOT_STATE, WITH_FEET
from elbowroom.control.feet.feet_ahead import glides_ahead, steps_ahead
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.world.scene import Scene

HUMANOID = Humanoid.default()
GAIT = body_model(HUMANOID).gait
PIECE, UNTIL = 0.05, 0.75


def drawn(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A row in mid-step, and what the root is to come to."""
    rng = np.random.default_rng(seed)
    root = np.zeros(ROOT_STATE)
    root[3:6] = rng.normal(0.0, (0.8, 0.3, 0.5))
    row = beside(GAIT, root)
    for _ in range(rng.integers(1, 40)):
        root[:3] += root[3:6] / 60.0
        root[6] += 0.9 / 60.0
        row = onward(GAIT, row, root, 1 / 60)
    times = np.cumsum(rng.uniform(0.02, 0.3, 6)) - 0.1
    ahead = np.empty((6, 1 + ROOT_STATE))
    ahead[:, 0] = times
    ahead[:, 1:] = root + times[:, None] * np.concatenate(
        [root[3:6], rng.normal(0, 0.1, 3), [0.9], np.zeros(ROOT_STATE - 7)]
    )
    return row, ahead


def one_by_one(row: np.ndarray, ahead: np.ndarray, *, steps: bool = True) -> np.ndarray:
    rows, since, left = [row], 0.0, ahead[ahead[:, 0] > 0.0]
    for n, (until, *_) in enumerate(left):
        pieces = max(round((until - since) / PIECE), 1)
        begin, coming = rows[-1][:ROOT_STATE], left[n:].copy()
        for k in range(1, pieces + 1):
            share = k / pieces
            coming[:, 0] = left[n:, 0] - since - share * (until - since)
            root, dt = begin + share * (left[n, 1:] - begin), (until - since) / pieces
            rows.append(onward(GAIT, rows[-1], root, dt, coming) if steps else gliding(GAIT, rows[-1], root, dt))
        since = until
        if since >= UNTIL:
            break
    return np.array(rows)


@pytest.mark.parametrize("seed", range(20))
def test_they_are_those_that_step_on_one_after_the_other(seed: int) -> None:
    row, ahead = drawn(seed)
    assert np.abs(steps_ahead(GAIT, row, ahead, UNTIL) - one_by_one(row, ahead)).max() < 1e-12
    assert np.abs(glides_ahead(GAIT, row, ahead, UNTIL) - one_by_one(row, ahead, steps=False)).max() < 1e-12


def test_where_nothing_is_known_it_is_the_row_itself() -> None:
    row, _ = drawn(0)
    assert steps_ahead(GAIT, row, UNKNOWN, UNTIL).tobytes() == row[None].tobytes()
    assert steps_ahead(GAIT, row, np.full((1, 1 + ROOT_STATE), -0.1), UNTIL).shape == (1, WITH_FEET)


@pytest.mark.parametrize("seed", range(10))
def test_the_room_of_legs_along_them_is_that_of_the_nearest(seed: int) -> None:
    row, ahead = drawn(seed)
    rows, rng = steps_ahead(GAIT, row, ahead, UNTIL), np.random.default_rng(seed)
    at = rows[:, :2].mean(axis=0)
    pillars = [
        {"type": "box", "center": [*np.insert(at + rng.uniform(-0.8, 0.8, 2), 1, 0.5)], "size": [0.1, 1.0, 0.1]}
        for _ in range(3)
    ]
    check = BodyCheck(HUMANOID, Scene.of("pillars", pillars, start=(60.0, 60.0), finish=(0.0, 50.0)))
    upper = np.zeros(LOCAL)
    upper[LOWERING - DofGroup.ROOT.size] = 0.1
    least = min(check.room_of_legs(each, upper, 0.0) for each in rows)
    for farthest in (9.0, 0.2, 0.02):
        assert abs(check.room_along(rows, upper, farthest) - min(least, farthest)) < 1e-6
