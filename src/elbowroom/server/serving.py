"""Runs the application on a socket of our own choosing."""

import asyncio
import contextlib
import errno
import socket
from collections.abc import Callable
from dataclasses import dataclass
from types import FrameType

import uvicorn

from elbowroom.errors import InputError
from elbowroom.experiment.parallel import usable_cores
from elbowroom.server.app import make_app
from elbowroom.server.ending import end_at_latest
from elbowroom.server.entrance.admission import AMONG, Admission
from elbowroom.server.entrance.connections import BoundedWebSocket, CountedHttp, looks_after
from elbowroom.server.ports import HIGHEST, check_port
from elbowroom.server.schema.bounds import MAX_MESSAGE
from elbowroom.server.stores.library import Library

_PORTS_TRIED = 50
_SEND_BUFFER = 128 * 1024  # bytes in the kernel's hands: a slow client must not collect seconds of old frames


def listen(host: str, port: int) -> socket.socket:
    """A listening socket on the port, or on the next free one (port 0: any); raises `InputError` where that fails."""
    check_port(port)
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
    except (OSError, UnicodeError):
        raise InputError(
            f"--host {host!r} is not a name or address of this machine; 127.0.0.1 is the default"
        ) from None
    for candidate in range(port, min(port + _PORTS_TRIED, HIGHEST + 1)):
        found = _bound(family, (address[0], candidate, *address[2:]))
        if found is not None:
            return found
    raise InputError(f"--port {port}: this and the next {_PORTS_TRIED - 1} ports of {host} are busy; name another")


def _bound(family: int, address: tuple[object, ...]) -> socket.socket | None:
    """A socket on the address; None if it is busy."""
    # With the protocol named, asyncio switches Nagle's delay off: else every tenth frame waits 40 ms for an ACK.
    opened = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        opened.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER)
        opened.bind(address)
        opened.listen(128)
    except OSError as error:
        opened.close()
        if error.errno == errno.EADDRINUSE:
            return None
        raise InputError(f"cannot listen on {address[0]} port {address[1]}: {error.strerror}; name another") from None
    return opened


def url_of(opened: socket.socket) -> str:
    """The address to open in a browser on this machine."""
    host, port = opened.getsockname()[:2]
    shown = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}.get(host, f"[{host}]" if ":" in host else host)
    return f"http://{shown}:{port}"


class Server(uvicorn.Server):
    """uvicorn's, with an eye on its connections, and an end in time."""

    def __init__(self, library: Library, admission: Admission, config: uvicorn.Config) -> None:
        super().__init__(config)
        self._library, self._admission = library, admission
        config.callback_notify = looks_after(lambda: self.server_state.connections)

    def drain(self) -> None:
        """Begin to end, without ending the process: nobody is let in any more, and sessions are closed."""
        self._admission.ending = True
        self.should_exit = True

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Begin to end; whoever is not ready in a few seconds is not waited for."""
        self._admission.ending = True
        if not self.should_exit:
            end_at_latest(sig, self._library.close)
        super().handle_exit(sig, frame)


@dataclass(frozen=True)
class Front:
    """The door before a server."""

    word: str  # by which the server knows it
    bound_host: str  # the address that it listens on
    name: str  # that was asked for
    share: float  # of a machine's cores, that the server may use


def make_server(library: Library, opened: socket.socket, host: str = "", front: Front | None = None) -> Server:
    """The server of an application for this socket; `run(sockets=[opened])` runs it; `host` as in `listen`."""
    if front is None:
        admission = Admission(library.meter)
        app = make_app(library, opened.getsockname()[0], host, admission)
    else:
        admission = Admission(library.meter, front.share * usable_cores(), first=AMONG)
        app = make_app(library, front.bound_host, front.name, admission, front.word)
    config = uvicorn.Config(
        app,
        http=CountedHttp,
        ws=BoundedWebSocket,
        ws_max_size=MAX_MESSAGE,
        ws_per_message_deflate=False,
        ws_ping_interval=5.0,
        ws_ping_timeout=10.0,
        timeout_graceful_shutdown=1,
        timeout_notify=1,
        lifespan="off",
        access_log=False,
        log_config=None,
        server_header=False,
    )
    return Server(library, admission, config)


def serve(library: Library, opened: socket.socket, host: str, on_ready: Callable[[], None]) -> None:
    """Serve until interrupted (then the KeyboardInterrupt passes through); `on_ready` is called once it answers."""
    asyncio.run(_serve(make_server(library, opened, host), opened, on_ready))


async def _serve(server: Server, opened: socket.socket, on_ready: Callable[[], None]) -> None:
    watch = asyncio.create_task(_when_started(server, on_ready))
    try:
        await server.serve(sockets=[opened])
    finally:
        watch.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await watch


async def _when_started(server: Server, on_ready: Callable[[], None]) -> None:
    while not server.started:
        await asyncio.sleep(0.01)
    on_ready()
