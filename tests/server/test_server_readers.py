"""Who does not read loses the connection, and its session its place; who reads slowly keeps them. Over a real network.

The doorman looks when a test says so, and sees the time that it says: nothing hangs on how quick the machine is.
"""

import asyncio
import json
import os
import socket
import struct
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.request import urlopen

import pytest
import uvicorn

from elbowroom.server import serving
from elbowroom.server.entrance.connections import ConnectionLimits, Doorman
from elbowroom.server.schema.commands import Input, Overlays
from elbowroom.server.standalone.frames import PosedRun
from elbowroom.server.stores import runs
from elbowroom.server.stores.library import Library
from elbowroom.server.wire.codec import encode
from elbowroom.server.wire.messages import ClientMessage
from elbowroom.world.scene import Scene
from live_session import LONG, client_of, running
from place_builder import write_place

LIMITS = ConnectionLimits(reading=8.0, unread=2**20)
LARGE = 2 * 2**20  # bytes: more than may wait for a client, and than a slow one takes in all of its patience
A_LOOK = 64 * 1024  # bytes that a slow client takes from one look of the doorman to the next: 64 KiB a second
LITTLE = 4096  # bytes


class Looks:
    """The doorman of a server."""

    def __init__(self) -> None:
        self._doorman, self._now = Doorman(LIMITS), 0.0
        self._loop: asyncio.AbstractEventLoop
        self._connections: Callable[[], Iterable[Any]]

    def after(self, connections: Callable[[], Iterable[Any]]) -> Callable[[], Any]:
        """In the place of `looks_after`."""
        self._connections = connections

        async def called() -> None:
            self._loop = asyncio.get_running_loop()

        return called

    def look(self, seconds: float = 1.0) -> None:
        """Look, so many seconds after the last time."""

        async def looked() -> None:
            self._now += seconds
            self._doorman.look(self._connections(), self._now)

        asyncio.run_coroutine_threadsafe(looked(), self._loop).result(LONG)


@pytest.fixture
def looks(monkeypatch: pytest.MonkeyPatch) -> Looks:
    """The doorman of the server that is started next."""
    made = Looks()
    monkeypatch.setattr(serving, "looks_after", made.after)
    return made


def set_pings(monkeypatch: pytest.MonkeyPatch, times: float | None) -> None:
    """Have a server ping in so many times what it would take, and wait so long; None: it pings nobody."""
    config = uvicorn.Config

    def changed(app: Any, **options: Any) -> uvicorn.Config:
        pings = {name: times and times * options[name] for name in ("ws_ping_interval", "ws_ping_timeout")}
        return config(app, **options | pings)

    monkeypatch.setattr(uvicorn, "Config", changed)


@pytest.fixture
def library() -> Iterator[Library]:
    """A server's, which shows a run."""
    with closing(Library.open("empty")) as made:
        yield replace(made, run=Path("walk.elbow"))


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> bytes:
    """The frames of the run that the server shows."""
    frames = os.urandom(LARGE)

    async def posed(*_: str) -> tuple[object, ...]:
        made = PosedRun(Scene.load("empty").to_dict(), "exact", "", "", "", LARGE // 1024, frames)
        return tuple(getattr(made, name) for name in PosedRun.__dataclass_fields__)

    monkeypatch.setattr(runs, "run_apart", posed)
    return frames


def opened(url: str, holds: int) -> socket.socket:
    """A connection of a client whose machine takes so many bytes that nobody reads."""
    host, port = url.removeprefix("http://").split(":")
    made = socket.socket()
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, holds)
    made.settimeout(LONG)
    made.connect((host, int(port)))
    return made


def ask(client: socket.socket, path: str, *headers: str) -> None:
    host, port = client.getpeername()
    client.sendall("\r\n".join((f"GET {path} HTTP/1.1", f"Host: {host}:{port}", *headers, "", "")).encode())


def slowly(client: socket.socket, looks: Looks, path: str) -> bytes:
    """The body of an answer that is read a little at a time, each time a second later."""
    ask(client, path, "Connection: close")
    answer = bytearray()
    with client.makefile("rb") as stream:
        while piece := stream.read(A_LOOK):
            answer += piece
            time.sleep(0.02)  # in which the server sends what there is room for on the way, as it would in a second
            looks.look()
    return bytes(answer.partition(b"\r\n\r\n")[2])


def test_a_run_that_is_read_slowly_arrives_whole(looks: Looks, library: Library, run: bytes) -> None:
    """Though as much may wait at one look as at the one before."""
    with running(library) as url, closing(opened(url, A_LOOK)) as client:
        assert slowly(client, looks, "/api/run").endswith(run)


def test_the_model_of_a_place_that_is_read_slowly_arrives_whole(looks: Looks, library: Library, tmp_path: Path) -> None:
    model = library.avatars.folder / f"{'a' * 32}.glb"
    model.write_bytes(os.urandom(LARGE))
    library.sent.add_place(Scene.load(write_place(tmp_path / "rooms.glb")), model)
    with running(library) as url, closing(opened(url, A_LOOK)) as client:
        assert slowly(client, looks, f"/places/{model.name}") == model.read_bytes()


def sessions(url: str) -> int:
    with urlopen(f"{url}/health", timeout=LONG) as answer:
        count: int = json.load(answer)["sessions"]
    return count


def wait_until(is_so: Callable[[], bool], meanwhile: Callable[[], None] = lambda: None) -> None:
    """Wait for a state: only a fault makes that last long."""
    end = time.monotonic() + LONG
    while not is_so():
        assert time.monotonic() < end
        meanwhile()
        time.sleep(0.01)


def say(client: socket.socket, message: ClientMessage) -> None:
    """Send a message as a WebSocket does, masked with zeros."""
    data = encode(message).encode()
    assert len(data) < 2**16
    length = bytes([0x80 | len(data)]) if len(data) < 126 else b"\xfe" + struct.pack("!H", len(data))
    client.sendall(b"\x81" + length + bytes(4) + data)


@contextmanager
def session_of_one_who_reads_nothing(url: str) -> Iterator[socket.socket]:
    """Its connection; there is no other."""
    upgrade = ("Upgrade: websocket", "Connection: Upgrade", "Sec-WebSocket-Version: 13")
    with closing(opened(url, LITTLE)) as client:
        ask(client, "/ws", *upgrade, f"Sec-WebSocket-Key: {'A' * 22}==")
        wait_until(lambda: sessions(url) == 1)
        yield client


def test_who_walks_and_never_reads_loses_the_place(
    looks: Looks, library: Library, monkeypatch: pytest.MonkeyPatch
) -> None:
    set_pings(monkeypatch, None)
    monkeypatch.setattr(serving, "_SEND_BUFFER", LITTLE)
    with running(library) as url:
        with session_of_one_who_reads_nothing(url) as client:
            say(client, Overlays(capsules=True))

            def walk_on() -> None:
                with suppress(OSError):  # the end of the connection may be told first
                    say(client, Input(seq=1, forward=1.0))
                looks.look()

            wait_until(lambda: sessions(url) == 0, walk_on)
        with client_of(url) as other:
            assert other.is_served()


def test_who_does_nothing_and_never_reads_loses_the_place(library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    """What little it is sent fills no buffer: it answers no ping."""
    set_pings(monkeypatch, 0.04)
    with running(library) as url:
        with session_of_one_who_reads_nothing(url):
            wait_until(lambda: sessions(url) == 0)
        with client_of(url) as other:
            assert other.is_served()
