"""Changes of scene, avatar and planner: they take a while, and what was there before goes on meanwhile."""

import asyncio
import logging
from dataclasses import replace

from elbowroom.body.root import RootState
from elbowroom.errors import InputError
from elbowroom.server.library import Library
from elbowroom.server.messages import Configure, Loading, Notice
from elbowroom.server.outbox import Outbox
from elbowroom.server.planning_thread import PlanningThread
from elbowroom.server.reports import avatar_message, scene_message
from elbowroom.server.stage import Stage
from elbowroom.server.walk import Walk, WalkSettings

LOG = logging.getLogger("elbowroom.server")

_WAITING = 16  # changes


class Changes:
    """Carries out a session's changes one after the other."""

    def __init__(self, library: Library, stage: Stage, outbox: Outbox) -> None:
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
                await self._configure(self._possible(message))
            except InputError as error:
                self._outbox.put(Notice("error", str(error)))
            except Exception:
                LOG.exception("a change of settings failed: %s", message)
                self._outbox.put(Notice("error", "that change failed inside the server; its log says more"))
            self._outbox.put(self._stage.settings())

    def _possible(self, message: Configure) -> Configure:
        """The change without choices that do not exist here; the client is told of each."""
        for name, check in {"scene": self._library.find_scene, "avatar": self._library.avatars.check}.items():
            choice = getattr(message, name)
            try:
                if choice is not None:
                    check(choice)
            except InputError as error:
                self._outbox.put(Notice("error", str(error)))
                message = replace(message, **{name: None})
        return message

    async def _configure(self, message: Configure) -> None:
        walk = self._stage.walk
        settings = _merged(walk.settings, message)
        scene, avatar = message.scene or walk.scene.name, message.avatar or walk.avatar.id
        rebuilt = (settings.planner, settings.queue_size) != (walk.settings.planner, walk.settings.queue_size)
        if (scene, avatar) == (walk.scene.name, walk.avatar.id) and not rebuilt:
            walk.adjust(settings)
            return
        await self._rebuild(scene, avatar, settings)

    async def _rebuild(self, scene: str, avatar: str, settings: WalkSettings) -> None:
        old = self._stage.walk
        moved, dressed = scene != old.scene.name, avatar != old.avatar.id
        notice = Loading("avatar", avatar, True) if dressed else Loading("scene", scene, True)
        notice = notice if moved or dressed else Loading("planner", settings.planner, True)
        self._outbox.put(notice)
        try:
            walk = await asyncio.to_thread(
                make_walk, self._library, scene, avatar, settings, None if moved else old.place
            )
        finally:
            self._outbox.put(replace(notice, active=False))
        self._outbox.drop_frame()
        self._stage.show(walk)
        if moved:
            self._outbox.put(scene_message(walk.scene))
        if dressed:
            self._outbox.put(avatar_message(walk.avatar, self._stage.revision))


def make_walk(library: Library, scene: str, avatar: str, settings: WalkSettings, place: RootState | None) -> Walk:
    """A walk from the library; takes a while, so call it in a worker thread. Raises `InputError`."""
    desk = PlanningThread(library.planning)
    return Walk(library.avatars.get(avatar), library.find_scene(scene), settings, place, desk)


def _merged(settings: WalkSettings, message: Configure) -> WalkSettings:
    wanted = {name: getattr(message, name) for name in ("planner", "queue_size", "assist", "walk_speed")}
    return replace(settings, **{name: value for name, value in wanted.items() if value is not None})
