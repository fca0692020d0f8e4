"""The walk of a session as a recording."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from elbowroom.control.recordings.recording import Recording, RecordingHeader
from elbowroom.errors import InputError
from elbowroom.planning.command import Command
from elbowroom.server.sessions import walk_log
from elbowroom.server.sessions.walk import Walk, WalkSettings
from elbowroom.server.stores.library import Library

STEP = 1 / 60


@pytest.fixture(scope="module")
def library() -> Iterator[Library]:
    opened = Library.open("empty")
    yield opened
    opened.close()


def read(walk: Walk, folder: Path) -> Recording:
    file = folder / "walk.elbow"
    file.write_bytes(walk.recording())
    return Recording(file)


def test_a_walk_is_recorded_as_it_was_shown_and_standing_takes_little_room(library: Library, tmp_path: Path) -> None:
    walk = Walk(library.avatars.get("stock"), library.scenes["d"], WalkSettings())
    shown = []
    for k in range(200):
        walk.step(Command(forward=1.0) if 100 <= k < 160 else Command(), STEP)
        shown.append((walk.frame.time, walk.frame.q))
    recording = read(walk, tmp_path)
    steps = recording.steps()
    assert recording.note is None
    assert recording.header.live
    assert 60 < len(steps) < 170
    times = np.cumsum(steps["dt"])
    assert times[-1] == pytest.approx(shown[-1][0])
    for time, q in zip(times, steps["q"], strict=True):
        nearest = min(shown, key=lambda one: abs(one[0] - time))
        assert nearest[0] == pytest.approx(time)
        assert nearest[1].tobytes() == q.tobytes()
    walk.step(Command(forward=1.0), STEP)
    assert len(read(walk, tmp_path).steps()) == len(steps) + 1


def test_what_was_pushed_is_in_the_recording_and_a_reset_begins_anew(library: Library, tmp_path: Path) -> None:
    walk = Walk(library.avatars.get("stock"), library.scenes["d"], WalkSettings())
    walk.push(1, (-2.0, 1.75))
    for _ in range(120):
        walk.step(Command(), STEP)
    scene = read(walk, tmp_path).scene()
    assert scene.obstacles.moving.poses(1.9)[0][0, -1, 0] == pytest.approx(-2.0, abs=0.02)
    walk.reset()
    for _ in range(10):
        walk.step(Command(forward=1.0), STEP)
    recording = read(walk, tmp_path)
    assert len(recording.steps()) == 10
    assert len(recording.scene().obstacles.moving) == 0


def test_what_is_pushed_is_kept_with_the_step_in_which_it_was_there(library: Library, tmp_path: Path) -> None:
    walk = Walk(library.avatars.get("stock"), library.scenes["d"], WalkSettings())
    walk.push(1, (-2.0, 1.75))
    shown = []
    for _ in range(60):
        walk.step(Command(), STEP)
        shown.append(next(iter(walk.things.values())).place)
    moving, times = read(walk, tmp_path).scene().obstacles.moving, STEP * np.arange(1.0, 61.0)
    np.testing.assert_allclose(moving.poses(times)[0][:, -1, [0, 2]], np.array(shown), atol=2e-3)
    assert np.abs(np.diff(shown, axis=0)).max() > 0.01


def test_ten_minutes_are_kept(library: Library, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(walk_log, "MOST_STEPS", 20)
    walk = Walk(library.avatars.get("stock"), library.scenes["empty"], WalkSettings())
    for _ in range(40):
        walk.step(Command(forward=1.0), STEP)
    assert len(read(walk, tmp_path).steps()) == 20


def test_an_avatar_whose_file_is_gone_is_not_recorded(library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    def gone(_: object) -> None:
        raise InputError("alice.vrm: cannot be read")

    monkeypatch.setattr(RecordingHeader, "of", gone)
    walk = Walk(library.avatars.get("stock"), library.scenes["empty"], WalkSettings())
    walk.step(Command(forward=1.0), STEP)
    with pytest.raises(InputError, match="not recorded"):
        walk.recording()
