"""Avatar files that arrive over HTTP."""

import asyncio
import contextlib
import logging

from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response

from elbowroom.errors import InputError
from elbowroom.server.avatar_store import AvatarStore
from elbowroom.server.codec import plain
from elbowroom.server.messages import MAX_UPLOAD, AvatarChoice

LOG = logging.getLogger("elbowroom.server")

_NAME = 120  # characters of a file's name that are kept
_PAUSE = 20.0  # seconds that a sender may be silent


class _TooLargeError(Exception):
    pass


class UploadDesk:
    """Takes one file at a time, so that the memory it needs is bounded."""

    def __init__(self, avatars: AvatarStore) -> None:
        self._avatars = avatars
        self._free = asyncio.Lock()

    async def take(self, request: Request) -> Response:
        """POST: the raw bytes of a VRM or GLB file, `?name=` its name. Answers 201 with id and title."""
        if self._free.locked():
            return _refused(503, "another file is being read; try again in a moment")
        async with self._free:
            try:
                data = await _body(request)
                name = request.query_params.get("name", "avatar")[:_NAME]
                avatar = await asyncio.to_thread(self._avatars.add_upload, data, name)
            except _TooLargeError:
                return _refused(413, f"the file is larger than {MAX_UPLOAD // 2**20} MiB")
            except InputError as error:
                return _refused(422, str(error))
            except (TimeoutError, ClientDisconnect):
                return _refused(408, "the file did not arrive whole")
            except Exception:
                LOG.exception("an uploaded avatar could not be read")
                return _refused(500, "the file could not be read; the server's log says more")
        return JSONResponse(plain(AvatarChoice(avatar.id, avatar.title)), 201)


async def _body(request: Request) -> bytes:
    """The whole body; stops reading as soon as it is too long."""
    announced = request.headers.get("content-length", "0")
    if not announced.isdecimal() or int(announced) > MAX_UPLOAD:
        raise _TooLargeError
    data, chunks = bytearray(), aiter(request.stream())
    with contextlib.suppress(StopAsyncIteration):
        while True:
            data += await asyncio.wait_for(anext(chunks), _PAUSE)
            if len(data) > MAX_UPLOAD:
                raise _TooLargeError
    return bytes(data)


def _refused(status: int, reason: str) -> JSONResponse:
    return JSONResponse({"error": reason}, status, headers={"connection": "close"})
