"""Live sessions over a real WebSocket."""

import gc
import json
import math
import socket
import struct
import time
import weakref
from collections.abc import Iterator
from contextlib import closing
from itertools import pairwise
from pathlib import Path
from typing import Any
from urllib.request import urlopen

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from elbowroom.clips.style import STYLES
from elbowroom.control.recordings.recording import Recording
from elbowroom.server.clip_walk import ClipWalk
from elbowroom.server.entrance import admission
from elbowroom.server.schema.bounds import MAX_MESSAGE
from elbowroom.server.schema.commands import ClockMessage, Configure, Goto, Overlays, Ping, Reset
from elbowroom.server.schema.menus import Hello, Settings
from elbowroom.server.schema.picture import AvatarMessage, SceneMessage
from elbowroom.server.schema.progress import Crossed, Going, Loading, Notice, Plan, Status
from elbowroom.server.sessions import changes, session
from elbowroom.server.sessions.walk import Walk
from elbowroom.server.stores.library import Library
from elbowroom.server.wire.pose_frame import PoseFrame
from live_session import LONG, Client, client_at, client_of, running


@pytest.fixture(scope="module")
def url() -> Iterator[str]:
    with closing(Library.open("empty")) as library, running(library) as address:
        yield address


@pytest.fixture
def client(url: str) -> Iterator[Client]:
    with client_of(url) as made:
        yield made


def test_a_session_begins_with_all_that_a_page_needs(client: Client) -> None:
    hello = client.wait_for(Hello)
    settings = client.wait_for(Settings)
    scene, avatar, frame = client.wait_for(SceneMessage), client.wait_for(AvatarMessage), client.frame()
    assert {choice.name for choice in hello.catalog.scenes} >= {"a", "b", "c", "d", "empty"}
    assert (settings.scene, settings.planner, scene.name) == ("empty", "exact", "empty")
    assert settings.avatar == avatar.id
    assert len(frame.rotations) == len(avatar.bones)
    assert frame.avatar_revision == avatar.revision
    assert (frame.x, frame.z) == pytest.approx((scene.start.x, scene.start.z))
    np.testing.assert_allclose(np.linalg.norm(frame.rotations, axis=1), 1.0, atol=1e-5)


@pytest.mark.parametrize(("asked", "first"), [("b", "b"), ("nowhere", "empty"), ("gauntlet:1:0", "empty")])
def test_a_session_begins_in_the_scene_that_is_asked_for_if_it_is_at_hand(url: str, asked: str, first: str) -> None:
    with client_at(f"{url}/ws?scene={asked}") as client:
        assert client.wait_for(SceneMessage).name == first


def test_walking_forward_and_letting_go(client: Client) -> None:
    start = client.frame()
    seq = client.press(forward=1.0)
    heading = np.array([math.sin(start.heading), math.cos(start.heading)])
    walking = client.frame(lambda f: bool(heading @ [f.x - start.x, f.z - start.z] > 1.0))
    assert walking.acknowledged == seq
    assert walking.forward > 0.3
    assert walking.gait > start.gait
    seq = client.press()
    stopped = client.frame(lambda f: f.acknowledged == seq and f.forward == 0.0)
    assert not stopped.flag("stuck")


def test_time_runs_forward_and_poses_follow_it(client: Client) -> None:
    seq = client.press(forward=1.0)
    client.frame(lambda f: f.acknowledged == seq)  # before it the avatar stood, and few frames came
    frames = [client.frame() for _ in range(60)]
    for before, after in pairwise(frames):
        assert after.time > before.time
        assert after.index > before.index
        assert 0.0 <= after.sim_time - before.sim_time < 0.2
        assert math.hypot(after.x - before.x, after.z - before.z) < 0.2


def test_simulated_time_is_never_faster_than_the_clock(client: Client) -> None:
    first = client.frame()
    for i in range(100):
        client.press(forward=1.0 if i % 2 else 0.4)
        client.receive()
    last = client.frame()
    assert last.sim_time - first.sim_time <= last.time - first.time + 0.05


def test_the_avatar_walks_towards_a_wanted_direction(client: Client) -> None:
    start = client.frame()
    client.press(forward=1.0, direction=start.heading + 1.5)
    moved = client.frame(lambda f: math.hypot(f.x - start.x, f.z - start.z) > 1.0)
    assert 0.5 < moved.heading - start.heading < 2.5


def test_a_silent_client_lets_go(client: Client) -> None:
    client.press(forward=1.0)
    client.frame(lambda f: f.forward > 0.3)
    client.hold = None
    client.frame(lambda f: f.forward == 0.0)


def test_pause_steps_and_slow_motion(client: Client) -> None:
    client.send(ClockMessage(paused=True))
    client.wait_for(Settings, lambda settings: settings.paused)
    held = client.frame(lambda f: f.flag("paused"))
    assert client.frame().sim_time == held.sim_time
    client.send(ClockMessage(steps=2))
    stepped = client.frame(lambda f: f.sim_time > held.sim_time)
    assert stepped.sim_time == pytest.approx(held.sim_time + 2 / 60)
    client.send(ClockMessage(paused=False, speed=0.25))
    first = client.frame(lambda f: not f.flag("paused"))
    later = client.frame(lambda f: f.time > first.time + 0.5)
    assert 0.0 < later.sim_time - first.sim_time < 0.5 * (later.time - first.time)


def test_reset_puts_the_avatar_back(client: Client) -> None:
    start = client.frame()
    client.press(forward=1.0)
    away = client.frame(lambda f: math.hypot(f.x - start.x, f.z - start.z) > 0.5)
    client.press()
    client.send(Reset())
    back = client.frame(lambda f: f.epoch != away.epoch)
    assert math.hypot(back.x - start.x, back.z - start.z) < 0.2


def test_overlays_bring_capsules_and_the_plan(client: Client) -> None:
    avatar = client.wait_for(AvatarMessage)
    assert len(client.frame().capsules) == 0
    client.send(Overlays(capsules=True, plan=True))
    frame = client.frame(lambda f: len(f.capsules) > 0)
    assert len(frame.capsules) == len(avatar.capsules)
    client.press(forward=1.0)
    plan = client.wait_for(Plan, lambda plan: len(plan.ghosts) > 0)
    assert len(plan.times) == len(plan.root) == len(plan.ghosts)
    for segments in (*plan.ghosts, plan.goal, plan.chosen):
        assert len(segments) == 6 * len(avatar.capsules)
    feet = frame.capsules[[i for i, capsule in enumerate(avatar.capsules) if capsule.name.endswith("Foot")]]
    assert np.abs(feet[:, [1, 4]]).max() < 0.3


def test_settings_change_while_walking(client: Client) -> None:
    client.press(forward=1.0)
    client.frame(lambda f: f.forward > 0.3)
    client.send(Configure(scene="a", queue_size=7))
    assert client.wait_for(Loading, lambda loading: not loading.active and loading.name == "a").what == "scene"
    scene = client.wait_for(SceneMessage)
    assert scene.name == "a"
    assert len(scene.obstacles) >= 4
    assert client.wait_for(Settings).queue_size == 7
    client.send(Overlays(capsules=True))
    status = client.wait_for(Status, lambda status: status.nearest is not None)
    assert status.nearest is not None
    assert status.nearest.obstacle in {one.name for one in scene.obstacles}
    assert status.clearance == pytest.approx(status.nearest.distance, abs=1e-3)
    client.send(Configure(assist=False, walk_speed=0.5))
    assert client.wait_for(Settings, lambda settings: not settings.assist).walk_speed == 0.5
    assert client.frame(lambda f: not f.flag("assist"))


def test_a_new_queue_size_keeps_the_place(client: Client) -> None:
    start = client.frame()
    client.press(forward=1.0)
    client.frame(lambda f: math.hypot(f.x - start.x, f.z - start.z) > 1.0)
    client.send(Configure(queue_size=3))
    client.wait_for(Settings, lambda settings: settings.queue_size == 3)
    after = client.frame()
    assert math.hypot(after.x - start.x, after.z - start.z) > 0.9


def test_a_style_of_walking_is_taken_and_an_unknown_one_told(client: Client) -> None:
    client.send(Configure(style="old"))
    settings = client.wait_for(Settings, lambda settings: settings.style == "old")
    assert settings.walk_speed == STYLES["old"].speed
    client.send(Configure(style="olde"))
    assert "none of plain" in client.wait_for(Notice, lambda notice: notice.level == "error").message
    assert client.wait_for(Settings).style == "old"


def test_crossing_the_finish_is_told(client: Client) -> None:
    client.send(Configure(walk_speed=2.0))
    client.send(ClockMessage(speed=2.0))
    client.press(forward=1.0, run=True)
    crossed = client.wait_for(Crossed)
    assert crossed.count == 1
    assert crossed.seconds > 1.0
    assert client.frame(lambda f: f.flag("finished"))
    client.send(Reset())
    assert client.frame(lambda f: not f.flag("finished"))
    assert client.wait_for(Status).crossed == 1


def test_who_has_crossed_the_finish_walks_on_past_the_end_of_the_floor(client: Client) -> None:
    scene = client.wait_for(SceneMessage)
    end = scene.ground.center[1] + scene.ground.size[1] / 2
    client.send(Configure(walk_speed=2.0))
    client.send(ClockMessage(speed=2.0))
    client.press(forward=1.0, run=True)
    gate = client.frame(lambda f: f.flag("finished"))
    beyond = [client.frame(lambda f, at=z: f.z > at) for z in (gate.z + 1.0, end, end + 3.0)]  # type: ignore[misc]
    for frame in beyond:
        assert (frame.flag("finished"), frame.flag("stuck"), frame.epoch) == (True, False, gate.epoch)
        assert frame.forward > 1.0
    assert client.wait_for(Status).crossed == 1


def test_an_unknown_choice_is_refused_and_the_old_one_stays(client: Client) -> None:
    client.wait_for(AvatarMessage)
    for message in (Configure(scene="nowhere"), Configure(avatar="nobody"), Configure(planner="magic")):
        client.send(message)
        assert "no" in client.complaint()
        settings = client.wait_for(Settings)
        assert (settings.scene, settings.planner) == ("empty", "exact")


def test_what_is_known_is_done_although_another_choice_is_not(client: Client) -> None:
    client.send(Configure(scene="b", avatar="gone"))
    assert "drop its file" in client.complaint()
    assert client.wait_for(SceneMessage, lambda scene: scene.name == "b")
    assert client.wait_for(Settings).avatar == "stock"


def test_each_choice_that_does_not_exist_is_named(client: Client) -> None:
    """As an address asks for them: ?planner=zzz&queue=99&speed=9&avatar=nope&scene=b"""
    client.send(Configure(scene="b", planner="zzz", queue_size=99, walk_speed=9.0, avatar="nope"))
    complaints = "\n".join(client.complaint() for _ in range(4))
    for said in ("'zzz'", "99", "9", "'nope'"):
        assert said in complaints
    settings = client.wait_for(Settings, lambda settings: settings.scene == "b")
    assert (settings.planner, settings.avatar) == ("exact", "stock")


def test_a_change_that_fails_inside_leaves_the_session_alone(
    client: Client, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    client.frame()

    def fail(*_: object) -> None:
        raise RuntimeError("a fault while loading")

    monkeypatch.setattr(changes, "make_walk", fail)
    client.send(Configure(scene="c"))
    assert "failed inside" in client.complaint()
    assert client.wait_for(Settings).scene == "empty"
    assert client.is_served()
    assert "a fault while loading" in caplog.text


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "null",
        "[]",
        '{"type": "fly"}',
        '{"type": "input", "seq": "1"}',
        "[" * 50_000,
        '{"type": "clock", "speed": 1e9}',
    ],
)
def test_wrong_messages_are_answered_and_do_no_harm(client: Client, text: str) -> None:
    client.connection.send(text)
    assert client.complaint()
    assert client.is_served()


def test_binary_messages_are_answered_and_do_no_harm(client: Client) -> None:
    client.connection.send(bytes(range(256)))
    assert "binary" in client.complaint()
    assert client.is_served()


def test_a_client_that_sends_only_nonsense_is_closed(url: str, client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(session, "_PATIENCE", 5)
    with client_of(url) as other:
        for _ in range(5):
            other.connection.send("nonsense")
        with pytest.raises(ConnectionClosed) as caught:
            other.wait_for(Status, lambda _: False)
    assert caught.value.rcvd is not None
    assert caught.value.rcvd.code == 1008
    assert client.is_served()


def test_a_huge_message_closes_only_its_own_connection(url: str, client: Client) -> None:
    with client_of(url) as other:
        other.connection.send("x" * (MAX_MESSAGE + 1))
        with pytest.raises(ConnectionClosed) as caught:
            other.wait_for(Status, lambda _: False)
    assert caught.value.rcvd is not None
    assert caught.value.rcvd.code == 1009
    assert client.is_served()


def test_a_flood_is_cut(client: Client) -> None:
    for i in range(600):
        client.send(Ping(float(i)))
        if i % 60 == 0:
            client.receive()
    assert "too many messages" in client.complaint()


def test_steps_that_are_asked_for_at_once_are_counted_like_messages(client: Client) -> None:
    for _ in range(20):
        client.send(ClockMessage(steps=60))
    assert "too many steps" in client.complaint()
    client.send(ClockMessage(paused=False))


def test_an_abrupt_end_does_no_harm(url: str, client: Client) -> None:
    with client_of(url) as other:
        other.frame()
        raw = other.connection.socket
        raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        raw.close()
    assert client.is_served()


def test_a_client_that_never_reads_does_not_hold_up_the_others(url: str, client: Client) -> None:
    with client_of(url, max_queue=1):
        client.press(forward=1.0)
        start = client.frame()
        assert client.frame(lambda f: f.sim_time > start.sim_time + 1.0)


def test_two_sessions_do_not_touch_each_other(url: str, client: Client) -> None:
    with client_of(url) as other:
        here, there = client.frame(), other.frame()
        client.press(forward=1.0)
        walked = client.frame(lambda f: math.hypot(f.x - here.x, f.z - here.z) > 1.0)
        stayed = other.frame(lambda f: f.time > there.time + 0.5)
        assert math.hypot(stayed.x - there.x, stayed.z - there.z) < 1e-6
        assert walked.epoch == here.epoch


def test_a_failure_inside_ends_one_session_with_a_word(
    url: str, client: Client, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    client.frame()
    whole = Walk.step

    def fail_when_turning(walk: Walk, command: object, dt: float) -> object:
        if getattr(command, "turn", 0.0) == 0.125:
            raise RuntimeError("a fault in the planner")
        return whole(walk, command, dt)  # type: ignore[arg-type]

    monkeypatch.setattr(Walk, "step", fail_when_turning)
    with client_of(url) as other:
        other.frame()
        other.press(turn=0.125)
        assert "failed inside" in other.complaint()
        with pytest.raises(ConnectionClosed):
            other.wait_for(Status, lambda _: False)
    assert "a fault in the planner" in caplog.text
    assert client.is_served()


def test_the_number_of_sessions_is_bounded(url: str, client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    client.frame()
    monkeypatch.setattr(admission, "MOST", 1)
    with client_of(url) as other:
        assert "sessions already" in other.complaint()
        with pytest.raises(ConnectionClosed):
            other.wait_for(PoseFrame)
    assert client.is_served()


def test_a_page_elsewhere_is_refused(url: str) -> None:
    for origin in ("http://evil.example", "null", "http://127.0.0.1:1"):
        with pytest.raises(InvalidStatus, match="403"), client_of(url, origin=origin):
            pass
    with client_of(url, origin=url) as own:
        assert own.frame()


def test_a_foreign_host_name_is_refused(url: str) -> None:
    port = url.rpartition(":")[2]
    with (
        pytest.raises(InvalidStatus, match="403"),
        client_of(
            f"http://rebound.example:{port}", address=("127.0.0.1", int(port)), origin=f"http://rebound.example:{port}"
        ),
    ):
        pass


def test_a_session_that_has_ended_leaves_nothing(url: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its walk goes at once, without looking for garbage: that is looked for seldom, and walks are large."""
    walks: list[weakref.ref[Walk | ClipWalk]] = []
    made = changes.make_walk

    def noted(*arguments: Any) -> Walk | ClipWalk:
        walk = made(*arguments)
        walks.append(weakref.ref(walk))
        return walk

    monkeypatch.setattr(changes, "make_walk", noted)
    gc.disable()
    try:
        for abrupt in (False, True):
            with client_of(url) as other:
                other.frame()
                if abrupt:
                    other.connection.socket.shutdown(socket.SHUT_RDWR)
        deadline = time.monotonic() + 10.0
        while any(walk() is not None for walk in walks) and time.monotonic() < deadline:
            time.sleep(0.02)
        assert len(walks) == 2
        assert [walk() for walk in walks] == [None, None]
    finally:
        gc.enable()


def test_a_place_on_the_floor_is_walked_to_and_a_key_takes_over(client: Client) -> None:
    client.send(Goto((0.0, 0.0, 1.0)))
    assert client.wait_for(Going).state == "walking"
    arrived = client.wait_for(Going)
    assert (arrived.state, arrived.place) == ("arrived", (0.0, 0.0, 1.0))
    assert client.frame(lambda frame: abs(frame.forward) < 0.01).z == pytest.approx(1.0, abs=0.25)
    client.send(Goto((0.0, 0.0, 1e5)))
    refused = client.wait_for(Going)
    assert refused.state == "refused"
    assert "off the ground" in refused.reason
    client.send(Goto((0.0, 0.0, 3.0)))
    assert client.wait_for(Going).state == "walking"
    client.press(forward=-1.0)
    assert client.wait_for(Going).state == "taken over"


def wait_until_alone(url: str, besides: int = 0) -> None:
    end = time.monotonic() + LONG
    while json.loads(urlopen(f"{url}/health", timeout=LONG).read())["sessions"] > besides:
        assert time.monotonic() < end
        time.sleep(0.02)


def test_copies_of_a_page_have_walks_of_their_own(url: str, tmp_path: Path) -> None:
    pages = {scene: f"key={'6' * 32}&opening={digit * 32}" for scene, digit in (("a", "7"), ("b", "8"))}

    def recorded(scene: str) -> str:
        file = tmp_path / f"{scene}.elbow"
        file.write_bytes(urlopen(f"{url}/api/walk.elbow?{pages[scene]}", timeout=LONG).read())
        return Recording(file).scene().name

    with client_at(f"{url}/ws?{pages['a']}") as first:
        first.send(Configure(scene="a"))
        first.wait_for(SceneMessage, lambda scene: scene.name == "a")
        with client_at(f"{url}/ws?{pages['b']}") as second:
            second.send(Configure(scene="b"))
            second.wait_for(SceneMessage, lambda scene: scene.name == "b")
            second.frame(lambda frame: frame.time > 1.0)
            assert [recorded("a"), recorded("b")] == ["a", "b"]
        wait_until_alone(url, besides=1)
        assert recorded("a") == "a"  # the copy is gone, the page is not


def test_who_loses_the_line_goes_on_in_the_same_place(url: str) -> None:
    where = f"{url}/ws?key={'5' * 32}"
    with client_at(where) as client:
        client.send(Configure(scene="a"))
        client.wait_for(SceneMessage, lambda scene: scene.name == "a")
        start = client.frame()
        client.press(forward=1.0)
        client.frame(lambda f: f.z - start.z > 1.0)
        client.press()
        last = client.frame(lambda f: f.forward == 0.0)
        client.wait_for(Status)
        noted = client.frame(lambda f: f.time > last.time + 1.0)
        client.connection.socket.shutdown(socket.SHUT_RDWR)
    wait_until_alone(url)
    with client_at(where) as again:
        assert again.wait_for(Settings).scene == "a"
        back = again.frame()
        assert (back.x, back.z) == pytest.approx((noted.x, noted.z), abs=0.05)
    wait_until_alone(url)
    with client_at(where) as left:  # who said goodbye begins anew
        assert left.wait_for(Settings).scene == "empty"
