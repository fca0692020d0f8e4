"""Connections that take without giving: half-sent requests, answers that are never read, floods of small frames.

uvicorn speaks the protocols; what it has no bounds for is bounded here.
"""

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.utils import ClientDisconnected
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from elbowroom.server.entrance.rate_limit import TokenBucket

_SLICE = 4096  # bytes of a WebSocket that are taken apart at once: 700 frames at most
_SMALL_FRAMES = 50.0  # pings, pongs and parts of messages a second that a client may send
_AFTER_CLOSE = 16 * 1024  # bytes that a client may still send when it is told that the connection closes


class CountedTransport:
    """A transport of asyncio that knows how many bytes it was given."""

    def __init__(self, transport: Any) -> None:
        self._transport = transport
        self.given = 0

    def write(self, data: bytes) -> None:
        """Send, as soon as the client takes it."""
        self.given += len(data)
        self._transport.write(data)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)


class CountedHttp(H11Protocol):
    """HTTP over a `CountedTransport`, which a WebSocket that begins with it takes over."""

    def connection_made(self, transport: Any) -> None:
        """Count from now on."""
        super().connection_made(CountedTransport(transport))  # type: ignore[arg-type]


class BoundedWebSocket(WebSocketsSansIOProtocol):
    """A WebSocket that reads no faster than what it read is dealt with."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._unread = bytearray()
        self._small = TokenBucket(_SMALL_FRAMES, 4.0 * _SMALL_FRAMES)
        self._late = 0  # bytes since the close frame was sent

    def data_received(self, data: bytes) -> None:
        """Take in what came, as far as it is wanted now."""
        if self.close_sent:
            self._late += len(data)
            if self._late > _AFTER_CLOSE:
                self.transport.abort()
                return
        self._unread += data
        self._take_apart()

    def _take_apart(self) -> None:
        while self._unread and not self.read_paused and not self.transport.is_closing():
            piece = bytes(self._unread[:_SLICE])
            del self._unread[:_SLICE]
            super().data_received(piece)

    def handle_ping(self) -> None:
        """Answer, unless there are too many."""
        if self._is_small_frame_allowed():
            super().handle_ping()

    def handle_pong(self, event: Any) -> None:
        """Listen, unless there are too many."""
        if self._is_small_frame_allowed():
            super().handle_pong(event)

    def handle_cont(self, event: Any) -> None:
        """Go on with a message, unless it comes in too many parts."""
        if self._is_small_frame_allowed():
            super().handle_cont(event)

    def _is_small_frame_allowed(self) -> bool:
        allowed = self._small.allows(self.loop.time())
        if not allowed:
            self.transport.abort()
        return allowed

    async def send(self, message: Any) -> None:
        """Send, if the connection is not being closed; raises `ClientDisconnected` then."""
        if self.close_sent:
            raise ClientDisconnected
        await super().send(message)

    async def receive(self) -> Any:
        """The next message; reads on where nothing waits."""
        message = await super().receive()
        self._take_apart()
        return message


@dataclass
class _Seen:
    """What was seen of a connection, in seconds of the clock."""

    waiting: int = 0  # bytes to be sent
    taken: int = 0  # bytes that were sent
    moved: float = 0.0  # when nothing waited, or more was taken than before
    asked: float = 0.0  # when a request was being answered
    open: float = 0.0  # when it was not closing


@dataclass(frozen=True)
class ConnectionLimits:
    """How long a connection may do nothing, in seconds, and what may be open at once."""

    request: float = 10.0  # until a request's head is there
    reading: float = 40.0  # without taking any of what is sent to it, which a slow line takes 120 kB at a time
    closing: float = 3.0  # between the end of a connection and the last byte taken
    unread: int = 4 * 2**20  # bytes that may wait for a client
    idle: int = 128  # connections without a request


class Doorman:
    """Looks at all connections now and then, and ends those that only take up a place. Time is an argument."""

    def __init__(self, limits: ConnectionLimits | None = None) -> None:
        self._limits = limits or ConnectionLimits()
        self._seen: WeakKeyDictionary[Any, _Seen] = WeakKeyDictionary()

    def look(self, connections: Iterable[Any], now: float) -> None:
        """End the connections that are beyond these limits; they are uvicorn's protocol objects."""
        idle = []
        for connection in list(connections):
            seen = self._noted(connection, now)
            if self._has_waited(seen, now):
                connection.transport.abort()
            elif seen.asked < now:
                idle.append((seen.asked, connection))
        idle.sort(key=lambda pair: pair[0])
        for _, connection in idle[: -self._limits.idle]:
            connection.transport.abort()

    def _noted(self, connection: Any, now: float) -> _Seen:
        seen = self._seen.setdefault(connection, _Seen(moved=now, asked=now, open=now))
        waiting = connection.transport.get_write_buffer_size()
        taken = connection.transport.given - waiting  # what waits may be as much as before, and be something else
        if waiting == 0 or taken > seen.taken:
            seen.moved = now
        seen.waiting, seen.taken = waiting, taken
        if _is_busy(connection):
            seen.asked = now
        if not connection.transport.is_closing():
            seen.open = now
        return seen

    def _has_waited(self, seen: _Seen, now: float) -> bool:
        limits = self._limits
        return (
            now - seen.moved > limits.reading
            or now - seen.asked > limits.request
            or now - seen.open > limits.closing
            or seen.waiting > limits.unread
        )


def _is_busy(connection: Any) -> bool:
    """Whether a request is being answered; a WebSocket always is."""
    if isinstance(connection, WebSocketsSansIOProtocol):
        return True
    return connection.cycle is not None and not connection.cycle.response_complete


def looks_after(connections: Callable[[], Iterable[Any]]) -> Callable[[], Any]:
    """What a server calls now and then, for its connections."""
    doorman = Doorman()

    async def look() -> None:
        doorman.look(connections(), time.monotonic())

    return look
