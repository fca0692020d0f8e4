"""Connections that take without giving, and floods: ended, without a word in the log and without harm to others."""

import asyncio
import logging
import socket
import struct
from collections.abc import Iterator
from contextlib import ExitStack, closing

import pytest
from uvicorn.protocols.utils import ClientDisconnected
from websockets.exceptions import ConnectionClosed

from elbowroom.server.entrance import connections
from elbowroom.server.entrance.connections import BoundedWebSocket, ConnectionLimits, Doorman
from elbowroom.server.schema.bounds import MAX_MESSAGE
from elbowroom.server.schema.menus import Hello
from elbowroom.server.stores.library import Library
from elbowroom.server.wire.pose_frame import PoseFrame
from live_session import Client, client_of, running

LIMITS = ConnectionLimits(request=10.0, reading=15.0, closing=3.0, unread=1000, idle=4)


class Transport:
    def __init__(self) -> None:
        self.given = self.waiting = 0
        self.closing = self.aborted = False

    def get_write_buffer_size(self) -> int:
        return self.waiting

    def is_closing(self) -> bool:
        return self.closing

    def abort(self) -> None:
        self.aborted = True


class Cycle:
    response_complete = False


class Connection:
    """What the doorman sees of a connection over HTTP."""

    def __init__(self, *, busy: bool = False) -> None:
        self.transport = Transport()
        self.cycle = Cycle() if busy else None


def looked(connection: Connection, *times: float) -> bool:
    """Whether the connection is ended when the doorman looks at these times."""
    doorman = Doorman(LIMITS)
    for now in times:
        doorman.look([connection], now)
    return connection.transport.aborted


def test_a_request_that_never_comes_is_not_waited_for() -> None:
    assert not looked(Connection(), 0.0, 9.0)
    assert looked(Connection(), 0.0, 11.0)
    assert not looked(Connection(busy=True), 0.0, 11.0, 1000.0)


def test_who_reads_nothing_is_dropped() -> None:
    stuck = Connection(busy=True)
    stuck.transport.waiting = 500
    assert not looked(stuck, 0.0, 14.0)
    assert looked(stuck, 0.0, 16.0)


def test_who_reads_slowly_stays() -> None:
    slow, doorman = Connection(busy=True), Doorman(LIMITS)
    for now in range(0, 100, 10):
        slow.transport.waiting = 900 - 5 * now
        doorman.look([slow], float(now))
    assert not slow.transport.aborted


def test_who_reads_steadily_stays_where_as_much_waits_at_each_look() -> None:
    """What is taken between two looks is made up for by what is sent next."""
    steady, doorman = Connection(busy=True), Doorman(LIMITS)
    steady.transport.waiting = 900
    for now in range(0, 200, 10):
        steady.transport.given += 500
        doorman.look([steady], float(now))
    assert not steady.transport.aborted
    doorman.look([steady], 206.0)
    assert steady.transport.aborted


def test_what_waits_is_bounded() -> None:
    flooded = Connection(busy=True)
    flooded.transport.waiting = 1001
    assert looked(flooded, 0.0)


def test_a_connection_that_cannot_be_closed_is_cut() -> None:
    ending = Connection(busy=True)
    ending.transport.closing = True
    assert not looked(ending, 0.0, 2.0)
    assert looked(ending, 0.0, 4.0)


def test_only_so_many_wait_with_nothing_to_ask() -> None:
    waiting, doorman = [Connection() for _ in range(7)], Doorman(LIMITS)
    for number in range(1, 8):
        doorman.look(waiting[:number], float(number))
    doorman.look(waiting, 8.0)
    assert [connection.transport.aborted for connection in waiting] == [True] * 3 + [False] * 4


# --- over a real network -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def url() -> Iterator[str]:
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(connections, "Doorman", lambda: Doorman(ConnectionLimits(request=0.5, closing=0.5)))
        with closing(Library.open("empty")) as library, running(library) as address:
            yield address


@pytest.fixture
def client(url: str) -> Iterator[Client]:
    with client_of(url) as made:
        made.wait_for(PoseFrame)
        yield made


def test_half_a_header_is_not_waited_for(url: str) -> None:
    host, port = url.removeprefix("http://").split(":")
    begun = (b"", b"GET / HTTP/1.1\r\nHost: localhost\r\n", b"GET /api/health HTTP/1.1\r\nHost: x\r\n\r\nGET /")
    with ExitStack() as stack:
        halves = [stack.enter_context(socket.create_connection((host, int(port)), timeout=10.0)) for _ in begun]
        for half, text in zip(halves, begun, strict=True):
            half.sendall(text)
        for half in halves:
            while half.recv(4096):  # until the server ends it
                pass


def raw_frame(opcode: int, data: bytes = b"") -> bytes:
    return bytes([opcode, 0x80 | len(data)]) + struct.pack("!I", 0) + data


PING, PONG, PART, TEXT = 0x89, 0x8A, 0x00, 0x81


@pytest.mark.parametrize(
    "flood",
    [
        raw_frame(PING),
        raw_frame(PONG),
        raw_frame(PART),
        raw_frame(TEXT, b'{"type":"ping","t":1}'),
        raw_frame(TEXT, b"nonsense"),
    ],
    ids=["pings", "pongs", "parts", "asks", "nonsense"],
)
def test_a_flood_ends_its_connection_and_holds_nobody_up(
    url: str, client: Client, flood: bytes, caplog: pytest.LogCaptureFixture
) -> None:
    with client_of(url) as other, caplog.at_level(logging.WARNING):
        other.wait_for(PoseFrame)
        if flood == raw_frame(PART):
            other.connection.socket.sendall(raw_frame(0x01, b"begun"))
        with pytest.raises(OSError, match=r"reset|Broken pipe|Bad file descriptor"):
            pour(other.connection.socket, flood, client)
    assert client.is_served()
    theirs = "websockets.client"  # what ours says of the socket that was torn from it is nothing of the server's
    said = [f"{one.getMessage()}{one.exc_text or ''}" for one in caplog.records if one.name != theirs]
    assert not [line for line in said if "Traceback" in line or "failed" in line]


def pour(into: socket.socket, flood: bytes, beside: Client) -> None:
    """Send 50 MB, unless the connection ends; another client gets its frames meanwhile."""
    into.settimeout(20.0)
    piece = flood * (65536 // len(flood))
    for _ in range(800):
        into.sendall(piece)
        beside.wait_for(PoseFrame)


def test_a_message_over_the_limit_leaves_no_traceback(
    url: str, client: Client, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.INFO):
        for _ in range(5):
            with client_of(url) as other:
                other.wait_for(PoseFrame)
                other.connection.send("x" * (MAX_MESSAGE + 1))
                with pytest.raises(ConnectionClosed):
                    other.wait_for(Hello)  # there was one before
        assert client.is_served()
    assert "Traceback" not in caplog.text
    assert "a session failed" not in caplog.text


def test_nothing_is_sent_after_the_end() -> None:
    """A session that is in the middle of sending then ends as if the client had left, which it has."""
    ending = BoundedWebSocket.__new__(BoundedWebSocket)
    ending.close_sent = True
    with pytest.raises(ClientDisconnected):
        asyncio.run(ending.send({"type": "websocket.send", "text": "x"}))
