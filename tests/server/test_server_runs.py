"""Recordings on their way to a page: read apart, posed as they were shown, sent in one answer."""

import json
import struct
import urllib.error
import urllib.request
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.cli.replay import library_of
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.recordings.avatar_reference import AvatarReference
from elbowroom.control.recordings.recording import Recorder, Recording, RecordingHeader
from elbowroom.planning.command import Command
from elbowroom.server.sessions.reports import scene_message
from elbowroom.server.standalone.frames import posed_run
from elbowroom.server.stores.library import Library
from elbowroom.server.wire.pose import Poser
from elbowroom.server.wire.pose_frame import PoseFrame, parse
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.same_model import with_model_beside
from elbowroom.world.scene import Scene
from live_session import running
from place_builder import TWO_ROOMS, glb, write_place

STEP = 1.0 / 60.0
RESTART_AT = 40


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[Frame]]:
    """A recorded walk that is put back to its start once, and the frames that were shown."""
    file = tmp_path_factory.mktemp("runs") / "walk.elbow"
    controller = Controller(Humanoid.default(), Scene.load("doorway"), assist=False)
    frames = []
    with Recorder(file, controller) as recorder:
        for i in range(90):
            if i == RESTART_AT:
                controller.reset()
            frames.append(controller.step(Command(forward=1.0), 0.0 if i == 20 else STEP))
            dt = 0.0 if i == 20 else STEP
            recorder.append(frames[-1], dt)
    return file, frames


def unpack(answer: bytes) -> tuple[dict[str, Any], list[PoseFrame]]:
    length = struct.unpack_from("<I", answer)[0]
    head, body = json.loads(answer[4 : 4 + length]), answer[4 + length :]
    size = head["frameBytes"]
    assert len(body) == size * head["frames"]
    return head, [parse(body[i : i + size]) for i in range(0, len(body), size)]


def ask(url: str, data: bytes | None = None) -> bytes:
    with urllib.request.urlopen(urllib.request.Request(url, data), timeout=120) as response:
        return bytes(response.read())


def refusal(url: str, data: bytes | None = None) -> tuple[int, str]:
    with pytest.raises(urllib.error.HTTPError) as caught:
        ask(url, data)
    return caught.value.code, json.load(caught.value)["error"]


@pytest.mark.long
def test_a_run_is_what_was_shown(walk: tuple[Path, list[Frame]]) -> None:
    file, shown = walk
    poser, model = Poser(Humanoid.default()), Humanoid.default()
    with closing(Library.open()) as library, running(library) as url:
        head, frames = unpack(ask(f"{url}/api/runs?name=mine.elbow", file.read_bytes()))
        assert (head["name"], head["planner"], head["standIn"], head["note"]) == ("mine.elbow", "exact", "", "")
        assert (head["scene"]["name"], head["avatar"]["revision"]) == ("doorway", 0)
        assert len(head["avatar"]["bones"]) == len(model.skeleton.names)
        assert refusal(f"{url}/api/runs?name=cut.elbow", file.read_bytes()[:300])[0] == 422
        code, why = refusal(f"{url}/api/runs?name=no.elbow", b"something else")
        assert (code, why.startswith("no.elbow: is no recording")) == (422, True)
        assert refusal(f"{url}/api/run")[0] == 404
    visible = [
        frame for i, frame in enumerate(shown) if i != 19
    ]  # the step of no time takes the place of the one before
    assert len(frames) == len(visible)
    for sent, frame in zip(frames, visible, strict=True):
        posed = poser.node_pose(frame.q, frame.root)
        np.testing.assert_array_equal(sent.rotations, posed.rotations)
        np.testing.assert_allclose([sent.x, sent.z, sent.heading], frame.root[:3], atol=1e-6)
        assert sent.clearance == pytest.approx(frame.clearance, abs=1e-6)
        assert sent.flag("touching") == frame.touching
        assert not sent.flag("assist")
    times = [frame.time for frame in frames]
    assert times == sorted(set(times))
    restarted = [sent.epoch for sent in frames]
    assert restarted == [0] * (RESTART_AT - 1) + [1] * (len(frames) - RESTART_AT + 1)


def test_a_recording_of_an_avatar_that_is_not_here_is_shown_on_the_stock_one(
    walk: tuple[Path, list[Frame]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file, _ = walk
    recording = Recording(file)
    stranger = replace(recording.header.avatar, name="Alice", stock=False, sha256="0" * 64, path="/nowhere/alice.vrm")
    header = replace(recording.header, avatar=stranger)
    monkeypatch.setattr(RecordingHeader, "of", lambda _: header)
    with Recorder(tmp_path / "other.elbow", None) as recorder:  # type: ignore[arg-type]
        for step in recording.steps():
            recorder._pending.append(tuple(step))
    run = posed_run(tmp_path / "other.elbow", {})
    assert (run.stand_in, run.avatar, run.count) == ("Alice", "", 89)
    known = {"alice": replace(AvatarReference.of(Humanoid.default()), stock=False, path=str(Humanoid.default().source))}
    assert posed_run(tmp_path / "other.elbow", known).stand_in == "Alice"
    assert posed_run(file, known).stand_in == ""


@pytest.mark.long
def test_a_recording_named_on_the_command_line_is_what_the_page_opens_with(walk: tuple[Path, list[Frame]]) -> None:
    file, shown = walk
    with closing(library_of(Recording(file), None)) as library, running(library) as url:
        assert library.scene == "doorway"
        head, frames = unpack(ask(f"{url}/api/run"))
    assert head["name"] == "walk.elbow"
    assert frames[-1].z == pytest.approx(shown[-1].root[1], abs=1e-6)


@pytest.mark.long
def test_a_run_in_a_place_is_shown_by_its_model(tmp_path: Path) -> None:
    """By the one that this server shows, or the one that lies beside the recording; else by its triangles."""
    model = write_place(tmp_path / "rooms.glb")
    scene, file = Scene.load(model, PlaceOptions(drop=("Door_*",))), tmp_path / "walk.elbow"
    controller = Controller(Humanoid.default(), scene, assist=False)
    with Recorder(file, controller) as recorder:
        recorder.append(controller.step(Command(), STEP), STEP)
    with closing(Library.open(scene)) as library, running(library) as url:
        told, _ = unpack(ask(f"{url}/api/runs?name=walk.elbow", file.read_bytes()))
        live = json.loads(ask(f"{url}/api/scenes/{scene.name}"))
    assert told["scene"]["model"] == live["model"]
    assert told["scene"]["obstacles"] == []
    with closing(library_of(Recording(file), None)) as library:
        assert scene_message(library.scenes[library.scene]).model is not None
    model.write_bytes(glb({name: TWO_ROOMS[name] for name in list(TWO_ROOMS)[:-1]}))
    with closing(library_of(Recording(file), None)) as library:
        shown = scene_message(library.scenes[library.scene])
    assert shown.model is None
    assert {one.form.shape for one in shown.obstacles} == {"mesh"}


def test_a_model_beside_a_run_that_cannot_be_read_is_done_without(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def closed(*_: object) -> None:
        raise PermissionError

    scene = Scene.load(write_place(tmp_path / "rooms.glb"))
    monkeypatch.setattr("elbowroom.world.places.same_model.read_place", closed)
    assert with_model_beside(scene, tmp_path) is scene
