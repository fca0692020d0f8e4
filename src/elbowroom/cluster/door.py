"""The one address of many servers: each connection is led to a server, and each page to the one that has its session.

A web socket stays where it was led. Bytes are handed on as they are but for the head of a request, to which is added
who asks, and the word by which servers know the door; other connections they refuse.
"""

import asyncio
import contextlib
import json
import logging
import socket
import time
from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple
from urllib.parse import parse_qs, urlsplit

from elbowroom.server.entrance.door_word import FOR, WORD
from elbowroom.server.entrance.page_key import page_key
from elbowroom.server.metrics import CONTENT_TYPE, joined_metrics

LOG = logging.getLogger("elbowroom.cluster")

_MOST_HEAD = 32 * 1024  # bytes
_HEAD_IN, _CONNECT_IN = 10.0, 2.0  # seconds
_STALLED = 30.0  # seconds that a client may take nothing
_CHUNK = 64 * 1024  # bytes
_MOST_OPEN = 4096  # connections
_MOST_PAGES = 65536  # keys of pages that are remembered
_LOOK_EVERY, _LOOK_IN = 0.5, 2.0  # seconds
_MISSES = 3  # looks without an answer after which a server is given up
_DROPPED = {b"connection", b"keep-alive", b"proxy-connection", FOR, WORD}
_BUSY = b"no server is there at the moment; try again in a few seconds\n"


class Address(NamedTuple):
    """Where a server listens."""

    host: str
    port: int


@dataclass
class _Seen:
    """What a server has told of itself lately."""

    sessions: int = 0
    room: bool = True  # whether it takes sessions
    misses: int = 0
    led: int = 0  # sessions that were led there since it told
    told: dict[str, Any] = field(default_factory=dict)


class BadRequestError(ValueError):
    """Not the head of a request that is handed on."""


class Head(NamedTuple):
    """The head of a request."""

    target: str
    lines: tuple[bytes, ...]  # the first one, and the headers

    @classmethod
    def of(cls, data: bytes) -> "Head":
        """Taken apart; raises `BadRequestError`."""
        lines = tuple(data.removesuffix(b"\r\n\r\n").split(b"\r\n"))
        parts = lines[0].split(b" ")
        if len(parts) != 3 or not parts[1].startswith(b"/") or not parts[2].startswith(b"HTTP/1."):
            raise BadRequestError
        if any(line[:1] in b" \t" or b":" not in line for line in lines[1:]):
            raise BadRequestError
        return cls(parts[1].decode("latin-1"), lines)

    @property
    def key(self) -> str:
        """The key of the page that asks; "" if it does not say."""
        return page_key({name: values[-1] for name, values in parse_qs(urlsplit(self.target).query).items()})

    @property
    def begins_session(self) -> bool:
        """Whether this asks for a web socket."""
        return urlsplit(self.target).path == "/ws"

    def told(self, client: str, word: str) -> bytes:
        """As the server is told it: for whom, by the door, and one request to a connection."""
        kept = [line for line in self.lines[1:] if line.partition(b":")[0].strip().lower() not in _DROPPED]
        ending = b"Upgrade" if self.begins_session else b"close"
        added = [FOR + b": " + client.encode(), WORD + b": " + word.encode(), b"Connection: " + ending]
        return b"\r\n".join([self.lines[0], *kept, *added, b"", b""])


class Door:
    """Leads connections to servers; lives in one event loop. `servers` may change at any time."""

    def __init__(self, word: str, servers: Iterable[Address] = ()) -> None:
        """`word` is what the servers know this door by."""
        self._word = word
        self._seen: dict[Address, _Seen] = {server: _Seen() for server in servers}
        self._of_pages: OrderedDict[str, Address] = OrderedDict()
        self._open = 0

    def add(self, server: Address) -> None:
        """Lead to this server, too."""
        self._seen.setdefault(server, _Seen())

    def remove(self, server: Address) -> None:
        """Lead nobody there any more."""
        self._seen.pop(server, None)

    @property
    def servers(self) -> dict[Address, int]:
        """The servers that are there, and how many sessions they have."""
        return {server: seen.sessions for server, seen in self._seen.items() if seen.misses < _MISSES}

    async def serve(self, opened: socket.socket) -> None:
        """Lead whoever comes to a listening socket, for ever."""
        async with await asyncio.start_server(self._lead, sock=opened, limit=_MOST_HEAD) as server:
            await asyncio.gather(server.serve_forever(), self._look_again())

    # --- which server ------------------------------------------------------------------------------------------------

    def choose(self, key: str, *, begins_session: bool) -> Address | None:
        """The server for a page: where it was, if that is there; else, of those with room, one with few sessions."""
        there = {server: seen for server, seen in self._seen.items() if seen.misses < _MISSES}
        known = self._of_pages.get(key)
        if known in there:
            self._of_pages.move_to_end(key)
            return known
        if not there:
            return None
        best = min(there, key=lambda server: (not there[server].room, there[server].sessions + there[server].led))
        if begins_session:
            there[best].led += 1
        if key:
            self._of_pages[key] = best
            while len(self._of_pages) > _MOST_PAGES:
                self._of_pages.popitem(last=False)
        return best

    async def _look_again(self) -> None:
        while True:
            await asyncio.gather(*(self._look(server, seen) for server, seen in list(self._seen.items())))
            await asyncio.sleep(_LOOK_EVERY)

    async def _look(self, server: Address, seen: _Seen) -> None:
        try:
            async with asyncio.timeout(_LOOK_IN):
                told = json.loads(await self._asked(server, "/health"))
            seen.sessions, seen.room, seen.misses, seen.led, seen.told = told["sessions"], told["room"], 0, 0, told
        except (OSError, ValueError, KeyError, asyncio.IncompleteReadError):
            seen.misses += 1

    async def _asked(self, server: Address, target: str) -> str:
        reader, writer = await asyncio.open_connection(*server)
        try:
            head = Head(target, (f"GET {target} HTTP/1.1".encode(), b"Host: localhost"))
            writer.write(head.told("127.0.0.1", self._word))
            answer = await reader.read(_CHUNK)
            while not reader.at_eof():
                answer += await reader.read(_CHUNK)
        finally:
            writer.close()
        return answer.partition(b"\r\n\r\n")[2].decode()

    # --- what the door says itself -----------------------------------------------------------------------------------

    def health(self) -> dict[str, Any]:
        """What the servers have told of themselves, taken together."""
        told = [seen.told for seen in self._seen.values() if seen.told and seen.misses < _MISSES]
        counts = {name for one in told for name, value in one.items() if type(value) in (int, float)}
        return {
            "status": "ok" if told else "no server",
            "servers": len(told),
            "warm": bool(told) and all(one["warm"] for one in told),
            "room": any(one["room"] for one in told),
            **{name: sum(one.get(name, 0) for one in told) for name in sorted(counts)},
            "wallSeconds": time.perf_counter(),
        }

    async def metrics(self) -> str:
        """The metrics of all servers, each by its address."""
        texts = {}
        for server in self.servers:
            with contextlib.suppress(OSError):
                async with asyncio.timeout(_LOOK_IN):
                    texts[f"{server.host}:{server.port}"] = await self._asked(server, "/metrics")
        return joined_metrics(texts)

    async def _told(self, head: Head, writer: asyncio.StreamWriter) -> bool:
        """Whether a request was one that the door answers itself."""
        if head.target in ("/health", "/api/health"):
            await _answer(writer, "200 OK", json.dumps(self.health()).encode(), "application/json")
        elif head.target == "/metrics":
            await _answer(writer, "200 OK", (await self.metrics()).encode(), CONTENT_TYPE)
        else:
            return False
        return True

    # --- one connection ----------------------------------------------------------------------------------------------

    async def _lead(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._open += 1
        try:
            if self._open <= _MOST_OPEN:
                await self._led(reader, writer)
        except (OSError, asyncio.IncompleteReadError, asyncio.LimitOverrunError):
            pass  # who comes and goes, or sends what is no request
        except BadRequestError:
            await _answer(writer, "400 Bad Request", b"")
        finally:
            self._open -= 1
            writer.transport.abort() if writer.transport.get_write_buffer_size() else writer.close()

    async def _led(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        async with asyncio.timeout(_HEAD_IN):
            head = Head.of(await reader.readuntil(b"\r\n\r\n"))
        if await self._told(head, writer):
            return
        found = await self._connected(head)
        if found is None:
            await _answer(writer, "503 Service Unavailable", _BUSY)
            return
        there, to_there = found
        try:
            to_there.write(head.told(writer.get_extra_info("peername")[0], self._word))
            await _hand_on((reader, to_there), (there, writer))
        finally:
            to_there.transport.abort()

    async def _connected(self, head: Head) -> tuple[asyncio.StreamReader, asyncio.StreamWriter] | None:
        """A connection to the page's server, or to another one where that is gone."""
        while (server := self.choose(head.key, begins_session=head.begins_session)) is not None:
            try:
                async with asyncio.timeout(_CONNECT_IN):
                    return await asyncio.open_connection(*server)
            except OSError:
                LOG.warning("no server answers at %s:%d any more", *server)
                if server in self._seen:
                    self._seen[server].misses = _MISSES  # until it is seen again
        return None


async def _hand_on(*ways: tuple[asyncio.StreamReader, asyncio.StreamWriter]) -> None:
    """Hand on what comes, both ways, until the server has ended or the client is gone."""
    tasks = [asyncio.create_task(_pour(*way)) for way in ways]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _pour(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    """To the end; what is not taken makes who sends it wait, so that frames do not pile up."""
    with contextlib.suppress(OSError):
        while data := await reader.read(_CHUNK):
            writer.write(data)
            async with asyncio.timeout(_STALLED):
                await writer.drain()
        writer.transport.set_write_buffer_limits(0)  # the end is handed on, too, before the connection goes
        async with asyncio.timeout(_STALLED):
            await writer.drain()


async def _answer(writer: asyncio.StreamWriter, status: str, body: bytes, kind: str = "text/plain") -> None:
    head = f"HTTP/1.1 {status}\r\nContent-Length: {len(body)}\r\nContent-Type: {kind}\r\nConnection: close\r\n\r\n"
    writer.write(head.encode() + body)
    with contextlib.suppress(OSError):
        async with asyncio.timeout(_CONNECT_IN):
            await writer.drain()
