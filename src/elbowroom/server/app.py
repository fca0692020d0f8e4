"""The web application: the page, what it loads, and the WebSocket of a live session."""

import asyncio
import logging
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, HTMLResponse, JSONResponse, Response
from starlette.routing import BaseRoute, Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp, Scope
from starlette.websockets import WebSocket

from elbowroom import __version__
from elbowroom.body.loading.permissions import Use
from elbowroom.errors import InputError
from elbowroom.server.apart.process import ApartError, FullDiskError
from elbowroom.server.entrance.admission import Admission
from elbowroom.server.entrance.cut_short import CutShort
from elbowroom.server.entrance.door_word import BehindDoor
from elbowroom.server.entrance.guard import Guard, is_loopback
from elbowroom.server.entrance.in_pieces import InPieces
from elbowroom.server.entrance.open_pages import OpenPages, Tab
from elbowroom.server.entrance.reception import Reception
from elbowroom.server.entrance.while_there import while_there
from elbowroom.server.heap import HandingBack
from elbowroom.server.kernels.kernel_cache import kernels_in_memory
from elbowroom.server.metrics import CONTENT_TYPE as METRICS_TYPE
from elbowroom.server.metrics import metrics_text
from elbowroom.server.schema.progress import Notice
from elbowroom.server.sessions.meter import LATE, PROMPT
from elbowroom.server.sessions.reports import scene_message
from elbowroom.server.sessions.session import Session
from elbowroom.server.stores.avatar_store import StoredAvatar
from elbowroom.server.stores.courses import BusyError
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.runs import run_response, shown_run
from elbowroom.server.stores.saving_desk import SavingDesk
from elbowroom.server.stores.scene_desk import SceneDesk
from elbowroom.server.stores.sharing import bring_file, bring_scene, shared_avatar
from elbowroom.server.stores.uploads import UploadDesk
from elbowroom.server.usage import process_usage
from elbowroom.server.wire.codec import encode, plain
from elbowroom.world.scene import Scene

LOG = logging.getLogger("elbowroom.server")

_WORTH_COMPRESSING = 1024  # bytes
_TRY_AGAIN_LATER = 1013  # close code

HOW_TO_BUILD = "The page is not built. In a checkout run `make env`; or install the package again with pip."
_NO_CLIENT = f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>Elbowroom</title>
<body style="font: 1.1rem/1.5 system-ui; max-width: 36rem; margin: 4rem auto; padding: 0 1rem">
<h1>Elbowroom</h1><p>The server runs, but its page is missing.</p><p>{HOW_TO_BUILD}</p></body></html>"""


def client_folder() -> Path:
    """Where the built page lies in the package."""
    return Path(str(files("elbowroom"))) / "client"


def client_is_built() -> bool:
    """Whether there is a page to serve."""
    return (client_folder() / "index.html").is_file()


def make_app(
    library: Library,
    bound_host: str = "127.0.0.1",
    name: str = "",
    admission: Admission | None = None,
    word: str = "",
) -> Starlette:
    """The application for one server; `bound_host` is the address that it listens on, `name` the name asked for.

    Where `word` is not empty, both are those of a door before it, see `BehindDoor`.
    """
    handlers, reception = _Handlers(library, admission or Admission(library.meter)), Reception(library)
    desk, scenes, saving = UploadDesk(library, reception), SceneDesk(library, reception), SavingDesk(library, reception)
    routes: list[BaseRoute] = [
        Route("/health", handlers.health),
        Route("/api/health", handlers.health),
        Route("/metrics", handlers.metrics),
        Route("/api/catalog", handlers.catalog),
        Route("/api/scenes", scenes.take, methods=["POST"]),
        Route("/api/walks", scenes.walk, methods=["POST"]),
        Route("/api/scenes/{name}", handlers.scene),
        Route("/api/scenes/{name}/document", handlers.document),
        Route("/api/avatars", desk.take, methods=["POST"]),
        Route("/api/runs", desk.show, methods=["POST"]),
        Route("/api/run", handlers.run),
        Route("/api/pages", saving.page, methods=["POST"]),
        Route("/api/walk.elbow", handlers.walk),
        Route("/api/motions", saving.save, methods=["POST"]),
        Route("/avatars/{avatar}.glb", handlers.avatar),
        Route("/places/{place}.glb", handlers.place),
        WebSocketRoute("/ws", handlers.session),
        Mount("/", _page()) if client_is_built() else Route("/", _missing_page),
    ]
    if not client_is_built():
        LOG.warning(HOW_TO_BUILD)
    door = [Middleware(BehindDoor, word=word)] if word else []
    guard = Middleware(Guard, bound_host=bound_host, name=name)
    return Starlette(routes=routes, middleware=[*door, guard, Middleware(CutShort)])


class _Handlers:
    """What the routes do with the library."""

    def __init__(self, library: Library, admission: Admission) -> None:
        self._library = library
        self._admission = admission
        self._pages = OpenPages()
        self._heap = HandingBack()

    async def health(self, request: Request) -> Response:  # noqa: ARG002
        usage, meter, admission = process_usage(), self._library.meter, self._admission
        (frames, late), (answers, slow) = meter.frames.beyond(LATE), meter.answers.beyond(PROMPT)
        return JSONResponse(
            {
                "status": "ending" if admission.ending else "ok",
                "version": __version__,
                "warm": self._library.warm.is_set(),
                "sessions": admission.sessions,
                "room": admission.has_room,
                "refused": admission.refused,
                "frames": frames,
                "framesLate": late,
                "answers": answers,
                "answersLate": slow,
                "wallSeconds": usage.wall_seconds,
                "cpuSeconds": usage.cpu_seconds,
                "residentBytes": usage.resident_bytes,
                "ownBytes": usage.own_bytes,
                "kernels": kernels_in_memory(),
            }
        )

    async def metrics(self, request: Request) -> Response:  # noqa: ARG002
        """The same and more, as Prometheus reads it."""
        text = metrics_text(self._library.meter, self._admission, process_usage(), kernels_in_memory())
        return Response(text, headers={"content-type": METRICS_TYPE})

    async def catalog(self, request: Request) -> Response:  # noqa: ARG002
        return JSONResponse(plain(self._library.catalog()))

    async def scene(self, request: Request) -> Response:
        """The scene as a client draws it."""
        return await self._with_scene(request, lambda scene: JSONResponse(plain(scene_message(scene))))

    async def document(self, request: Request) -> Response:
        """The scene as the JSON document that build mode edits."""
        return await self._with_scene(request, _document)

    async def _with_scene(self, request: Request, answer: Callable[[Scene], Response]) -> Response:
        client = request.client.host if request.client else ""
        try:
            name = request.path_params["name"]
            if self._library.shared:
                await asyncio.to_thread(bring_scene, self._library, name)
            found = self._library.find_scene(name, client)
            return await asyncio.to_thread(answer, await while_there(request, found))  # which takes longer than a frame
        except InputError as error:
            return JSONResponse({"error": str(error)}, 404)
        except ClientDisconnect:
            return Response(status_code=408)
        except (BusyError, ApartError, FullDiskError):
            return JSONResponse({"error": "a course is being made already; try again in a moment"}, 503)

    async def run(self, request: Request) -> Response:
        """The recording that the server was started with."""
        if self._library.run is None:
            return JSONResponse({"error": "no recording is shown here"}, 404)
        try:
            shown = shown_run(self._library, self._library.run, self._library.run.name)
            return run_response(await while_there(request, shown))
        except InputError as error:
            return JSONResponse({"error": str(error)}, 422)
        except ClientDisconnect:
            return Response(status_code=408)
        except (ApartError, FullDiskError):
            return JSONResponse({"error": "the recording could not be read; the server's log says more"}, 500)

    async def walk(self, request: Request) -> Response:
        """The walk that a page shows, as a recording; `?key=` is its secret, `?opening=` which of its copies it is."""
        session = self._pages.session(Tab.of(request.query_params))
        if session is None:
            return JSONResponse({"error": "this page has no walk here"}, 404)
        try:
            return InPieces(session.recording(), media_type="application/octet-stream")
        except InputError as error:
            return JSONResponse({"error": str(error)}, 404)

    def avatar(self, request: Request) -> Response:
        try:
            avatar = shared_avatar(self._library, request.path_params["avatar"])
        except InputError as error:
            return JSONResponse({"error": str(error)}, 404)
        refusal = avatar.humanoid.meta.permissions.refusal(Use.HAND_OUT)
        if refusal is not None and not _has_the_file(request, avatar):
            return JSONResponse({"error": f"{refusal}; it is shown on the machine that has its file"}, 403)
        if avatar.glb is None or not avatar.glb.is_file():
            return JSONResponse({"error": "this avatar has no file"}, 404)
        return FileResponse(avatar.glb, media_type="model/gltf-binary", headers={"cache-control": "no-cache"})

    def place(self, request: Request) -> Response:
        bring_file(self._library, request.path_params["place"])
        glb = self._library.places.get(request.path_params["place"])
        if glb is None or not glb.is_file():
            return JSONResponse({"error": "there is no such place here"}, 404)
        return FileResponse(glb, media_type="model/gltf-binary", headers={"cache-control": "no-cache"})

    async def session(self, socket: WebSocket) -> None:
        await socket.accept()
        machine = socket.client.host if socket.client else ""
        reason = self._admission.refusal(machine)
        if reason is not None:
            await socket.send_text(encode(Notice("error", reason)))
            await socket.close(_TRY_AGAIN_LATER, reason)
            return
        tab = Tab.of(socket.query_params)
        session = Session(socket, self._library, resumes=not self._pages.is_heard(tab.key))
        try:
            with self._pages.showing(tab, session), self._admission.seat(machine):
                await session.run()
        finally:
            await asyncio.to_thread(self._heap.ended, self._admission.sessions)


def _document(scene: Scene) -> Response:
    if scene.place is not None:
        return JSONResponse({"error": f"{scene.title} is the model of a place: build mode edits no models"}, 422)
    return JSONResponse(scene.to_dict())


def _has_the_file(request: Request, avatar: StoredAvatar) -> bool:
    """Whether the client is on this machine or on the one that sent the file: what it sees then is not handed out."""
    client = request.client
    return client is not None and (is_loopback(client.host) or client.host == avatar.sender.address)


def _page() -> ASGIApp:
    """The built client, compressed on its way."""
    return GZipMiddleware(_Page(directory=client_folder(), html=True), _WORTH_COMPRESSING)


class _Page(StaticFiles):
    """The built client: hashed assets may be kept for ever, the page itself is asked for again each time."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        if any(part.startswith(".") for part in Path(path).parts if part != "."):
            path = "not-found"
        response = await super().get_response(path, scope)
        lasting = path.startswith("assets/") and response.status_code == 200
        response.headers["cache-control"] = "public, max-age=31536000, immutable" if lasting else "no-cache"
        return response


async def _missing_page(request: Request) -> Response:  # noqa: ARG001
    return HTMLResponse(_NO_CLIENT, 503)
