"""Avatar and motion files that arrive over HTTP."""

import asyncio
import contextlib
import logging
from typing import NamedTuple

from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response

from elbowroom.clips.files import has_animations, is_motion_only
from elbowroom.errors import InputError
from elbowroom.server.clip_store import StoredClip
from elbowroom.server.codec import plain
from elbowroom.server.library import Library
from elbowroom.server.page_key import page_key
from elbowroom.server.schema.bounds import MAX_UPLOAD
from elbowroom.server.schema.menus import AvatarChoice, ClipChoice, Uploaded

LOG = logging.getLogger("elbowroom.server")

_NAME = 120  # characters of a file's name that are kept
_PAUSE = 20.0  # seconds that a sender may be silent


class _TooLargeError(Exception):
    pass


class _Sender(NamedTuple):
    address: str
    key: str  # of its page, "" for a program


class UploadDesk:
    """Takes one file at a time, so that the memory it needs is bounded."""

    def __init__(self, library: Library) -> None:
        self._library = library
        self._free = asyncio.Lock()

    async def take(self, request: Request) -> Response:
        """POST: the raw bytes of an avatar or motion file, `?name=` its name. Answers 201 with an `Uploaded`."""
        if self._free.locked():
            return _refused(503, "another file is being read; try again in a moment")
        async with self._free:
            try:
                data = await _body(request)
                name = request.query_params.get("name", "avatar")[:_NAME]
                sender = _Sender(request.client.host if request.client else "", page_key(request.query_params))
                uploaded = await asyncio.to_thread(self._read, data, name, sender)
            except _TooLargeError:
                return _refused(413, f"the file is larger than {MAX_UPLOAD // 2**20} MiB")
            except InputError as error:
                return _refused(422, str(error))
            except (TimeoutError, ClientDisconnect):
                return _refused(408, "the file did not arrive whole")
            except Exception:
                LOG.exception("an uploaded file could not be read")
                return _refused(500, "the file could not be read; the server's log says more")
        return JSONResponse(plain(uploaded), 201)

    def _read(self, data: bytes, name: str, sender: _Sender) -> Uploaded:
        """By content: a motion, an avatar, or an avatar with motions of its own."""
        clips = self._library.clips
        if is_motion_only(data, name):
            return Uploaded(
                None, [ClipChoice(clip.id, clip.title) for clip in clips.add_upload(data, name, sender.key)]
            )
        avatar = self._library.avatars.add_upload(data, name, sender.address, sender.key)
        own: list[StoredClip] = []
        if has_animations(data, name):
            with contextlib.suppress(InputError):
                own = clips.add_upload(data, name, sender.key)
        return Uploaded(AvatarChoice(avatar.id, avatar.title), [ClipChoice(clip.id, clip.title) for clip in own])


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
