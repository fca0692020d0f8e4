"""A run as a page that plays by itself, and in a notebook."""

import gzip
import json
import re
import struct
from base64 import b64decode
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import elbowroom as er
from elbowroom.control.recordings.recording import Recorder, Recording
from elbowroom.server.app import client_is_built
from elbowroom.server.sessions.reports import avatar_message
from elbowroom.server.standalone.frames import posed_frames
from elbowroom.server.standalone.packed_run import PER_METRE, RATE, UNIT, PackedRun, pack_run, read_run
from elbowroom.server.standalone.page import page_of_recording
from elbowroom.server.stores.avatar_store import StoredAvatar
from elbowroom.server.wire.codec import plain
from elbowroom.server.wire.pose_frame import parse

STEP = 1 / 60
BUILT = pytest.mark.skipif(not client_is_built(), reason="the page is not built")


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("standalone") / "walk.elbow"
    controller = er.Controller(er.Humanoid.default(), er.Scene.load("doorway"))
    with Recorder(path, controller) as recorder:
        for _ in range(240):
            command = er.Command(forward=1.0)
            recorder.append(controller.step(command, STEP), STEP)
    return path


def part(page: str, name: str) -> bytes:
    text = re.search(f'id="{name}">([^<]*)<', page)
    assert text is not None
    return gzip.decompress(b64decode(text.group(1)))


def unpacked(data: bytes) -> tuple[dict[str, Any], np.ndarray, dict[str, np.ndarray], np.ndarray, np.ndarray, bytes]:
    """The slow obvious reader: head, times, scalars, rotations, capsules, avatar."""
    (length,) = struct.unpack_from("<I", data)
    head, at = json.loads(data[4 : 4 + length]), 4 + length
    count = head["frames"]

    def floats() -> np.ndarray:
        nonlocal at
        found = np.frombuffer(data, "<f4", count, at)
        at += 4 * count
        return found

    def shorts(columns: int, unit: float) -> np.ndarray:
        nonlocal at
        steps = np.frombuffer(data, "<i2", columns * count, at).reshape(columns, count)
        at += 2 * columns * count
        return (np.cumsum(steps, axis=1, dtype=np.int64).astype(np.int16) / unit).T

    times = floats()
    scalars = {name: floats() for name in head["scalars"]}
    rotations, capsules = shorts(4 * head["joints"], UNIT), shorts(6 * head["capsules"], PER_METRE)
    assert len(data) == at + head["avatarBytes"]
    return head, times, scalars, rotations, capsules, data[at:]


def test_what_is_packed_is_what_was_shown(walk: Path) -> None:
    recording, humanoid = Recording(walk), er.Humanoid.default()
    frames = posed_frames(recording, humanoid)
    stored = StoredAvatar("avatar", humanoid, None)
    avatar = plain(avatar_message(stored, 0))
    run = PackedRun({"name": "w", "planner": "exact", "scene": {}, "avatar": avatar}, b"".join(frames), None)
    head, times, scalars, rotations, capsules, file = unpacked(pack_run(run))
    parsed = [parse(frame) for frame in frames]
    assert head["frames"] == pytest.approx(240 * RATE / 60, abs=2)
    for time, turn, ends, x, z in zip(times, rotations, capsules, scalars["x"], scalars["z"], strict=True):
        shown = min(parsed, key=lambda frame: abs(frame.time - parsed[0].time - time))
        np.testing.assert_allclose(turn, shown.rotations.ravel(), atol=1e-4)
        np.testing.assert_allclose(
            ends.reshape(-1, 2, 3) + np.array([x, 0.0, z]), shown.capsules.reshape(-1, 2, 3), atol=3e-4
        )
        assert x == pytest.approx(shown.x)
    assert file == b""
    with pytest.raises(er.InputError, match="damaged"):
        pack_run(run._replace(frames=run.frames[:-3]))
    with pytest.raises(er.InputError, match="not of this avatar"):
        pack_run(run._replace(head={**run.head, "avatar": {**avatar, "bones": []}}))


@pytest.mark.parametrize(
    "data", [b"", b"\0\0", struct.pack("<I", 9) + b"{}", struct.pack("<I", 2) + b"{}", b"\xff" * 40]
)
def test_what_is_no_run_is_refused(data: bytes) -> None:
    with pytest.raises(er.InputError, match="no run"):
        read_run(data)


def test_a_head_of_millions_of_things_is_not_even_read() -> None:
    """It would hold the frames of others up, and take a hundred times its size."""
    head = b'{"scene": {}, "avatar": {}, "name": "x", "more": [' + b"{}," * 1_500_000 + b"{}]}"
    with pytest.raises(er.InputError, match="longer than 4194304 bytes"):
        read_run(len(head).to_bytes(4, "little") + head)
    short = b'{"scene": {}, "avatar": {}, "name": "x"}'
    assert read_run(len(short).to_bytes(4, "little") + short + b"1")[1] == b"1"


@BUILT
def test_a_page_fetches_nothing_and_stays_small(walk: Path) -> None:
    page, notes = page_of_recording(Recording(walk), er.Humanoid.default(), "walk.elbow")
    assert notes == ()
    assert not re.search(r'(?:src|href)="(?!#)', page)
    run, player = part(page, "run"), part(page, "player")
    head, *_, file = unpacked(run)
    assert head["scene"]["name"] == "doorway"
    assert file[:4] == b"glTF"
    assert len(gzip.compress(run)) + len(gzip.compress(player)) < 700_000
    assert len(gzip.compress(run[: -len(file)])) < 60_000


@BUILT
def test_an_avatar_that_may_not_be_handed_on_is_shown_by_its_capsules(walk: Path) -> None:
    humanoid = er.Humanoid.default()
    permissions = replace(humanoid.meta.permissions, redistribution=False)
    own = replace(humanoid, meta=replace(humanoid.meta, permissions=permissions))
    page, notes = page_of_recording(Recording(walk), own, "walk.elbow")
    assert "forbids redistribution" in notes[0]
    head, *_, file = unpacked(part(page, "run"))
    assert file == b""
    assert head["avatar"]["drawCapsules"]
    assert head["capsules"] > 10


@BUILT
def test_a_notebook_shows_a_run_in_a_frame_of_its_own(walk: Path, tmp_path: Path) -> None:
    shown = er.show(walk, height=300)
    frame = shown._repr_html_()
    found = re.fullmatch(r'<iframe title="Elbowroom" style="[^"]*height:300px[^"]*" srcdoc="([^"]*)"></iframe>', frame)
    assert found is not None
    assert unescape(found.group(1)) == shown.html
    assert shown.save(tmp_path / "walk.html").read_text("utf-8") == shown.html
    with pytest.raises(er.InputError, match="height"):
        er.show(walk, height=5)
