"""Scenes that pages build: read, kept and walked unseen, in processes of their own."""

import asyncio
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse, Response

from elbowroom.server.apart.bounds import Bounds
from elbowroom.server.apart.process import run_apart
from elbowroom.server.entrance.page_key import Sender
from elbowroom.server.entrance.reception import Reception
from elbowroom.server.entrance.while_there import while_there
from elbowroom.server.schema.bounds import MAX_SCENE
from elbowroom.server.schema.menus import SceneChoice
from elbowroom.server.schema.scenes import UnseenWalk
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.put_body import put_body
from elbowroom.server.stores.sharing import share_scene, shared_avatar
from elbowroom.server.wire.codec import plain
from elbowroom.world.scene import Scene

_READING = Bounds(memory=512 * 2**20, processor=20, wall=60.0, answer=8 * 2**20, written=2**20)
_WALKING = Bounds(processor=50, wall=240.0, answer=2**20, written=2**20)
_NAME = "scene"  # as messages about it call it


class SceneDesk:
    """Takes scenes as JSON of at most `MAX_SCENE` bytes; one is read, and one walked, at a time."""

    def __init__(self, library: Library, reception: Reception) -> None:
        self._library = library
        self._reception = reception
        self._reading, self._walking = asyncio.Semaphore(1), asyncio.Semaphore(1)

    async def take(self, request: Request) -> Response:
        """POST: a scene to walk in. Answers 201 with a `SceneChoice`, or 422 and the first thing that is wrong."""

        async def taken(sender: Sender) -> Response:
            with self._reception.files("sent") as (file,):
                scene = await asyncio.to_thread(self._kept, await self._read(request, file), sender)
            return JSONResponse(plain(SceneChoice(scene.name, scene.title)), 201)

        return await self._reception.admitted(request, taken)

    async def walk(self, request: Request) -> Response:
        """POST: a scene to be walked unseen by `?avatar=`. Answers with an `UnseenWalk`, or as `take`."""

        async def walked(sender: Sender) -> Response:  # noqa: ARG001
            avatar = await asyncio.to_thread(shared_avatar, self._library, request.query_params.get("avatar", ""))
            with self._reception.files("sent", "body") as (file, body):
                await self._reception.receive(request, file, MAX_SCENE)
                await asyncio.to_thread(put_body, avatar, body)
                async with self._walking:
                    walk = run_apart("walk_scene", _NAME, str(file), _NAME, str(body), bounds=_WALKING)
                    return JSONResponse(plain(UnseenWalk(*await while_there(request, walk))))

        return await self._reception.admitted(request, walked)

    async def _read(self, request: Request, file: Path) -> dict[str, Any]:
        await self._reception.receive(request, file, MAX_SCENE)
        async with self._reading:
            read = run_apart("read_scene", _NAME, str(file), _NAME, bounds=_READING)
            document: dict[str, Any] = await while_there(request, read)
            return document

    def _kept(self, document: object, sender: Sender) -> Scene:
        """Keep the scene that was read."""
        scene = self._library.sent.add_built(Scene.from_dict(document, _NAME), sender)
        share_scene(self._library, scene)
        return scene
