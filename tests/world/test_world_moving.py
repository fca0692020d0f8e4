"""Boxes on tracks: where they are, and what holds all that they sweep."""

import math
from typing import Any

import numpy as np
import pytest

from elbowroom.errors import InputError
from elbowroom.world.boxes import Boxes
from elbowroom.world.moving import MovingBoxes, Repeat, Track
from elbowroom.world.scene import Scene


def track(repeat: Repeat, yaws: tuple[float, float, float] = (0.0, 0.4, -0.3)) -> Track:
    centers = np.array([[0.0, 0.5, 0.0], [2.0, 0.5, 0.0], [2.0, 0.5, 1.0]])
    return Track("box", np.array([0.5, 1.0, 0.8]), np.array([0.0, 2.0, 3.0]), centers, np.array(yaws), repeat)


@pytest.mark.parametrize(
    ("repeat", "time", "x", "z"),
    [
        (Repeat.ONCE, 1.0, 1.0, 0.0),
        (Repeat.ONCE, 2.5, 2.0, 0.5),
        (Repeat.ONCE, 9.0, 2.0, 1.0),
        (Repeat.LOOP, 4.0, 1.0, 0.0),
        (Repeat.PINGPONG, 3.5, 2.0, 0.5),
        (Repeat.PINGPONG, 5.0, 1.0, 0.0),
        (Repeat.PINGPONG, 7.0, 1.0, 0.0),
    ],
)
def test_a_track_goes_on_after_its_last_key_pose(repeat: Repeat, time: float, x: float, z: float) -> None:
    centers, _ = MovingBoxes((track(repeat),)).poses([time])
    np.testing.assert_allclose(centers[0, 0], [x, 0.5, z], atol=1e-12)


def test_rows_are_those_of_boxes_that_stand_there() -> None:
    moving = MovingBoxes((track(Repeat.LOOP), track(Repeat.PINGPONG)))
    times = [0.0, 0.7, 2.9, 11.3]
    for time, rows in zip(times, moving.tables(times), strict=True):
        np.testing.assert_allclose(rows, moving.at(time).table, atol=1e-12)


@pytest.mark.parametrize("repeat", list(Repeat))
def test_a_sweep_holds_every_corner_at_every_time_and_little_else(repeat: Repeat) -> None:
    rng = np.random.default_rng(4)
    moving = MovingBoxes((track(repeat, (0.0, 2.0, -1.0)),))
    for _ in range(60):
        first = rng.uniform(0.0, 14.0)
        last = first + rng.uniform(0.05, 0.6)
        row = moving.swept([first, last])[0, 0]
        times = np.linspace(first, last, 200)
        corners = np.concatenate([moving.at(float(time)).corners[0] for time in times])
        own = (corners - row[:3]) @ row[3:12].reshape(3, 3).T
        assert np.all(np.abs(own) <= row[12:] + 1e-9)
        np.testing.assert_allclose(np.abs(own).max(axis=0), row[12:], atol=0.03)


def document(**changes: Any) -> dict[str, Any]:
    box = {
        "type": "box",
        "size": [1, 1, 1],
        "track": [{"center": [3, 1, 3], "seconds": 1}, {"center": [4, 1, 3], "seconds": 1}],
    }
    return {**Scene.load("empty").to_dict(), "moving": [box | changes]}


@pytest.mark.parametrize(
    ("changes", "part"),
    [
        ({"repeat": "twice"}, '$.moving[0].repeat is "twice"; must be one of once, loop, pingpong'),
        ({"track": [{"center": [3, 1, 3], "seconds": 1}]}, "at least 2 key poses"),
        ({"track": [{"center": [3, 1, 3], "seconds": 0.1}, {"center": [6, 1, 3], "seconds": 1}]}, "leads on at 30"),
        ({"track": [{"center": [3, 1, 3], "seconds": 0}] * 2}, "$.moving[0].track[0].seconds is 0"),
        ({"track": [{"center": [0, 1, 0], "seconds": 1}] * 2}, "stands in the obstacle 'moving box 1'"),
    ],
)
def test_a_wrong_track_is_named_with_the_mend(changes: dict[str, Any], part: str) -> None:
    with pytest.raises(InputError) as error:
        Scene.from_dict(document(**changes), "hall.json")
    assert part in str(error.value)
    assert "\n" not in str(error.value)


def test_what_was_read_is_what_is_written() -> None:
    scene = Scene.load("traffic")
    again = Scene.from_dict(scene.to_dict())
    assert again.to_dict() == scene.to_dict()
    times = np.linspace(0.0, 30.0, 50)
    np.testing.assert_array_equal(again.moving.tables(times), scene.moving.tables(times))
    assert scene.moving.names == ("trolley", "swinging beam", "cart")


def test_the_beam_swings_about_its_post() -> None:
    scene = Scene.load("traffic")
    post = scene.boxes.centers[0, [0, 2]]
    for time in np.linspace(0.0, 6.0, 13):
        beam: Boxes = scene.moving.at(float(time))
        away = math.hypot(*(beam.centers[1, [0, 2]] - post))
        assert away == pytest.approx(0.45, abs=0.04)
