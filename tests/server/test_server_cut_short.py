"""The end of the server while it works for somebody: the client is told, and the log stays clean."""

import asyncio
import signal
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

import httpx
from starlette.types import Message

from elbowroom.server.entrance.cut_short import ABOUT_TO_END, CutShort

SERVER = """
from elbowroom.cli import play
from elbowroom.server.apart.process import run_apart
from elbowroom.server.stores import uploads
from elbowroom.server.stores.library import Library

async def told(*arguments):
    print("reading", flush=True)
    return await run_apart(*arguments)

def ready(library, url, open_page):
    print(url, library.avatars.folder, flush=True)

uploads.run_apart, play.compile_first, play._ready = told, lambda: None, ready
play.serve_until_interrupted(lambda: Library.open("empty"), "127.0.0.1", 0, open_page=False)
"""


def cancelled(*before: Message) -> list[Message]:
    """What a client is sent by a request that is cancelled once it has sent so much."""
    told: list[Message] = []

    async def forever(scope: object, receive: object, send: object) -> None:
        for message in before:
            await send(message)  # type: ignore[operator]
        await asyncio.sleep(3600.0)

    async def nothing() -> Message:
        return {"type": "http.request"}

    async def tell(message: Message) -> None:
        told.append(message)

    async def cut() -> None:
        request = asyncio.create_task(CutShort(forever)({"type": "http"}, nothing, tell))
        await asyncio.sleep(0.0)
        request.cancel()
        await request

    asyncio.run(cut())
    return told


def test_who_waits_is_told() -> None:
    head, body = cancelled()
    assert head["status"] == 503
    assert ABOUT_TO_END in body["body"].decode()


def test_half_an_answer_is_left_alone() -> None:
    begun = {"type": "http.response.start", "status": 200, "headers": []}
    assert cancelled(begun) == [begun]


def hills(side: int) -> bytes:
    """A model of so many squares along each side, as OBJ: it takes a while to read."""
    points = [f"v {x} {((7 * x + 3 * z) % 11) / 10} {z}" for x in range(side + 1) for z in range(side + 1)]
    corners = [x * (side + 1) + z + 1 for x in range(side) for z in range(side)]
    return "\n".join([*points, *(f"f {c} {c + 1} {c + side + 2} {c + side + 1}" for c in corners)]).encode()


def commands_that_run() -> Iterator[bytes]:
    for file in Path("/proc").glob("[0-9]*/cmdline"):
        with suppress(OSError):
            yield file.read_bytes()


def test_a_signal_ends_the_server_while_a_file_is_read(tmp_path: Path) -> None:
    said = tmp_path / "stderr.txt"
    command = [sys.executable, "-c", SERVER]
    with (
        said.open("w") as stderr,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=stderr, text=True) as server,
        ThreadPoolExecutor(1) as pool,
    ):
        assert server.stdout is not None
        url, folder = server.stdout.readline().split()
        answer = pool.submit(httpx.post, f"{url}/api/avatars?name=hills.obj", content=hills(250), timeout=60.0)
        assert server.stdout.readline() == "reading\n"
        server.send_signal(signal.SIGINT)
        assert server.wait(20) == 0
        assert ABOUT_TO_END in answer.result().text
    assert "Traceback" not in said.read_text()
    assert "Stopped." in said.read_text()
    assert folder.encode() not in b"".join(commands_that_run())  # nobody reads on
