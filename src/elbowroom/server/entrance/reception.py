"""Where files arrive over HTTP: a few at once, no longer and no slower than allowed, into a private folder."""

import asyncio
import contextlib
import secrets
from collections import Counter
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response

from elbowroom.errors import InputError
from elbowroom.server.apart.answers import NO_SPACE
from elbowroom.server.apart.process import ApartError, FullDiskError
from elbowroom.server.entrance.page_key import Sender, page_key
from elbowroom.server.schema.bounds import MAX_UPLOAD
from elbowroom.server.stores.library import Library

_AT_ONCE, _EACH = 8, 4  # files that are received at once, in all and from each machine
_PAUSE = 20.0  # seconds that a sender may be silent
_GRACE = 20.0  # seconds after which a sender has to have sent what it should by then
_SLOWEST = 64 * 1024  # bytes a second, on the whole


@dataclass(frozen=True)
class Pace:
    """How long a sender may take; times in seconds."""

    pause: float = _PAUSE
    grace: float = _GRACE
    slowest: float = _SLOWEST  # bytes a second

    def left(self, elapsed: float, received: int) -> float:
        """How long it may be silent now."""
        return min(self.pause, self.grace + received / self.slowest - elapsed)


class _TooLargeError(Exception):
    def __init__(self, most: int) -> None:
        super().__init__(f"the file is larger than {_size(most)}")


_LATE = (408, "the file did not arrive whole, or too slowly")
_REFUSALS: dict[type[Exception], tuple[int, str]] = {
    TimeoutError: _LATE,
    ClientDisconnect: _LATE,
    FullDiskError: (507, "there is no space left on the server's disk; try again later"),
    ApartError: (500, "the file could not be read; the server's log says more"),
}


class Reception:
    """Lets in a few senders at once, and keeps what they send in files while it is worked on."""

    def __init__(self, library: Library, pace: Pace | None = None) -> None:
        self._library = library
        self._pace = pace or Pace()
        self._senders: Counter[str] = Counter()

    async def admitted(self, request: Request, work: Callable[[Sender], Awaitable[Response]]) -> Response:
        """What the work answers, or why it is not done: each machine may have a few files read at once."""
        sender = Sender(request.client.host if request.client else "", page_key(request.query_params))
        if self._senders[sender.address] >= _EACH or self._senders.total() >= _AT_ONCE:
            return _refused(503, "other files are being read; try again in a moment")
        self._senders[sender.address] += 1
        try:
            return await work(sender)
        except InputError as error:
            return _refused(422, str(error))
        except _TooLargeError as error:
            return _refused(413, str(error))
        except tuple(_REFUSALS) as error:
            return _refused(*_REFUSALS[type(error)])
        finally:
            self._senders -= Counter((sender.address,))

    @contextmanager
    def files(self, *endings: str) -> Iterator[list[Path]]:
        """Where to put what comes and what is made of it; what nobody has taken over is gone in the end."""
        folder, stem = self._library.avatars.folder, secrets.token_hex(8)
        files = [folder / f"{stem}.{ending}" for ending in endings]
        held = set[Path]()
        try:
            yield files
            held = self._library.files()
        finally:
            for path in set(files) - held:
                path.unlink(missing_ok=True)

    async def receive(self, request: Request, file: Path, most: int | None = None) -> None:
        """Write the whole body to a file; ends as soon as it is longer than `most` bytes, or comes too slowly."""
        await _receive(request, file, self._pace, MAX_UPLOAD if most is None else most)


async def _receive(request: Request, file: Path, pace: Pace, most: int) -> None:
    announced = request.headers.get("content-length", "0")
    if not announced.isdecimal() or int(announced) > most:
        raise _TooLargeError(most)
    clock = asyncio.get_running_loop().time
    began, size, chunks = clock(), 0, aiter(request.stream())
    with _told_full(), file.open("wb") as out, contextlib.suppress(StopAsyncIteration):
        while True:
            chunk = await asyncio.wait_for(anext(chunks), max(pace.left(clock() - began, size), 0.0))
            size += len(chunk)
            if size > most:
                raise _TooLargeError(most)
            out.write(chunk)


@contextmanager
def _told_full() -> Iterator[None]:
    try:
        yield
    except OSError as error:
        if error.errno in NO_SPACE:
            raise FullDiskError from None
        raise


def _refused(status: int, reason: str) -> JSONResponse:
    return JSONResponse({"error": reason}, status, headers={"connection": "close"})


def _size(most: int) -> str:
    return f"{most // 2**20} MiB" if most >= 2**20 else f"{most // 2**10} KiB"
