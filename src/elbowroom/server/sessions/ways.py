"""Walks to places for a session: ways are found in a thread, while playback goes on, and set out on."""

import asyncio

from elbowroom.control.journey import Journey
from elbowroom.errors import InputError
from elbowroom.planning.navigation.way import NoWayError, Place, Spot
from elbowroom.server.schema.commands import Goto
from elbowroom.server.schema.progress import Going
from elbowroom.server.sessions.outbox import Outbox
from elbowroom.server.sessions.stage import Stage
from elbowroom.server.sessions.walk import Walk

_CLIP = "a clip is played: walk first"


class Ways:
    """Answers the last question of one client."""

    def __init__(self, stage: Stage, outbox: Outbox) -> None:
        self._stage, self._outbox = stage, outbox
        self._asked = asyncio.Event()
        self._wish: Goto | None = None
        self._told: tuple[Journey, Going] | None = None

    def ask(self, message: Goto) -> None:
        """Go there as soon as the way is found; a later wish replaces this one."""
        self._wish = message
        self._asked.set()

    async def run(self) -> None:
        """Find what is asked for, for ever."""
        while True:
            await self._asked.wait()
            self._asked.clear()
            wish, self._wish = self._wish, None
            if wish is not None:
                await self._find(wish)

    async def _find(self, wish: Goto) -> None:
        walk = self._stage.walk
        if not isinstance(walk, Walk):
            self._refuse(wish, InputError(_CLIP))
            return
        here = walk.place.x, walk.place.height, walk.place.z
        try:
            way = await asyncio.to_thread(walk.navigator.find, here, _goal(wish))
        except InputError as error:
            self._refuse(wish, error)
            return
        if self._stage.walk is walk and self._wish is None:
            walk.set_out(way)
            self.report()

    def _refuse(self, wish: Goto, error: InputError) -> None:
        nearest = error.nearest if isinstance(error, NoWayError) else None
        x, height, z = wish.place
        self._outbox.put(Going("refused", (x, height or 0.0, z), str(error), nearest))

    def report(self) -> None:
        """Tell the client what has changed about its walk to a place."""
        walk = self._stage.walk
        journey = walk.journey if isinstance(walk, Walk) else None
        if journey is None:
            return
        going = Going(journey.state.value, journey.goal, journey.reason, None)
        if self._told is None or self._told[0] is not journey or self._told[1] != going:
            self._told = journey, going
            self._outbox.put(going)


def _goal(wish: Goto) -> Place | Spot:
    x, height, z = wish.place
    return (x, z) if height is None else (x, height, z)
