"""Changes of scene, avatar and planner: they take a while, and what was there before goes on meanwhile."""

import asyncio
import logging
from collections.abc import Callable, Hashable, Sequence
from dataclasses import replace
from typing import Any

from elbowroom.body.root import RootState
from elbowroom.errors import InputError
from elbowroom.server.clip_walk import ClipWalk
from elbowroom.server.schema.commands import Configure
from elbowroom.server.schema.progress import Notice
from elbowroom.server.sessions.outbox import Outbox
from elbowroom.server.sessions.planning_thread import PlanningThread
from elbowroom.server.sessions.reports import avatar_message, clip_message, scene_message
from elbowroom.server.sessions.stage import Stage
from elbowroom.server.sessions.walk import Walk, WalkSettings
from elbowroom.server.sessions.wanted import Wanted
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.sharing import bring
from elbowroom.server.wire.codec import encode
from elbowroom.world.scene import Scene

LOG = logging.getLogger("elbowroom.server")

_WAITING = 16  # changes


class Changes:
    """Carries out a session's changes one after the other."""

    def __init__(self, library: Library, stage: Stage, outbox: Outbox, session: Hashable) -> None:
        """`session` is any key of its own: what it shows stays in the library."""
        self._session = session
        self._library, self._stage, self._outbox = library, stage, outbox
        self._wanted: asyncio.Queue[Configure] = asyncio.Queue(_WAITING)

    def ask(self, message: Configure) -> None:
        """Take a change on; raises `InputError` if too many wait."""
        try:
            self._wanted.put_nowait(message)
        except asyncio.QueueFull:
            raise InputError("configure: too many changes at once; wait until those before are done") from None

    async def run(self) -> None:
        """Carry out what is asked, for ever; a change that fails leaves everything as it was."""
        while True:
            message = await self._wanted.get()
            try:
                if self._library.shared:
                    await asyncio.to_thread(bring, self._library, message.scene, message.avatar, message.clip)
                await self._configure(self._possible(message))
            except InputError as error:
                self._outbox.put(Notice("error", str(error)))
            except Exception:
                LOG.exception("a change of settings failed: %s", message)
                self._outbox.put(Notice("error", "that change failed inside the server; its log says more"))
            self._outbox.put(self._stage.settings())

    def _possible(self, message: Configure) -> Configure:
        """The change without choices that do not exist here; the client is told of each."""
        for name, check in self._checks().items():
            choice = getattr(message, name)
            try:
                if choice is not None and choice != "":
                    check(choice)
            except InputError as error:
                self._outbox.put(Notice("error", str(error)))
                message = replace(message, **{name: None})
        return message

    def _checks(self) -> dict[str, Callable[[Any], object]]:
        library = self._library
        return {
            "scene": library.check_scene,
            "avatar": library.avatars.check,
            "clip": library.clips.check,
            "planner": lambda name: WalkSettings(planner=name),
            "queue_size": lambda size: WalkSettings(queue_size=size),
            "walk_speed": lambda speed: WalkSettings(walk_speed=speed),
            "style": lambda name: WalkSettings(style=name),
        }

    async def _configure(self, message: Configure) -> None:
        now = Wanted.of(self._stage.walk)
        wanted = now.changed(message)
        if wanted.differs(now):
            await self._rebuild(now, wanted)
        else:
            self._stage.walk.adjust(wanted.settings)

    async def _rebuild(self, now: Wanted, wanted: Wanted) -> None:
        moved, dressed = wanted.scene != now.scene, wanted.avatar != now.avatar
        notice = wanted.loading(now)
        self._outbox.put(notice)
        try:
            places = () if moved else (self._stage.walk.place,)
            self._library.hold(self._session, now, wanted)
            walk = await prepared(self._library, wanted, places, self._session)
            scene = await told_scene(walk.scene) if moved else None
        finally:
            self._library.hold(self._session, Wanted.of(self._stage.walk))
            self._outbox.put(replace(notice, active=False))
        self._library.hold(self._session, wanted)
        self._outbox.drop_frame()
        self._stage.show(walk)
        if scene is not None:
            self._outbox.put(scene)
        if dressed:
            self._outbox.put(avatar_message(walk.avatar, self._stage.revision))
        if isinstance(walk, ClipWalk) and wanted.clip != now.clip:
            self._outbox.put(clip_message(walk.stored))


async def prepared(library: Library, wanted: Wanted, places: Sequence[RootState], client: Hashable) -> Walk | ClipWalk:
    """A walk or a clip from the library, for a client (any key); takes a while. Raises `InputError`."""
    scene = await library.find_scene(wanted.scene, client)
    if wanted.clip:
        await library.clips.get(wanted.clip).read()
    return await asyncio.to_thread(make_walk, library, wanted, places, scene)


async def told_scene(scene: Scene) -> str:
    """What a client is told of a scene, as text: to make it takes longer than a frame, so another thread does."""
    return await asyncio.to_thread(lambda: encode(scene_message(scene)))


def make_walk(library: Library, wanted: Wanted, places: Sequence[RootState], scene: Scene) -> Walk | ClipWalk:
    """The part of `prepared` that computes, for a worker thread."""
    avatar = library.avatars.get(wanted.avatar)
    if wanted.clip:
        stored = library.clips.get(wanted.clip)
        return ClipWalk(avatar, scene, wanted.settings, stored, as_planned=wanted.as_planned)
    desk = PlanningThread(library.planning, library.meter)
    return Walk(avatar, scene, wanted.settings, places, desk, library.motions_in(wanted.settings.style))
