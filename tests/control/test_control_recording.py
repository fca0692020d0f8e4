"""Recordings: what is written is read back, a torn file up to its last whole chunk, a hostile one not at all."""

import json
import struct
import zlib
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from bvh_builder import BvhRecipe, random_motion, write_bvh
from elbowroom.body.dof import LOCAL_GROUPS, LOWERING, DofGroup, clamp, followed
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.root import ROOT_STATE, SHOWN
from elbowroom.clips.clip import motions_of
from elbowroom.clips.files import parse_motion
from elbowroom.clips.motion_set import MotionSet
from elbowroom.clips.swing import KEYS, Swing
from elbowroom.control.controller import Controller
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.control.recordings import recording as recordings
from elbowroom.control.recordings.recorded_ways import way_from
from elbowroom.control.recordings.recording import (
    MAGIC,
    STEP,
    STEPS_PER_CHUNK,
    Recorder,
    Recording,
    command_of,
    roots_of,
)
from elbowroom.control.recordings.replay import replay
from elbowroom.errors import InputError
from elbowroom.planning.command import Command
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.scene import Scene
from place_builder import TWO_ROOMS, write_place

HUMANOID = proportional_humanoid(1.72)
STEPS = 150


def record(path: Path, steps: int = STEPS, scene: str = "empty") -> list[tuple[Command, float, np.ndarray]]:
    controller = Controller(HUMANOID, Scene.load(scene), seed=3, ahead=Lookahead(4))
    rng = np.random.default_rng(1)
    shown = []
    with Recorder(path, controller) as recorder:
        command = Command(forward=1.0)
        for i in range(steps):
            if i % 40 == 39:
                forward, strafe, turn = rng.uniform(-1, 1, 3).tolist()
                direction = 0.5 if rng.random() < 0.5 else None
                command = Command(forward, strafe, turn, direction, run=bool(rng.integers(2)))
            dt = float(rng.uniform(0.0, 0.05))
            frame = controller.step(command, dt)
            recorder.append(frame, dt)
            shown.append((command, dt, frame.q))
    return shown


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[tuple[Command, float, np.ndarray]]]:
    path = tmp_path_factory.mktemp("runs") / "run.elbow"
    return path, record(path)


def test_steps_come_back_bit_for_bit(run: tuple[Path, list[tuple[Command, float, np.ndarray]]]) -> None:
    path, shown = run
    recording = Recording(path)
    steps = recording.steps()
    assert recording.note is None
    assert len(steps) == len(shown)
    for step, (command, dt, q) in zip(steps, shown, strict=True):
        assert command_of(step) == command
        assert step["dt"] == dt
        assert step["q"].tobytes() == q.tobytes()


def test_all_that_a_command_says_is_kept(tmp_path: Path) -> None:
    told = Command(0.5, -0.25, 0.125, 0.75, True, ((0.0, 1.0), (2.0, 3.0)), led=True, may_climb=False)
    assert all(getattr(told, field.name) != getattr(Command(), field.name) for field in fields(Command))
    controller, path = Controller(HUMANOID, Scene.load("empty"), seed=3), tmp_path / "told.elbow"
    with Recorder(path, controller) as recorder:
        for command in (told, Command()):
            recorder.append(controller.step(command, 0.0), 0.0)
    recording = Recording(path)
    (first, last), ways = recording.steps(), recording.ways
    assert command_of(first, way := way_from(ways, 0, ())) == told
    assert command_of(last, way_from(ways, 1, way)) == Command()


def test_the_header_tells_what_the_run_depends_on(run: tuple[Path, object]) -> None:
    header = Recording(run[0]).header
    assert header.settings.queue_size == 4
    assert header.settings.seed == 3
    assert Scene.from_dict(header.scene).name == "empty"
    assert header.machine["numba"]


def test_a_replay_is_identical(run: tuple[Path, object]) -> None:
    result = replay(Recording(run[0]), HUMANOID)
    assert result.identical
    assert result.frames == STEPS


def test_a_replay_finds_the_first_frame_that_differs(run: tuple[Path, object], tmp_path: Path) -> None:
    recording = Recording(run[0])
    steps = recording.steps().copy()
    steps["q"][100, 7] += 1e-9
    forged = tmp_path / "forged.elbow"
    data = zlib.compress(steps.tobytes())
    header = recording.header.to_json()
    head = MAGIC + struct.pack("<I", len(header)) + header + struct.pack("<I", zlib.crc32(header))
    chunk = struct.pack("<4sIII", b"CHNK", len(steps), len(data), zlib.crc32(data)) + data
    forged.write_bytes(head + chunk + struct.pack("<4sIII", b"DONE", len(steps), 0, zlib.crc32(data)))
    result = replay(Recording(forged), HUMANOID)
    assert result.difference is not None
    assert result.difference.frame == 100
    assert result.difference.angle == pytest.approx(1e-9, rel=1e-3)


@pytest.mark.parametrize("cut", [17, 23, 500])
def test_a_torn_file_is_read_to_its_last_whole_chunk(run: tuple[Path, object], tmp_path: Path, cut: int) -> None:
    torn = tmp_path / "torn.elbow"
    torn.write_bytes(run[0].read_bytes()[:-cut])
    recording = Recording(torn)
    assert len(recording.steps()) == 2 * STEPS_PER_CHUNK
    assert recording.note is not None
    assert replay(recording, HUMANOID).frames == 2 * STEPS_PER_CHUNK


def test_a_flipped_bit_ends_the_reading(run: tuple[Path, object], tmp_path: Path) -> None:
    data = bytearray(run[0].read_bytes())
    data[-36] ^= 4
    damaged = tmp_path / "damaged.elbow"
    damaged.write_bytes(data)
    recording = Recording(damaged)
    assert len(recording.steps()) == 2 * STEPS_PER_CHUNK
    assert recording.note is not None


@pytest.mark.parametrize(("cut", "steps", "told"), [(1, 150, "last bytes"), (16, 150, "without its end mark")])
def test_a_file_that_is_cut_between_two_chunks_is_told(
    run: tuple[Path, object], tmp_path: Path, cut: int, steps: int, told: str
) -> None:
    torn = tmp_path / "torn.elbow"
    torn.write_bytes(run[0].read_bytes()[:-cut])
    recording = Recording(torn)
    assert len(recording.steps()) == steps
    assert told in str(recording.note)
    assert f"step {steps}" in str(recording.note)


def test_a_file_that_lacks_a_chunk_or_has_one_of_another_run_is_told(run: tuple[Path, object], tmp_path: Path) -> None:
    """Each chunk by itself is sound."""
    whole = run[0].read_bytes()
    starts = [at for at in range(len(whole)) if whole[at : at + 4] == b"CHNK"]
    assert len(starts) == 3
    other = tmp_path / "other.elbow"
    other.write_bytes(whole[: starts[1]] + whole[starts[2] :])
    assert len(Recording(other).steps()) == STEPS - STEPS_PER_CHUNK
    for changed, told in (
        (whole[: starts[1]] + whole[starts[2] :], "it holds 90 of 150 steps"),
        (whole[: starts[1]] + whole[starts[0] : starts[1]] + whole[starts[2] :], "not those that were recorded"),
        (whole + b"x", "goes on after its end"),
    ):
        other.write_bytes(changed)
        recording = Recording(other)
        recording.steps()
        assert told in str(recording.note)


def written_as(recording: Recording, number: int, places: np.ndarray, path: Path) -> np.ndarray:
    """A recording as an older version wrote it, with the numbers of `q` at these places; its steps."""
    steps = recording.steps()
    sizes = {"q": len(places), "root": 7}
    fields = [(name, "<f8", sizes[name]) if name in sizes else (name, STEP[name]) for name in STEP.names or ()]
    old = np.zeros(len(steps), np.dtype(fields))
    for name, *_ in fields:
        old[name] = steps[name][:, places if name == "q" else np.arange(7)] if name in sizes else steps[name]
    header, data = recording.header.to_json(), zlib.compress(old.tobytes())
    end = struct.pack("<4sIII", b"DONE", len(old), 0, zlib.crc32(data)) if number > 2 else b""
    path.write_bytes(
        b"ELBOWROOM RECORDING %d\n" % number
        + struct.pack("<I", len(header)) + header + struct.pack("<I", zlib.crc32(header))
        + struct.pack("<4sIII", b"CHNK", len(old), len(data), zlib.crc32(data)) + data + end
    )  # fmt: skip
    return old


@pytest.mark.parametrize(("number", "places", "size"), [
    (1, np.delete(np.arange(14), LOWERING), 202),
    (2, np.arange(14), 210),
    (3, np.arange(14), 210),
    (4, np.arange(16), 226),
    (5, np.arange(16), 226),
])  # fmt: skip
def test_recordings_of_every_older_format_are_read(
    run: tuple[Path, object], tmp_path: Path, number: int, places: np.ndarray, size: int
) -> None:
    """Before the head was planned it followed the waist; before there was a lowering nobody was lowered.

    All ground was level before roots had a height.
    """
    recording = Recording(run[0])
    old = written_as(recording, number, places, tmp_path / "old.elbow")
    assert old.dtype.itemsize == size
    read = Recording(tmp_path / "old.elbow")
    steps, whole = read.steps(), recording.steps()
    assert read.note is None
    np.testing.assert_array_equal(steps["q"][:, places], whole["q"][:, places])
    if number < 4:
        np.testing.assert_array_equal(steps["q"][:, DofGroup.HEAD.at], followed(steps["q"][:, 3:])[:, 11:])
        assert not steps["q"][:, LOWERING].any()
    np.testing.assert_array_equal(steps["root"][:, :ROOT_STATE], whole["root"][:, :ROOT_STATE])
    assert roots_of(whole).shape[1] == SHOWN
    assert roots_of(steps).shape[1] == ROOT_STATE  # their feet are those of the walking cycle


def test_an_old_recording_replays_but_for_the_head(run: tuple[Path, object], tmp_path: Path) -> None:
    """Nothing of the walk has changed with the head where nothing is near; what it shows now differs, and is told."""
    written_as(Recording(run[0]), 3, np.arange(14), tmp_path / "old.elbow")
    again = replay(Recording(tmp_path / "old.elbow"), HUMANOID)
    assert not again.identical
    assert len(Recording(tmp_path / "old.elbow").steps()) == STEPS


def test_steps_are_on_disk_before_the_recorder_is_closed(tmp_path: Path) -> None:
    path = tmp_path / "crash.elbow"
    controller = Controller(HUMANOID, Scene.load("empty"))
    recorder = Recorder(path, controller)
    for _ in range(STEPS_PER_CHUNK + 5):
        recorder.append(controller.step(Command(), 0.01), 0.01)
    assert len(Recording(path).steps()) == STEPS_PER_CHUNK
    recorder.close()
    recorder.close()
    assert len(Recording(path).steps()) == STEPS_PER_CHUNK + 5


def test_a_recording_is_replaced_and_another_file_is_not(tmp_path: Path) -> None:
    path = tmp_path / "run.elbow"
    record(path, 5)
    record(path, 3)
    assert len(Recording(path).steps()) == 3
    letter = tmp_path / "letter.txt"
    letter.write_text("Dear reader,")
    with pytest.raises(InputError, match="no recording"):
        record(letter, 3)
    assert letter.read_text() == "Dear reader,"


def test_a_folder_that_is_not_there_is_a_plain_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be written"):
        record(tmp_path / "nowhere" / "run.elbow", 3)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"hello",
        MAGIC,
        MAGIC + b"\xff\xff\xff\xff",
        MAGIC + struct.pack("<I", 2) + b"{}" + struct.pack("<I", zlib.crc32(b"{}")),
        MAGIC + struct.pack("<I", 2) + b"{}" + b"0000",
        MAGIC + struct.pack("<I", 10) + b"{}",
    ],
)
def test_hostile_headers_are_plain_errors(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "hostile.elbow"
    path.write_bytes(data)
    with pytest.raises(InputError, match=r"hostile\.elbow"):
        Recording(path)


def test_a_recording_of_another_version_is_told_as_one(tmp_path: Path, run: tuple[Path, object]) -> None:
    path = tmp_path / "newer.elbow"
    path.write_bytes(run[0].read_bytes().replace(MAGIC, MAGIC[:-2] + b"9\n", 1))
    with pytest.raises(InputError, match=r"newer\.elbow: was recorded by another version.*format is 9"):
        Recording(path)


def test_nested_json_in_a_header_is_a_plain_error(tmp_path: Path) -> None:
    text = b"[" * 100_000
    path = tmp_path / "deep.elbow"
    path.write_bytes(MAGIC + struct.pack("<I", len(text)) + text + struct.pack("<I", zlib.crc32(text)))
    with pytest.raises(InputError, match=r"deep\.elbow"):
        Recording(path)


def test_what_a_header_says_is_repeated_in_part(tmp_path: Path, run: tuple[Path, object]) -> None:
    document = json.loads(Recording(run[0]).header.to_json())
    document["settings"]["assis\n" + "[[ " * 5000] = 1
    text = json.dumps(document).encode()
    path = tmp_path / "long.elbow"
    path.write_bytes(MAGIC + struct.pack("<I", len(text)) + text + struct.pack("<I", zlib.crc32(text)))
    with pytest.raises(InputError, match=r"long\.elbow: the header does not describe a run") as raised:
        Recording(path)
    assert len(str(raised.value)) < 600
    assert "\n" not in str(raised.value)


def test_a_missing_file_is_a_plain_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        Recording(tmp_path / "none.elbow")


def test_a_bomb_is_not_inflated(run: tuple[Path, object], tmp_path: Path) -> None:
    whole = run[0].read_bytes()
    header_end = len(MAGIC) + 4 + struct.unpack_from("<I", whole, len(MAGIC))[0] + 4
    bomb = zlib.compress(bytes(50_000_000), 9)
    for count in (1, recordings.MAX_CHUNK_STEPS, 2**32 - 1):
        path = tmp_path / f"bomb{count}.elbow"
        chunk = struct.pack("<4sIII", b"CHNK", count, len(bomb), zlib.crc32(bomb)) + bomb
        path.write_bytes(whole[:header_end] + chunk)
        recording = Recording(path)
        assert len(recording.steps()) == 0
        assert recording.note is not None


def test_no_more_is_read_than_fits_and_what_fits_is(run: tuple[Path, object], monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps in which somebody stands are packed a thousand to one: a small file may hold more than any memory."""
    whole, recording = Recording(run[0]).steps(), Recording(run[0])
    monkeypatch.setattr(recordings, "MOST_ROWS", 2 * STEPS_PER_CHUNK)
    steps = recording.steps()
    assert len(steps) == 2 * STEPS_PER_CHUNK < len(whole)
    assert steps.tobytes() == whole[: len(steps)].tobytes()
    assert recording.note == f"only the first {len(steps)} steps are read: more would not fit into memory"


def test_the_step_record_is_fixed() -> None:
    assert STEP.itemsize == 522


@pytest.mark.long
def test_a_walk_in_a_place_with_steps_replays_without_its_file(tmp_path: Path) -> None:
    place = write_place(tmp_path / "rooms.glb", {**TWO_ROOMS, "Podium": ((0, 0.08, 6.5), (4.0, 0.16, 2.0))})
    scene = Scene.load(place, PlaceOptions(drop=("Door_*",)))
    assert not scene.ground.plain
    controller, path = Controller(HUMANOID, scene, seed=3), tmp_path / "rooms.elbow"
    with Recorder(path, controller) as recorder:
        for _ in range(60):
            recorder.append(controller.step(Command(forward=1.0), 1 / 60), 1 / 60)
    place.unlink()
    assert replay(Recording(path), HUMANOID).identical
    start = scene.start._replace(x=-2.1)  # in the wall
    with pytest.raises(InputError, match="stands in the obstacle 'Wall_west"):
        Scene.from_dict({**scene.to_dict(), "start": {"position": [start.x, start.z]}})


def test_an_old_recording_may_be_replaced(run: tuple[Path, object], tmp_path: Path) -> None:
    path = tmp_path / "old.elbow"
    written_as(Recording(run[0]), 1, np.delete(np.arange(14), LOWERING), path)
    record(path, 3)
    assert Recording(path).path.read_bytes().startswith(MAGIC)


def test_a_run_with_motions_of_its_own_replays_bit_for_bit(tmp_path: Path) -> None:
    rng = np.random.default_rng(8)
    clip = parse_motion(write_bvh(random_motion(rng, 40, smooth=8.0), BvhRecipe()), "dodge.bvh").clip()
    keys = {group: np.tile(clamp(group, rng.uniform(-0.3, 0.3, group.size)), (KEYS + 1, 1)) for group in LOCAL_GROUPS}
    motions = MotionSet(Swing("made", 1.0, keys), motions_of(dodge=(clip,)).dodges)
    controller = Controller(HUMANOID, Scene.load("a"), seed=3, motions=motions)
    path = tmp_path / "own.elbow"
    with Recorder(path, controller) as recorder:
        for _ in range(90):
            frame = controller.step(Command(forward=1.0), 1 / 60)
            recorder.append(frame, 1 / 60)
    assert replay(Recording(path), HUMANOID).identical
    stock = Controller(HUMANOID, Scene.load("a"), seed=3)
    for _ in range(90):
        other = stock.step(Command(forward=1.0), 1 / 60)
    assert np.abs(frame.q[3:] - other.q[3:]).max() > 0.05
