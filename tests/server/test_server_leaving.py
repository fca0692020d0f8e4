"""Who sends a file and goes while it is read: nobody reads on, and the next file is taken."""

import asyncio
import http.client
import json
import socket
import struct
import time
from collections.abc import Callable, Iterator
from contextlib import closing

import pytest

from child_processes import children
from elbowroom.server.stores.library import Library
from live_session import LONG, running

SENDERS = 6  # more than may send at once
NEVER_DONE = "import time; time.sleep(300)"  # stands for a file that takes long to read


@pytest.fixture(scope="module")
def url() -> Iterator[str]:
    with closing(Library.open("empty")) as library, running(library) as address:
        yield address


def wait_until(is_so: Callable[[], bool]) -> None:
    """Wait for a state: only a fault makes that last long."""
    end = time.monotonic() + LONG
    while not is_so():
        assert time.monotonic() < end
        time.sleep(0.01)


def sender_of(url: str, path: str) -> socket.socket:
    """A connection over which all of a file was sent."""
    host, port = url.removeprefix("http://").split(":")
    opened = socket.create_connection((host, int(port)), timeout=LONG)
    opened.sendall(f"POST {path} HTTP/1.1\r\nHost: {host}:{port}\r\nContent-Length: 4\r\n\r\nfile".encode())
    return opened


@pytest.mark.parametrize("path", ["/api/avatars?name=a.vrm", "/api/scenes", "/api/runs", "/api/walks?avatar=stock"])
def test_a_reader_ends_when_the_sender_leaves_and_the_next_file_is_read(
    url: str, path: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    started, before = asyncio.create_subprocess_exec, children()

    async def reader(*command: str, **options: object) -> asyncio.subprocess.Process:
        return await started(command[0], "-c", NEVER_DONE, **options)  # type: ignore[arg-type]

    with monkeypatch.context() as patched:
        patched.setattr(asyncio, "create_subprocess_exec", reader)
        for number in range(SENDERS):
            with closing(sender_of(url, path)) as sender:
                wait_until(lambda: len(children() - before) == 1)
                if number % 2:  # by a reset, as of a program that is killed
                    sender.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            wait_until(lambda: not children() - before)
    connection = http.client.HTTPConnection(url.removeprefix("http://"), timeout=LONG)
    with closing(connection):
        connection.request("POST", "/api/avatars?name=next.vrm", b"no avatar")
        answer = connection.getresponse()
        assert answer.status == 422
        assert json.load(answer)["error"].startswith("next.vrm")
