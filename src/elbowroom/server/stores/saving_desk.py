"""Walks that pages have kept, handed back to them as files, which are written in processes of their own."""

import asyncio
from pathlib import Path
from urllib.parse import quote

from starlette.requests import Request
from starlette.responses import Response

from elbowroom.server.apart.bounds import Bounds
from elbowroom.server.apart.process import run_apart
from elbowroom.server.entrance.in_pieces import InPieces
from elbowroom.server.entrance.page_key import Sender
from elbowroom.server.entrance.reception import Reception
from elbowroom.server.entrance.while_there import while_there
from elbowroom.server.stores.avatar_store import StoredAvatar
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.put_body import put_body
from elbowroom.server.stores.saved_motion import check_format
from elbowroom.server.stores.sharing import shared_avatar

# Ten minutes of an avatar with 54 nodes take up to 1.3 GB and 14 s of a processor: written as text, 180 MB of it.
_BOUNDS = Bounds(memory=2**31, processor=60, wall=240.0, answer=2**20, written=2**28)


class SavingDesk:
    """Has files written one after the other."""

    def __init__(self, library: Library, reception: Reception) -> None:
        self._library = library
        self._reception = reception
        self._writing = asyncio.Semaphore(1)

    async def save(self, request: Request) -> Response:
        """POST: the frames of a walk (`saved_motion`), `?avatar=` its id, `?format=` the ending of the file wanted.

        Answers with the file; the header `x-elbowroom-note` says what is to be known about it.
        """

        async def saved(sender: Sender) -> Response:  # noqa: ARG001
            ending = request.query_params.get("format", "")
            check_format(ending)
            avatar = await self._avatar(request)
            name = f"{Path(avatar.title).stem or 'avatar'}-walk.{ending}"
            return await self._written(request, avatar, "save_motion", ending, name)

        return await self._reception.admitted(request, saved)

    async def page(self, request: Request) -> Response:
        """POST: a run as `schema.runs` has it, `?avatar=` the id of its avatar. Answers with a page that plays it."""

        async def written(sender: Sender) -> Response:  # noqa: ARG001
            avatar = await self._avatar(request)
            return await self._written(request, avatar, "write_page", avatar.id, "walk.html")

        return await self._reception.admitted(request, written)

    async def _avatar(self, request: Request) -> StoredAvatar:
        return await asyncio.to_thread(shared_avatar, self._library, request.query_params.get("avatar", ""))

    async def _written(self, request: Request, avatar: StoredAvatar, job: str, how: str, name: str) -> Response:
        glb = str(avatar.glb) if avatar.glb is not None and avatar.glb.is_file() else ""
        with self._reception.files("sent", "body", "made") as (file, body, made):
            await self._reception.receive(request, file)
            await asyncio.to_thread(put_body, avatar, body)
            async with self._writing:
                work = run_apart(job, name, str(file), str(body), glb, how, str(made), bounds=_BOUNDS)
                notes = await while_there(request, work)
            data = await asyncio.to_thread(made.read_bytes)
        headers = {"content-disposition": f"attachment; filename*=UTF-8''{quote(name)}"}
        if notes:
            headers["x-elbowroom-note"] = quote("; ".join(notes))
        return InPieces(data, media_type="application/octet-stream", headers=headers)
