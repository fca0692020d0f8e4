"""A real server on a free port, and a client that talks to it as the page does. All waiting is for a state."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any, TypeVar

from websockets.sync.client import ClientConnection, connect

from elbowroom.server.schema.commands import Input, Ping
from elbowroom.server.schema.progress import Notice, Pong
from elbowroom.server.serving import listen, make_server, url_of
from elbowroom.server.stores.library import Library
from elbowroom.server.wire.codec import decode_server, encode
from elbowroom.server.wire.messages import ClientMessage, ServerMessage
from elbowroom.server.wire.pose_frame import PoseFrame, parse

LONG = 120.0  # seconds: only a hang lasts longer

Kind = TypeVar("Kind")


@contextmanager
def running(library: Library) -> Iterator[str]:
    """A server's address; it stops at the end."""
    with listen("127.0.0.1", 0) as opened:
        server = make_server(library, opened)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [opened]}, daemon=True)
        thread.start()
        while not server.started:
            assert thread.is_alive()
            time.sleep(0.01)
        try:
            yield url_of(opened)
        finally:
            server.should_exit = True
            thread.join(LONG)
            assert not thread.is_alive()


class Client:
    """One connection. `hold` is what the keys say; it is sent again and again while waiting."""

    def __init__(self, connection: ClientConnection) -> None:
        self.connection = connection
        self.hold: Input | None = None
        self._seq = 0
        self._next_input = 0.0

    def send(self, message: ClientMessage) -> None:
        self.connection.send(encode(message))

    def press(self, **keys: Any) -> int:
        """Hold keys from now on; the number of the input."""
        self._seq += 1
        self.hold = Input(seq=self._seq, **keys)
        self._next_input = 0.0
        return self._seq

    def receive(self) -> ServerMessage | PoseFrame:
        if self.hold is not None and time.monotonic() >= self._next_input:
            self.send(self.hold)
            self._next_input = time.monotonic() + 0.2
        message = self.connection.recv(timeout=LONG)
        return parse(message) if isinstance(message, bytes) else decode_server(message)

    def wait_for(self, kind: type[Kind], when: Callable[[Kind], bool] = lambda _: True) -> Kind:
        """The next message of a kind that fulfils a condition."""
        end = time.monotonic() + LONG
        last = None
        while time.monotonic() < end:
            message = self.receive()
            if isinstance(message, kind):
                last = message
                if when(message):
                    return message
        raise AssertionError(f"waited in vain; the last {kind.__name__} was {last}")

    def frame(self, when: Callable[[PoseFrame], bool] = lambda _: True) -> PoseFrame:
        return self.wait_for(PoseFrame, when)

    def complaint(self) -> str:
        return self.wait_for(Notice, lambda notice: notice.level == "error").message

    def is_served(self) -> bool:
        """Whether the server still answers."""
        self.send(Ping(time.monotonic()))
        self.wait_for(Pong)
        return True


@contextmanager
def client_at(url: str, **options: Any) -> Iterator[Client]:
    """A client of the address of a WebSocket."""
    uri = url.replace("http", "ws", 1)
    with connect(uri, compression=None, proxy=None, open_timeout=LONG, close_timeout=1.0, **options) as connection:
        yield Client(connection)


def client_of(url: str, **options: Any) -> AbstractContextManager[Client]:
    """A client of a server."""
    return client_at(f"{url}/ws", **options)
