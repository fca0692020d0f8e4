"""The door before two servers, which are threads here: no cluster is needed to go through it."""

import asyncio
import json
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager
from dataclasses import replace
from urllib.request import urlopen

import httpx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from prometheus_client import parser
from websockets.exceptions import ConnectionClosed

from elbowroom.cluster.door import Address, BadRequestError, Door, Head
from elbowroom.server.entrance.door_word import FOR, WORD
from elbowroom.server.schema.commands import Configure
from elbowroom.server.schema.menus import Settings
from elbowroom.server.schema.picture import SceneMessage
from elbowroom.server.schema.progress import Status
from elbowroom.server.serving import Front, Server, listen, make_server, url_of
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.shelf import OwnShelf
from elbowroom.server.wire.pose_frame import PoseFrame
from live_session import LONG, client_at, client_of

THE_WORD = "0123456789abcdef"


@contextmanager
def thread_of(server: Server, opened: socket.socket) -> Iterator[None]:
    thread = threading.Thread(target=server.run, kwargs={"sockets": [opened]}, daemon=True)
    thread.start()
    try:
        yield
    finally:
        server.drain()
        thread.join(LONG)


@contextmanager
def opened_door(*servers: Address, buffer: int = 65536) -> Iterator[tuple[Door, str]]:
    """A door with a send buffer of so many bytes, and its address."""
    with listen("127.0.0.1", 0) as opened:
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, buffer)
        door, loop = Door(THE_WORD, servers), asyncio.new_event_loop()
        serving = loop.create_task(door.serve(opened))

        def run() -> None:
            with pytest.raises(asyncio.CancelledError):
                loop.run_until_complete(serving)
            loop.close()

        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        try:
            yield door, url_of(opened)
        finally:
            loop.call_soon_threadsafe(serving.cancel)
            thread.join(LONG)


@pytest.fixture(scope="module")
def two() -> Iterator[tuple[Door, str, dict[Address, Server]]]:
    """A door, its address, and two servers behind it with one shelf."""
    shelf, front = OwnShelf(), Front(THE_WORD, "127.0.0.1", "", 1.0)
    with ExitStack() as stack:
        servers = {}
        for _ in range(2):
            library = stack.enter_context(closing(Library.open("empty")))
            opened = stack.enter_context(listen("127.0.0.1", 0))
            server = make_server(replace(library, shelf=shelf, shared=True), opened, front=front)
            stack.enter_context(thread_of(server, opened))
            servers[Address(*opened.getsockname())] = server
        door, url = stack.enter_context(opened_door(*servers))
        yield door, url, servers


def test_page_and_session_come_through_the_door(two: tuple[Door, str, dict[Address, Server]]) -> None:
    _, url, servers = two
    end = time.monotonic() + LONG
    while json.load(urlopen(f"{url}/health", timeout=LONG))["servers"] < 2:
        assert time.monotonic() < end
    with httpx.Client(timeout=LONG) as client:  # one connection for all, if the door let it
        assert client.get(f"{url}/api/catalog").json()["planners"]
        assert client.get(f"{url}/api/scenes/a").json()["name"] == "a"
        assert client.post(f"{url}/api/scenes", content=b"{").status_code == 422
    with client_of(url) as session:
        assert session.frame()
        text = urlopen(f"{url}/metrics", timeout=LONG).read().decode()
        sessions = {family.name: family for family in parser.text_string_to_metric_families(text)}["elbowroom_sessions"]
        assert sorted(sample.value for sample in sessions.samples) == [0.0, 1.0]
        assert {sample.labels["server"] for sample in sessions.samples} == {f"{s.host}:{s.port}" for s in servers}
    for server in servers:  # past the door nobody comes in
        with pytest.raises(httpx.HTTPStatusError, match="403"):
            httpx.get(f"http://{server.host}:{server.port}/health").raise_for_status()


def test_a_foreign_page_is_told_apart_behind_the_door(two: tuple[Door, str, dict[Address, Server]]) -> None:
    _, url, _ = two
    assert httpx.get(f"{url}/api/catalog", headers={"origin": "http://evil.example"}).status_code == 403
    forged = {"sec-fetch-site": "cross-site", FOR.decode(): "127.0.0.1", WORD.decode(): "guessed"}
    assert httpx.get(f"{url}/api/catalog", headers=forged).status_code == 403
    assert httpx.get(f"{url}/api/catalog", headers={"host": "evil.example"}).status_code == 403


def test_who_loses_the_server_is_back_in_the_same_place(two: tuple[Door, str, dict[Address, Server]]) -> None:
    door, url, servers = two
    key = "7" * 32
    where = f"{url}/ws?key={key}"
    with client_at(where) as client:
        client.send(Configure(scene="a"))
        client.wait_for(SceneMessage, lambda scene: scene.name == "a")
        start = client.frame()
        client.press(forward=1.0)
        client.frame(lambda f: f.z - start.z > 0.5)
        client.press()
        still = client.frame(lambda f: f.forward == 0.0)
        client.wait_for(Status, lambda status: status.time > still.time + 0.7)
        last = client.frame()
        lost = door.choose(key, begins_session=False)
        assert lost is not None
        recording = httpx.get(f"{url}/api/walk.elbow?key={key}", timeout=LONG)
        assert recording.status_code == 200  # from the server that has the session
        servers[lost].drain()
        with pytest.raises(ConnectionClosed):
            client.wait_for(PoseFrame, lambda _: False)
    with client_at(where) as again:
        assert door.choose(key, begins_session=False) != lost
        assert again.wait_for(Settings).scene == "a"
        back = again.frame()
        assert (back.x, back.z) == pytest.approx((last.x, last.z), abs=0.05)


def test_who_reads_slowly_gets_all_of_a_file(two: tuple[Door, str, dict[Address, Server]]) -> None:
    with opened_door(*two[2], buffer=4096) as (_, url), socket.socket() as slow:
        host, port = url.removeprefix("http://").rstrip("/").split(":")
        slow.settimeout(LONG)
        slow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        slow.connect((host, int(port)))
        slow.sendall(f"GET /avatars/stock.glb HTTP/1.1\r\nHost: {host}:{port}\r\n\r\n".encode())
        answer = b""
        while data := slow.recv(4096):
            answer += data
            time.sleep(0.002)  # the server has sent all and gone before that is read
    head, _, body = answer.partition(b"\r\n\r\n")
    length = next(line for line in head.lower().split(b"\r\n") if line.startswith(b"content-length:"))
    assert len(body) == int(length.partition(b":")[2])


def test_without_a_server_it_is_said_so() -> None:
    with opened_door(Address("127.0.0.1", 1)) as (_, url):
        answer = httpx.get(f"{url}/")
        assert answer.status_code == 503
        assert "no server is there" in answer.text


def test_sessions_are_spread_and_pages_stay() -> None:
    door = Door(THE_WORD, [Address("a", 1), Address("b", 1)])
    led = [door.choose(f"{number:032x}", begins_session=True) for number in range(10)]
    assert led.count(Address("a", 1)) == 5
    assert [door.choose(f"{number:032x}", begins_session=False) for number in range(10)] == led
    door.remove(Address("a", 1))
    assert {door.choose(f"{number:032x}", begins_session=True) for number in range(10)} == {Address("b", 1)}


def test_a_head_is_handed_on_without_what_was_forged() -> None:
    lines = [b"GET /ws?key=" + b"a" * 32 + b" HTTP/1.1", b"Host: here", b"X-Forwarded-For: 127.0.0.1", b"connection: x"]
    head = Head.of(b"\r\n".join([*lines, b"X-Elbowroom-Door: y", b"Upgrade: websocket", b"", b""]))
    assert (head.key, head.begins_session) == ("a" * 32, True)
    told = head.told("10.0.0.9", "word").split(b"\r\n")
    assert told[1:3] == [b"Host: here", b"Upgrade: websocket"]
    assert told[3:] == [b"x-forwarded-for: 10.0.0.9", b"x-elbowroom-door: word", b"Connection: Upgrade", b"", b""]


@given(st.binary(max_size=300))
def test_what_is_no_request_is_refused(data: bytes) -> None:
    try:
        head = Head.of(data + b"\r\n\r\n")
    except BadRequestError:
        return
    told = head.told("10.0.0.9", "word")
    assert told.count(b"x-elbowroom-door: word\r\n") == 1
    assert told.endswith(b"\r\n\r\n")


@pytest.mark.parametrize(
    "head", [b"", b"GET / HTTP/2", b"GET  / HTTP/1.1", b"GET http://x/ HTTP/1.1", b"GET / HTTP/1.1\r\n x: y"]
)
def test_such_heads_are_refused(head: bytes) -> None:
    with pytest.raises(BadRequestError):
        Head.of(head + b"\r\n\r\n")
