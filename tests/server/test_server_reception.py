"""How many files are taken in at once, of one machine and in all; and that a place is given back however it ends."""

import asyncio
from collections.abc import Iterator, Sequence
from functools import partial

import pytest
from starlette.applications import Starlette

from asgi_visitor import Visitor
from elbowroom.server.app import make_app
from elbowroom.server.entrance import reception
from elbowroom.server.stores import scene_desk
from elbowroom.server.stores.library import Library

BUSY = "other files are being read; try again in a moment"
DESKS = ("/api/motions", "/api/avatars", "/api/scenes", "/api/runs", "/api/walks", "/api/pages")
HERE, BESIDE, ELSEWHERE = "127.0.0.1", "127.0.0.2", "127.0.0.3"
LARGE, WRONG, LEFT = b"x" * 2000, b"", None  # how a sender ends: it sends too much, what is no file, or is gone


@pytest.fixture
def app(monkeypatch: pytest.MonkeyPatch) -> Iterator[Starlette]:
    for room, most in ((reception, "MAX_UPLOAD"), (scene_desk, "MAX_SCENE")):
        monkeypatch.setattr(room, most, 1000)
    monkeypatch.setattr(reception, "Pace", partial(reception.Pace, pause=600.0, grace=600.0))  # however busy this is
    library = Library.open("b")
    yield make_app(library)
    library.close()


async def is_let_in(upload: Visitor) -> bool:
    """Whether its file is waited for; else it was told that others are read."""
    upload.sends(b"some")
    while not (upload.heard or upload.answered):
        await asyncio.sleep(0.001)
    if upload.answered:
        assert await upload.answer() == (503, {"error": BUSY})
    return not upload.answered


async def let_in(app: Starlette, machine: str, desks: Sequence[str]) -> list[Visitor]:
    """Uploads of a machine, one at each desk, all of which are waited for."""
    uploads = [Visitor(app, "POST", desk, machine, "avatar=stock&format=bvh") for desk in desks]
    assert [await is_let_in(upload) for upload in uploads] == [True] * len(desks)
    return uploads


async def are_sent_away(app: Starlette, machine: str, desks: Sequence[str]) -> bool:
    """Whether all uploads of a machine are, one at each desk."""
    return not any([await is_let_in(Visitor(app, "POST", desk, machine, "avatar=stock&format=bvh")) for desk in desks])


async def ended(uploads: Sequence[Visitor], way: bytes | None) -> list[int]:
    """The answers to uploads that end so."""
    for upload in uploads:
        upload.leaves() if way is None else upload.sends(way, last=True)
    return [(await upload.answer())[0] for upload in uploads]


def test_one_machine_sends_four_files_at_once_and_all_together_eight(app: Starlette) -> None:
    async def ask() -> None:
        uploads = await let_in(app, HERE, DESKS[:4])
        assert await are_sent_away(app, HERE, DESKS)
        uploads += await let_in(app, BESIDE, DESKS[2:])
        assert await are_sent_away(app, ELSEWHERE, DESKS)
        assert await ended(uploads, LEFT) == [408] * 8

    asyncio.run(ask())


@pytest.mark.parametrize(
    ("way", "status"), [(LARGE, 413), (LEFT, 408), pytest.param(WRONG, 422, marks=pytest.mark.long)]
)
def test_who_is_done_or_gone_makes_place_for_the_next(app: Starlette, way: bytes | None, status: int) -> None:
    """As often as there are places, and once more: one that were kept would be missed."""

    async def ask() -> None:
        uploads = await let_in(app, HERE, DESKS[:1] * 4)
        for _ in range(5):
            assert await are_sent_away(app, HERE, DESKS[:1])
            assert await ended([uploads.pop(0)], way) == [status]
            uploads += await let_in(app, HERE, DESKS[:1])
        uploads += await let_in(app, BESIDE, DESKS[:1] * 4)
        assert await ended(uploads, LEFT) == [408] * 8
        assert await ended(await let_in(app, ELSEWHERE, DESKS[:1] * 4), LEFT) == [408] * 4

    asyncio.run(ask())
