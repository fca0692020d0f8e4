"""Random courses over HTTP: one in the making for each client, and none for who has left."""

import asyncio
from collections.abc import Iterator

import pytest
from starlette.applications import Starlette

from asgi_visitor import Visitor
from elbowroom.server.app import make_app
from elbowroom.server.stores import courses
from elbowroom.server.stores.library import Library
from elbowroom.world.scene import Scene

BUSY = "a course is being made already; try again in a moment"
HERE, BESIDE = "127.0.0.1", "127.0.0.2"


class Makers:
    """What stands for the processes that make courses: they wait until a test lets them end."""

    def __init__(self) -> None:
        self.begun: list[str] = []
        self.given_up: list[str] = []
        self._may_end = asyncio.Event()

    async def make(self, job: str, name: str, course: str) -> object:
        """In the place of `run_apart`."""
        self.begun.append(course)
        try:
            await self._may_end.wait()
        except asyncio.CancelledError:
            self.given_up.append(course)
            raise
        return Scene.load("a").to_dict()

    def end(self) -> None:
        """Let all be made."""
        self._may_end.set()

    async def wait_for(self, course: str) -> None:
        """Wait until a course is in the making."""
        async with asyncio.timeout(60.0):
            while course not in self.begun:
                await asyncio.sleep(0.001)


@pytest.fixture
def makers(monkeypatch: pytest.MonkeyPatch) -> Makers:
    made = Makers()
    monkeypatch.setattr(courses, "run_apart", made.make)
    return made


@pytest.fixture
def app() -> Iterator[Starlette]:
    library = Library.open("b")
    yield make_app(library)
    library.close()


def asks(app: Starlette, number: int, machine: str = HERE, of: str = "") -> Visitor:
    return Visitor(app, "GET", f"/api/scenes/gauntlet:5:{number}{of}", machine)


def test_a_second_course_for_the_same_client_is_refused_in_a_sentence(app: Starlette, makers: Makers) -> None:
    async def ask() -> None:
        first = asks(app, 101)
        await makers.wait_for("gauntlet:5:101")
        for again in (asks(app, 102), asks(app, 101), asks(app, 102, of="/document")):
            assert await again.answer() == (503, {"error": BUSY})
        other = asks(app, 102, BESIDE)
        for _ in range(50):
            await asyncio.sleep(0)
        assert (other.answered, makers.begun) == (False, ["gauntlet:5:101"])  # it waits for its turn
        makers.end()
        for visitor, name in ((first, "gauntlet:5:101"), (other, "gauntlet:5:102"), (asks(app, 103), "gauntlet:5:103")):
            status, scene = await visitor.answer()
            assert (status, scene["name"]) == (200, name)
        assert makers.begun == ["gauntlet:5:101", "gauntlet:5:102", "gauntlet:5:103"]

    asyncio.run(ask())


def test_who_leaves_has_no_course_made_and_may_ask_for_another(app: Starlette, makers: Makers) -> None:
    async def ask() -> None:
        first = asks(app, 101)
        await makers.wait_for("gauntlet:5:101")
        first.leaves()
        assert (await first.answer())[0] == 408
        assert makers.given_up == ["gauntlet:5:101"]
        second = asks(app, 102)
        await makers.wait_for("gauntlet:5:102")
        makers.end()
        assert (await second.answer())[0] == 200

    asyncio.run(ask())
