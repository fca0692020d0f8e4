"""Avatars, motions, places and runs that arrive over HTTP, read in processes of their own."""

import asyncio
import contextlib
from pathlib import Path

from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from elbowroom.errors import InputError
from elbowroom.server.apart.jobs import PLACE
from elbowroom.server.apart.process import run_apart
from elbowroom.server.entrance.page_key import Sender
from elbowroom.server.entrance.reception import Reception
from elbowroom.server.entrance.while_there import while_there
from elbowroom.server.schema.menus import AvatarChoice, ClipChoice, SceneChoice, Uploaded
from elbowroom.server.stores.clip_store import SentMotions
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.runs import run_response, shown_run
from elbowroom.server.stores.sharing import share_avatar, share_clips, share_scene
from elbowroom.server.wire.codec import plain
from elbowroom.world.scene import Scene

_NAME = 120  # characters of a file's name that are kept


class UploadDesk:
    """Has files read one after the other."""

    def __init__(self, library: Library, reception: Reception) -> None:
        self._library = library
        self._reception = reception
        self._reading = asyncio.Semaphore(1)

    async def take(self, request: Request) -> Response:
        """POST: the raw bytes of an avatar, a motion or a place, `?name=` its name. Answers 201 with an `Uploaded`."""

        async def taken(sender: Sender) -> Response:
            return JSONResponse(plain(await self._taken(request, sender)), 201)

        return await self._reception.admitted(request, taken)

    async def show(self, request: Request) -> Response:
        """POST: the raw bytes of a recording, `?name=` its name. Answers with the run, see `schema.runs`."""

        async def shown(sender: Sender) -> Response:  # noqa: ARG001
            name = request.query_params.get("name", "run.elbow")[:_NAME]
            with self._reception.files("sent") as (file,):
                await self._reception.receive(request, file)
                async with self._reading:
                    return run_response(await while_there(request, shown_run(self._library, file, name)))

        return await self._reception.admitted(request, shown)

    async def _taken(self, request: Request, sender: Sender) -> Uploaded:
        name = request.query_params.get("name", "avatar")[:_NAME]
        with self._reception.files("sent", "glb") as (file, glb):
            await self._reception.receive(request, file)
            async with self._reading:
                read = run_apart("read_upload", name, str(file), name, str(glb))
                humanoid, clips, kind = await while_there(request, read)
                if kind == PLACE:
                    read = run_apart("read_place", name, str(file), name, str(glb))
                    scene = await asyncio.to_thread(self._place_of, await while_there(request, read), name, glb, sender)
                    return Uploaded(None, [], SceneChoice(scene.name, scene.title))
            avatar, own = None, []
            if humanoid is not None:
                avatar = self._library.avatars.add_upload(humanoid, glb if glb.exists() else None, sender)
                await asyncio.to_thread(share_avatar, self._library, avatar)
            if clips:
                with contextlib.suppress(InputError) if avatar else contextlib.nullcontext():
                    sent = SentMotions(file, name, kind, tuple(clips), sender)
                    own = self._library.clips.add_upload(sent)
                    await asyncio.to_thread(share_clips, self._library, sent, own)
        choice = None if avatar is None else AvatarChoice(avatar.id, avatar.title)
        return Uploaded(choice, [ClipChoice(clip.id, clip.title) for clip in own])

    def _place_of(self, document: object, name: str, glb: Path, sender: Sender) -> Scene:
        """Keep the place that a file told of."""
        scene = self._library.sent.add_place(Scene.from_dict(document, name), glb, sender)
        share_scene(self._library, scene)
        return scene
