"""Random courses by name, made in processes of their own: one for each client at a time, a few of them remembered."""

import asyncio
from collections import OrderedDict
from collections.abc import Hashable, Iterator
from contextlib import contextmanager
from dataclasses import replace

from elbowroom.server.apart.process import run_apart
from elbowroom.world.scene import Scene

REMEMBERED = 8  # courses; where somebody has walked, there is a map of room with each, some megabytes
_AT_ONCE = 1  # processes: the other processors are for walking


class BusyError(Exception):
    """A course is being made for this client already."""


class Courses:
    """Makes and remembers courses; lives in one event loop."""

    def __init__(self) -> None:
        self._known: OrderedDict[str, Scene] = OrderedDict()
        self._asking: set[Hashable] = set()
        self._making = asyncio.Semaphore(_AT_ONCE)

    async def find(self, name: str, client: Hashable) -> Scene:
        """The course of this name, which has been checked, for a client (any key).

        Raises `BusyError` where one is in the making for the client, and as `run_apart`.
        """
        known = self.known(name)
        if known is not None:
            return known
        with self._asks(client):
            async with self._making:
                return self.known(name) or self._remember(name, await run_apart("make_course", name, name))

    def known(self, name: str) -> Scene | None:
        """The course, if it was made lately."""
        if name not in self._known:
            return None
        self._known.move_to_end(name)
        return self._known[name]

    def _remember(self, name: str, document: object) -> Scene:
        scene = replace(Scene.from_dict(document, name), name=name)
        self._known[name] = scene
        while len(self._known) > REMEMBERED:
            self._known.popitem(last=False)
        return scene

    @contextmanager
    def _asks(self, client: Hashable) -> Iterator[None]:
        if client in self._asking:
            raise BusyError
        self._asking.add(client)
        try:
            yield
        finally:
            self._asking.discard(client)
