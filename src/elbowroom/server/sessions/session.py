"""One live session: a client's messages in, poses out at 60 Hz, on one WebSocket."""

import asyncio
import contextlib
import logging
import time
from collections.abc import Coroutine, Iterable, Sequence

from starlette.types import Message
from starlette.websockets import WebSocket, WebSocketDisconnect

from elbowroom import __version__
from elbowroom.errors import InputError
from elbowroom.server.clip_walk import ClipWalk
from elbowroom.server.entrance.page_key import page_key
from elbowroom.server.entrance.rate_limit import TokenBucket
from elbowroom.server.schema.bounds import INPUT_TIMEOUT, PROTOCOL
from elbowroom.server.schema.commands import ClockMessage, Configure, Goto, Input, Overlays, Ping, Push, Reset
from elbowroom.server.schema.menus import Hello
from elbowroom.server.schema.progress import Loading, Notice, Pong
from elbowroom.server.sessions.changes import Changes, prepared, told_scene
from elbowroom.server.sessions.outbox import Outbox, SlowClientError
from elbowroom.server.sessions.reports import avatar_message, clip_message
from elbowroom.server.sessions.resuming import NOTED_EVERY, Whereabouts, forget, note, recall
from elbowroom.server.sessions.stage import Stage
from elbowroom.server.sessions.standstill import Standstill
from elbowroom.server.sessions.walk import Walk
from elbowroom.server.sessions.wanted import Wanted
from elbowroom.server.sessions.ways import Ways
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.sharing import bring
from elbowroom.server.wire.codec import decode_client, encode
from elbowroom.server.wire.messages import ClientMessage, ServerMessage

LOG = logging.getLogger("elbowroom.server")

INTERVAL = 1.0 / 60.0  # seconds between frames
_ANSWER_EVERY = 0.008  # seconds between frames in answer to inputs; an input in between is obeyed at the next tick
_SELDOM = 0.1  # seconds between status messages, and between frames while paused
_MESSAGE_RATE = 240.0  # messages a second that a client may send
_PATIENCE = 200  # wrong or surplus messages before the connection is closed
_GOODBYE = (1000, 1001)  # close codes of a page that is left
_LAST_WORDS = 0.5  # seconds in which what a client has said before it went is read
_NOTED_AGAIN = 60.0  # seconds after which it is noted again where somebody stands
_TRY_AGAIN_LATER, _POLICY, _INTERNAL = 1013, 1008, 1011  # close codes, RFC 6455 and its registry


class _DoneError(Exception):
    """The session ends for a reason that the client is told."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code, self.reason = code, reason


class Session:
    """The living part of one connection."""

    def __init__(self, socket: WebSocket, library: Library, *, resumes: bool = True) -> None:
        """With `resumes`, a page that was here lately and did not say goodbye goes on where it was."""
        self._socket = socket
        self._key = page_key(socket.query_params)
        self._resumes = resumes and bool(self._key)
        self._there: Whereabouts | None = None
        self._moved = False  # since that was noted
        self._noted = 0.0
        self._code: int | None = None  # with which the client closed
        self._library = library
        self._outbox = Outbox()
        self._standstill = Standstill()
        self._bucket = TokenBucket(_MESSAGE_RATE, _MESSAGE_RATE)
        self._wrong = 0
        self._began = time.monotonic()
        self._heard = 0.0
        self._answered = 0.0  # when the last input was answered by a frame of its own
        self._told = -_SELDOM  # when the last status went out
        self._stage: Stage  # these are made by _open
        self._changes: Changes
        self._ways: Ways

    async def run(self) -> None:
        """Serve the client until it leaves or fails."""
        sender = asyncio.create_task(self._outbox.send_to(self._socket))
        try:
            await self._open()
            await _first_of([sender, *map(asyncio.create_task, self._tasks())])
        except (WebSocketDisconnect, OSError):
            await self._heed_goodbye()
        except (_DoneError, SlowClientError, InputError) as error:
            await self._close(sender, error)
        except Exception as error:
            LOG.exception("a session failed")
            forget(self._library.shelf, self._key)  # else it might fail there again and again
            await self._close(sender, error)
        finally:
            self._library.hold(self)
            if self._library.vmc is not None:
                self._library.vmc.release(self)
            await _stop(sender)
            with contextlib.suppress(AttributeError):  # where it had not begun
                self._stage.close()

    def recording(self) -> bytes:
        """The walk that is shown, as a `.elbow` file; raises `InputError`."""
        return self._stage.walk.recording()

    @property
    def silence(self) -> float:
        """Seconds since the client was heard last."""
        return self._now() - self._heard

    def _tasks(self) -> list[Coroutine[None, None, None]]:
        return [self._read(), self._play(), self._changes.run(), self._ways.run()]

    def _now(self) -> float:
        return time.monotonic() - self._began

    async def _open(self) -> None:
        library = self._library
        await self._recall()
        wanted = Wanted(self._first_scene(), library.avatar, library.walk, library.clip)
        self._outbox.put(Hello(__version__, PROTOCOL, library.catalog(page_key(self._socket.query_params))))
        self._outbox.put(Loading("avatar", library.avatar, True))
        walk = await self._resumed() or await prepared(library, wanted, (), self)
        scene = await told_scene(walk.scene)
        self._outbox.put(Loading("avatar", library.avatar, False))
        self._stage = Stage(walk, self._now(), library.meter)
        self._changes = Changes(library, self._stage, self._outbox, self)
        self._ways = Ways(self._stage, self._outbox)
        self._outbox.put(self._stage.settings())
        self._outbox.put(scene)
        self._outbox.put(avatar_message(walk.avatar, self._stage.revision))
        if isinstance(walk, ClipWalk):
            self._outbox.put(clip_message(walk.stored))
        self._heard = self._now()

    def _first_scene(self) -> str:
        """The one that the page asks for with its connection, if it is at hand, else the server's."""
        asked = self._socket.query_params.get("scene", "")
        return asked if asked in self._library.scenes else self._library.scene

    async def _recall(self) -> None:
        """Learn where the page's last connection was, and have here what it showed."""
        if self._resumes:
            self._there = await asyncio.to_thread(recall, self._library.shelf, self._key)
        if self._there is not None and self._library.shared:
            wanted = self._there.wanted
            await asyncio.to_thread(bring, self._library, wanted.scene, wanted.avatar, wanted.clip)

    async def _resumed(self) -> Walk | ClipWalk | None:
        """The walk that the page's last connection had, in its place; None where there is none."""
        if self._there is None:
            return None
        try:
            self._library.hold(self, self._there.wanted)
            return await prepared(self._library, self._there.wanted, self._there.places, self)
        except InputError:  # what it was shown is gone
            return None

    async def _heed_goodbye(self) -> None:
        """Forget where the user is, if the page was left; that may be read after sending has failed."""
        with contextlib.suppress(TimeoutError, RuntimeError, WebSocketDisconnect):
            async with asyncio.timeout(_LAST_WORDS):
                while self._code is None:
                    event = await self._socket.receive()
                    self._code = event.get("code", 1005) if event["type"] == "websocket.disconnect" else None
        if self._key and self._code in _GOODBYE:
            forget(self._library.shelf, self._key)

    def _note(self) -> None:
        """Remember where the user is, for a next connection."""
        now, walk = self._now(), self._stage.walk
        place, wanted = (None if isinstance(walk, ClipWalk) else walk.place), Wanted.of(walk)
        before, self._there = self._there, (self._there or Whereabouts(wanted)).after(wanted, place)
        self._moved |= before != self._there
        since = now - self._noted
        if self._key and (since > _NOTED_AGAIN or (self._moved and since >= NOTED_EVERY)):
            self._moved, self._noted = False, now
            note(self._library.shelf, self._key, self._there)

    # --- messages in ---------------------------------------------------------------------------------------------

    async def _read(self) -> None:
        while True:
            await asyncio.sleep(0)  # what waits to be read comes at once: others' frames come between
            event = await self._socket.receive()
            if event["type"] == "websocket.disconnect":
                self._code = event.get("code", 1005)
                raise WebSocketDisconnect(self._code)
            self._heard = self._now()
            if not self._bucket.allows(self._heard):
                self._complain("too many messages: at most 240 a second are read")
                continue
            try:
                self._obey(_decoded(event))
            except InputError as error:
                self._complain(str(error))

    def _complain(self, message: str) -> None:
        self._wrong += 1
        if self._wrong >= _PATIENCE:
            raise _DoneError(_POLICY, f"too many wrong messages; the last: {message}")
        if self._wrong <= 10 or self._wrong % 50 == 0:
            self._outbox.put(Notice("error", message))

    def _obey(self, message: ClientMessage) -> None:
        if isinstance(message, Input):
            if self._stage.obey(message, self._now()) and self._now() - self._answered >= _ANSWER_EVERY:
                self._answered = self._now()
                self._show()
        elif isinstance(message, Ping):
            self._outbox.put(Pong(message.t, self._now()))
        elif isinstance(message, Configure):
            self._changes.ask(message)
        elif isinstance(message, Push):
            self._stage.push(message)
        elif isinstance(message, Goto):
            self._ways.ask(message)
        else:
            self._control(message)
            self._outbox.put(self._stage.settings())
            self._send_frame()

    def _control(self, message: ClockMessage | Reset | Overlays) -> None:
        if isinstance(message, ClockMessage):
            if message.steps is not None and not self._bucket.allows(self._heard, message.steps):
                raise InputError("too many steps: at most 240 a second are taken")
            self._tell(self._stage.set_clock(message))
        elif isinstance(message, Reset):
            self._stage.reset()
        else:
            self._stage.overlays = message

    # --- poses out -----------------------------------------------------------------------------------------------

    async def _play(self) -> None:
        """Show a frame every 1/60 s by the clock, without drift; a tick more than a frame late is left out."""
        due = self._now()
        while True:
            due = max(due + INTERVAL, self._now() - INTERVAL)
            await asyncio.sleep(max(due - self._now(), 0.0))
            if self._now() - self._heard > INPUT_TIMEOUT:
                self._stage.release()
            seldom = self._now() - self._told >= _SELDOM
            if seldom or not self._stage.paused:
                self._show()
                self._stage.punctuality.shown(self._now() - due)
            if seldom:
                self._ways.report()
                self._report()
                self._note()

    def _show(self) -> None:
        now = self._now()
        self._tell(self._stage.advance(now))
        self._tell(self._stage.pushed())
        packed = self._stage.frame(now)
        if self._standstill.worth_sending(packed, now, restless=self._stage.restless):
            self._outbox.put_frame(packed)
        if self._library.vmc is not None:
            self._library.vmc.show(self, self._stage.walk.avatar.humanoid, self._stage.moment())

    def _send_frame(self) -> None:
        self._outbox.put_frame(self._stage.frame(self._now()))

    def _report(self) -> None:
        self._told = self._now()
        self._library.meter.look()
        self._outbox.put(self._stage.status(self._told))
        if self._stage.overlays.plan:
            self._outbox.put(self._stage.plan())

    def _tell(self, events: Iterable[ServerMessage]) -> None:
        for event in events:
            self._outbox.put(event)

    # --- the end -------------------------------------------------------------------------------------------------

    async def _close(self, sender: "asyncio.Task[None]", error: Exception) -> None:
        """Say why, if the client still listens, and close."""
        code, reason = _farewell(error)
        await _stop(sender)
        with contextlib.suppress(Exception):
            async with asyncio.timeout(2.0):
                await self._socket.send_text(encode(Notice("error", reason)))
                await self._socket.close(code, reason[:100])


def _decoded(event: Message) -> ClientMessage:
    text = event.get("text")
    if text is None:
        raise InputError("message: binary messages are not read here; send JSON text")
    return decode_client(text)


def _farewell(error: Exception) -> tuple[int, str]:
    if isinstance(error, _DoneError):
        return error.code, error.reason
    if isinstance(error, SlowClientError):
        return _TRY_AGAIN_LATER, "the client reads too slowly"
    if isinstance(error, InputError):
        return _INTERNAL, str(error)
    return _INTERNAL, "the session failed inside the server; its log says more"


async def _first_of(tasks: "Sequence[asyncio.Task[None]]") -> None:
    """Wait until one of the tasks ends, end the others, and raise what ended it."""
    try:
        done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        await _stop(*tasks)
    for task in done:
        if not task.cancelled():
            task.result()


async def _stop(*tasks: "asyncio.Task[None]") -> None:
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
