"""Obstacles on tracks: where they are, and what holds all that they sweep."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from elbowroom.errors import InputError
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import corners_of, rows_of
from elbowroom.world.obstacles.shapes import Box, Hull, extents_of
from elbowroom.world.obstacles.tracks.moving import Moving, Repeat, Track
from elbowroom.world.scene import Scene
from sampled import sampled


def track(repeat: Repeat, yaws: tuple[float, float, float] = (0.0, 0.4, -0.3)) -> Track:
    centers = np.array([[0.0, 0.5, 0.0], [2.0, 0.5, 0.0], [2.0, 0.5, 1.0]])
    return Track("box", Box((0.5, 1.0, 0.8)), np.array([0.0, 2.0, 3.0]), centers, np.array(yaws), repeat)


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
    centers, _ = Moving((track(repeat),)).poses([time])
    np.testing.assert_allclose(centers[0, 0], [x, 0.5, z], atol=1e-12)


def test_what_moves_stands_at_its_pose() -> None:
    moving = Moving((track(Repeat.LOOP), track(Repeat.PINGPONG)))
    for time in (0.0, 0.7, 2.9, 11.3):
        centers, yaws = moving.poses(time)
        turns = np.array([quaternion.about_axis(1, float(yaw)) for yaw in yaws[0]])
        there = Obstacles.boxes(centers[0], turns, moving.half_sizes).standing
        np.testing.assert_allclose(moving.at(time).rows, there.rows, atol=1e-12)


def test_what_is_not_about_its_origin_moves_as_rows_are_made() -> None:
    points = [(0.1, 0.0, 0.2), (0.9, 0.0, 0.3), (0.2, 0.8, 0.4), (0.3, 0.1, 1.1)]
    hull = replace(track(Repeat.LOOP), shape=Hull(tuple(points)))
    moving = Moving((hull, track(Repeat.ONCE)))
    for time in (0.0, 1.3, 2.6, 7.9):
        centers, yaws = moving.poses(time)
        turns = quaternion.about_axis(1, yaws[0])
        there = rows_of([each.shape for each in moving.tracks], centers[0], turns)
        np.testing.assert_allclose(moving.at(time).rows, there.rows, atol=1e-12)


@pytest.mark.parametrize("repeat", sampled(Repeat))
def test_a_sweep_holds_every_corner_at_every_time_and_little_else(repeat: Repeat) -> None:
    rng = np.random.default_rng(4)
    moving = Moving((track(repeat, (0.0, 2.0, -1.0)),))
    for _ in range(8):
        first = rng.uniform(0.0, 14.0)
        last = first + rng.uniform(0.05, 0.6)
        row = moving.swept([first, last]).rows[0, 0]
        times = np.linspace(first, last, 200)
        corners = np.concatenate([corners_of(moving.at(float(time)))[0] for time in times])
        own = (corners - row[:3]) @ row[3:12].reshape(3, 3).T
        assert np.all(np.abs(own) <= row[12:15] + 1e-9)
        np.testing.assert_allclose(np.abs(own).max(axis=0), row[12:15], atol=0.03)


def swept_slowly(moving: Moving, first: float, last: float) -> np.ndarray:
    """The twin of a sweep: NumPy, one box after the other, looked at evenly and at the key poses."""
    rows = []
    for one in moving.tracks:
        span, laps = one.duration, np.arange(-3, 60)
        points = one.times
        if one.repeat is Repeat.LOOP:
            points = (span * laps[:, None] + one.times).ravel()
        elif one.repeat is Repeat.PINGPONG:
            there_and_back = np.concatenate([one.times, 2.0 * span - one.times])
            points = (2.0 * span * laps[:, None] + there_and_back).ravel()
        between = points[(points > first) & (points < last)]
        times = np.sort(np.concatenate([np.linspace(first, last, 5), between]))
        centers, yaws = one.poses(times)
        yaw, half = one.poses([0.5 * (first + last)])[1][0], extents_of(one.shape)
        to_box = np.array([[np.cos(yaw), 0.0, -np.sin(yaw)], [0.0, 1.0, 0.0], [np.sin(yaw), 0.0, np.cos(yaw)]])
        turned = yaws - yaw
        wide = half[0] * np.abs(np.cos(turned)) + half[2] * np.abs(np.sin(turned))
        deep = half[0] * np.abs(np.sin(turned)) + half[2] * np.abs(np.cos(turned))
        reach = np.stack([wide, np.full_like(wide, half[1]), deep], axis=1)
        own = centers @ to_box.T
        low, high = (own - reach).min(axis=0), (own + reach).max(axis=0)
        bulge = 0.125 * np.hypot(half[0], half[2]) * np.abs(np.diff(yaws)).max() ** 2
        size = 0.5 * (high - low) + np.array([bulge, 0.0, bulge])
        rows.append(np.concatenate([0.5 * (low + high) @ to_box, to_box.ravel(), size]))
    return np.array(rows)


@pytest.mark.parametrize("still", [False, True])
def test_sweeps_are_those_of_a_slow_twin(still: bool) -> None:
    rng = np.random.default_rng(9)
    for _ in range(40):
        tracks = []
        for repeat in Repeat:
            count = 1 if still else int(rng.integers(2, 6))
            times = np.concatenate([[0.0], np.cumsum(rng.uniform(0.05, 1.5, count - 1))])
            poses = rng.normal(0.0, 1.0, (count, 3)), rng.uniform(-3.0, 3.0, count)
            tracks.append(Track("box", Box(tuple(rng.uniform(0.1, 1.0, 3).tolist())), times, *poses, repeat))
        moving = Moving(tuple(tracks))
        first = rng.uniform(0.0, 9.0, 5)
        last = first + rng.uniform(0.01, 1.2, 5)
        found = moving.swept_between(first, last)
        for rows, begin, end in zip(found.rows, first, last, strict=True):
            np.testing.assert_allclose(rows[:, :15], swept_slowly(moving, float(begin), float(end)), atol=1e-12)


def test_no_boxes_sweep_nothing() -> None:
    assert Moving().swept([0.0, 1.0, 2.0]).rows.shape[:2] == (2, 0)
    assert Moving((track(Repeat.LOOP),)).swept([0.0]).rows.shape[:2] == (0, 1)


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
    for one, other in zip(again.obstacles.moving.poses(times), scene.obstacles.moving.poses(times), strict=True):
        np.testing.assert_array_equal(one, other)
    assert scene.obstacles.moving.names == ("trolley", "swinging beam", "cart")


def test_the_beam_swings_about_its_post() -> None:
    scene = Scene.load("traffic")
    post = scene.obstacles.centers[0, [0, 2]]
    for time in np.linspace(0.0, 6.0, 13):
        centers, _ = scene.obstacles.moving.poses(time)
        away = math.hypot(*(centers[0, 1, [0, 2]] - post))
        assert away == pytest.approx(0.45, abs=0.04)
