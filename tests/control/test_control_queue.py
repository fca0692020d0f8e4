"""The key-frame queue: what it plays is continuous in place and velocity, whenever it is refilled."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from elbowroom.body.dof import LOCAL
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.key_frame_queue import KeyFrameQueue, Playback
from elbowroom.planning.root.path import RootPath

INTERVAL = 0.2
SIZE = 5
STEP = 1e-5  # seconds; accelerations may jump at key times


def straight_path(start_time: float, start: np.ndarray, speed: float) -> RootPath:
    states = np.tile(start, (SIZE + 1, 1))
    for k in range(1, SIZE + 1):
        states[k] = states[k - 1]
        states[k, 3] += np.clip(speed - states[k, 3], -0.3, 0.3)
        distance = 0.5 * (states[k, 3] + states[k - 1, 3]) * INTERVAL
        states[k, 0] += distance * np.sin(states[k, 2])
        states[k, 1] += distance * np.cos(states[k, 2])
        states[k, 6] += 0.1
    return RootPath(start_time, INTERVAL, states)


def random_uppers(rng: np.random.Generator, first: np.ndarray) -> np.ndarray:
    return np.concatenate([first[None], first + np.cumsum(rng.normal(size=(SIZE, LOCAL)) * 0.3, axis=0)])


def filled_queue(rng: np.random.Generator) -> KeyFrameQueue:
    queue = KeyFrameQueue(SIZE, INTERVAL)
    start = Playback(np.zeros(ROOT_STATE), rng.normal(size=LOCAL), np.zeros(LOCAL))
    queue.splice(straight_path(0.0, start.root, 1.2), random_uppers(rng, start.upper), np.zeros(LOCAL))
    return queue


def refill(queue: KeyFrameQueue, rng: np.random.Generator, at_once: bool) -> None:
    time = queue.time if at_once else float(queue.unplayed().times[0])
    start = queue.at(time)
    path = straight_path(time, start.root, rng.uniform(-1, 1.3))
    queue.splice(path, random_uppers(rng, start.upper), start.upper_velocity)


def test_a_new_queue_is_empty() -> None:
    queue = KeyFrameQueue(SIZE, INTERVAL)
    assert queue.empty
    assert queue.fill == 0
    assert len(queue.unplayed().times) == 0


def test_keys_are_consumed_as_time_is_played() -> None:
    queue = filled_queue(np.random.default_rng(0))
    assert queue.fill == SIZE
    queue.advance(INTERVAL)
    assert queue.consumed == pytest.approx(1.0)
    assert queue.fill == SIZE - 1
    queue.start_count()
    assert queue.consumed == 0.0
    queue.advance(10.0)
    assert queue.empty
    queue.clear()
    assert queue.fill == 0


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000), st.lists(st.tuples(st.floats(0.001, 0.5), st.booleans()), min_size=1, max_size=6))
def test_splices_are_continuous_in_value_and_velocity(seed: int, refills: list[tuple[float, bool]]) -> None:
    rng = np.random.default_rng(seed)
    queue = filled_queue(rng)
    for wait, at_once in refills:
        queue.advance(min(wait, INTERVAL * (SIZE - 2)))
        before = queue.sample()
        refill(queue, rng, at_once)
        after = queue.sample()
        np.testing.assert_allclose(after.upper, before.upper, atol=1e-12)
        np.testing.assert_allclose(after.upper_velocity, before.upper_velocity, atol=1e-9)
        np.testing.assert_allclose(after.root, before.root, atol=1e-9)


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000), st.booleans())
def test_velocities_are_the_derivatives_of_what_is_played(seed: int, at_once: bool) -> None:
    rng = np.random.default_rng(seed)
    queue = filled_queue(rng)
    queue.advance(0.25)
    refill(queue, rng, at_once)
    for _ in range(12):
        queue.advance(rng.uniform(0.0, 0.1))
        middle = queue.sample()
        queue.advance(STEP)
        later = queue.sample()
        queue.advance(-2 * STEP)
        earlier = queue.sample()
        queue.advance(STEP)
        slope = (later.upper - earlier.upper) / (2 * STEP)
        np.testing.assert_allclose(slope, middle.upper_velocity, atol=0.01)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000), st.floats(0.01, 0.5))
def test_until_a_splice_all_is_played_as_it_was_and_there_it_goes_on(seed: int, ahead: float) -> None:
    rng = np.random.default_rng(seed)
    queue, same = filled_queue(rng), filled_queue(np.random.default_rng(seed))
    queue.advance(0.13)
    same.advance(0.13)
    start = queue.at(queue.time + ahead)
    path = straight_path(queue.time + ahead, start.root, 0.5)
    queue.splice(path, random_uppers(rng, start.upper), start.upper_velocity)
    for part in np.linspace(0.0, 1.0, 9):
        before, after = same.at(same.time + part * ahead), queue.at(queue.time + part * ahead)
        np.testing.assert_allclose(after.root[:6], before.root[:6], atol=1e-9)
        np.testing.assert_allclose(after.root[6], before.root[6], atol=0.01)  # the stride: a rate of its own, nearly it
        np.testing.assert_allclose(after.upper, before.upper, atol=1e-9)
        np.testing.assert_allclose(after.upper_velocity, before.upper_velocity, atol=1e-7)


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 10_000), st.lists(st.floats(0.0, 1.0), min_size=1, max_size=30))
def test_played_slower_the_poses_are_the_same_and_their_velocities_less(seed: int, rates: list[float]) -> None:
    queue, same = (filled_queue(np.random.default_rng(seed)) for _ in range(2))
    for rate in rates:
        queue.advance(0.03, rate)
        same.advance(0.03 * rate)
        slow, planned = queue.sample(), same.sample()
        np.testing.assert_allclose(slow.root[[0, 1, 2, 6]], planned.root[[0, 1, 2, 6]], atol=1e-9)
        np.testing.assert_allclose(slow.upper, planned.upper, atol=1e-9)
        np.testing.assert_allclose(slow.root[3:6], rate * planned.root[3:6], atol=1e-9)
        np.testing.assert_allclose(slow.upper_velocity, rate * planned.upper_velocity, atol=1e-7)
    assert queue.time == pytest.approx(0.03 * len(rates))
    assert queue.time - queue.delay == pytest.approx(same.time)


def test_a_splice_at_the_next_key_keeps_the_interval_in_play() -> None:
    rng = np.random.default_rng(3)
    queue, same = filled_queue(rng), filled_queue(np.random.default_rng(3))
    queue.advance(0.21)
    same.advance(0.21)
    refill(queue, rng, at_once=False)
    assert queue.fill == SIZE
    assert len(queue.unplayed().times) == SIZE + 1  # the key in play and |Q| planned beyond it
    for _ in range(9):
        queue.advance(0.02)
        same.advance(0.02)
        np.testing.assert_array_equal(queue.sample().root, same.sample().root)
