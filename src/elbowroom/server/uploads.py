"""Avatars, motions, places and runs that arrive over HTTP: received into files, read in processes of their own."""

import asyncio
import contextlib
import secrets
from collections import Counter
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response

from elbowroom.errors import InputError
from elbowroom.server.apart.answers import NO_SPACE
from elbowroom.server.apart.jobs import PLACE
from elbowroom.server.apart.process import ApartError, FullDiskError, run_apart
from elbowroom.server.clip_store import SentMotions
from elbowroom.server.codec import plain
from elbowroom.server.library import Library
from elbowroom.server.page_key import Sender, page_key
from elbowroom.server.runs import run_response, shown_run
from elbowroom.server.saved_motion import save_motion
from elbowroom.server.schema.bounds import MAX_UPLOAD
from elbowroom.server.schema.menus import AvatarChoice, ClipChoice, SceneChoice, Uploaded
from elbowroom.server.while_there import while_there
from elbowroom.world.scene import Scene

_NAME = 120  # characters of a file's name that are kept
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
    pass


_LATE = (408, "the file did not arrive whole, or too slowly")
_REFUSALS: dict[type[Exception], tuple[int, str]] = {
    _TooLargeError: (413, f"the file is larger than {MAX_UPLOAD // 2**20} MiB"),
    TimeoutError: _LATE,
    ClientDisconnect: _LATE,
    FullDiskError: (507, "there is no space left on the server's disk; try again later"),
    ApartError: (500, "the file could not be read; the server's log says more"),
}


class UploadDesk:
    """Takes a few files at once, and has them read one after the other."""

    def __init__(self, library: Library, pace: Pace | None = None) -> None:
        self._library = library
        self._pace = pace or Pace()
        self._senders: Counter[str] = Counter()
        self._reading = asyncio.Semaphore(1)

    async def take(self, request: Request) -> Response:
        """POST: the raw bytes of an avatar, a motion or a place, `?name=` its name. Answers 201 with an `Uploaded`."""

        async def taken(sender: Sender) -> Response:
            return JSONResponse(plain(await self._taken(request, sender)), 201)

        return await self._admitted(request, taken)

    async def show(self, request: Request) -> Response:
        """POST: the raw bytes of a recording, `?name=` its name. Answers with the run, see `schema.runs`."""

        async def shown(sender: Sender) -> Response:  # noqa: ARG001
            name = request.query_params.get("name", "run.elbow")[:_NAME]
            with self._files() as (file, _):
                await _receive(request, file, self._pace)
                async with self._reading:
                    return run_response(await while_there(request, shown_run(self._library, file, name)))

        return await self._admitted(request, shown)

    async def save(self, request: Request) -> Response:
        """POST: the frames of a walk (`saved_motion`), `?avatar=` its id, `?format=` the ending of the file wanted.

        Answers with the file; the header `x-elbowroom-note` says what is to be known about it.
        """

        async def saved(sender: Sender) -> Response:  # noqa: ARG001
            avatar = await asyncio.to_thread(self._library.avatars.get, request.query_params.get("avatar", ""))
            with self._files() as (file, _):
                await _receive(request, file, self._pace)
                async with self._reading:
                    ending = request.query_params.get("format", "")
                    name, written = await asyncio.to_thread(save_motion, file.read_bytes(), avatar, ending)
            headers = {"content-disposition": f"attachment; filename*=UTF-8''{quote(name)}"}
            if written.notes:
                headers["x-elbowroom-note"] = quote("; ".join(written.notes))
            return Response(written.data, media_type="application/octet-stream", headers=headers)

        return await self._admitted(request, saved)

    async def _admitted(self, request: Request, work: Callable[[Sender], Awaitable[Response]]) -> Response:
        """What the work answers, or why it is not done: each machine may have a few files read at once."""
        sender = Sender(request.client.host if request.client else "", page_key(request.query_params))
        if self._senders[sender.address] >= _EACH or self._senders.total() >= _AT_ONCE:
            return _refused(503, "other files are being read; try again in a moment")
        self._senders[sender.address] += 1
        try:
            return await work(sender)
        except InputError as error:
            return _refused(422, str(error))
        except tuple(_REFUSALS) as error:
            return _refused(*_REFUSALS[type(error)])
        finally:
            self._senders -= Counter((sender.address,))

    async def _taken(self, request: Request, sender: Sender) -> Uploaded:
        name = request.query_params.get("name", "avatar")[:_NAME]
        with self._files() as (file, glb):
            await _receive(request, file, self._pace)
            async with self._reading:
                read = run_apart("read_upload", name, str(file), name, str(glb))
                humanoid, clips, kind = await while_there(request, read)
                if kind == PLACE:
                    read = run_apart("read_place", name, str(file), name, str(glb))
                    document = await while_there(request, read)
            if kind == PLACE:
                scene = self._library.add_place(Scene.from_dict(document, name), glb)
                return Uploaded(None, [], SceneChoice(scene.name, scene.title))
            avatar, own = None, []
            if humanoid is not None:
                avatar = self._library.avatars.add_upload(humanoid, glb if glb.exists() else None, sender)
            if clips:
                with contextlib.suppress(InputError) if avatar else contextlib.nullcontext():
                    own = self._library.clips.add_upload(SentMotions(file, name, kind, tuple(clips), sender))
        choice = None if avatar is None else AvatarChoice(avatar.id, avatar.title)
        return Uploaded(choice, [ClipChoice(clip.id, clip.title) for clip in own])

    @contextmanager
    def _files(self) -> Iterator[tuple[Path, Path]]:
        """Where to put what comes and the avatar made of it; what nobody has taken over is gone in the end."""
        folder = self._library.avatars.folder
        stem = secrets.token_hex(8)
        file, glb = folder / f"{stem}.sent", folder / f"{stem}.glb"
        held = set[Path]()
        try:
            yield file, glb
            held = self._library.files()
        finally:
            for path in {file, glb} - held:
                path.unlink(missing_ok=True)


async def _receive(request: Request, file: Path, pace: Pace) -> None:
    """Write the whole body to a file; stops as soon as it is too long, or comes too slowly."""
    announced = request.headers.get("content-length", "0")
    if not announced.isdecimal() or int(announced) > MAX_UPLOAD:
        raise _TooLargeError
    clock = asyncio.get_running_loop().time
    began, size, chunks = clock(), 0, aiter(request.stream())
    with _told_full(), file.open("wb") as out, contextlib.suppress(StopAsyncIteration):
        while True:
            chunk = await asyncio.wait_for(anext(chunks), max(pace.left(clock() - began, size), 0.0))
            size += len(chunk)
            if size > MAX_UPLOAD:
                raise _TooLargeError
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
