"""Large answers wait for who takes them slowly, and what is dear is made of an upload beside the frames of others."""

import asyncio
from collections.abc import Iterator
from typing import Any

import httpx
import pytest
from starlette.types import Message

from elbowroom.server.app import make_app
from elbowroom.server.entrance.in_pieces import InPieces
from elbowroom.server.stores import scene_desk, uploads
from elbowroom.server.stores.library import Library
from elbowroom.world.scene import Scene
from place_builder import TWO_ROOMS, glb

LOCAL = "http://127.0.0.1:8765"


def sent(body: bytes) -> list[Message]:
    """What is sent of an answer, message by message; none is sent before the one before was taken."""
    messages: list[Message] = []
    taken = asyncio.Event()
    taken.set()

    async def send(message: Message) -> None:
        assert taken.is_set(), "the one before is not taken yet"
        taken.clear()
        await asyncio.sleep(0)
        messages.append(message)
        taken.set()

    async def receive() -> Message:
        raise AssertionError("nothing is asked of the client")

    answer = InPieces(body, media_type="application/octet-stream")
    asyncio.run(answer({"type": "http"}, receive, send))
    return messages


@pytest.mark.parametrize("size", [0, 1, 65_536, 1_000_000])
def test_a_large_answer_is_sent_piece_by_piece(size: int) -> None:
    body = bytes(range(256)) * (size // 256) + bytes(size % 256)
    start, *pieces = sent(body)
    assert dict(start["headers"])[b"content-length"] == str(size).encode()
    assert b"".join(piece["body"] for piece in pieces) == body
    assert max(len(piece["body"]) for piece in pieces) <= 65_536
    assert [piece["more_body"] for piece in pieces] == [True] * (len(pieces) - 1) + [False]


@pytest.fixture
def library() -> Iterator[Library]:
    opened = Library.open("b")
    yield opened
    opened.close()


@pytest.mark.parametrize(
    ("desk", "path", "content"),
    [(uploads, "/api/avatars?name=rooms.glb", "place"), (scene_desk, "/api/scenes", "built")],
    ids=["a place", "a built scene"],
)
def test_a_scene_is_made_of_what_was_sent_in_a_thread_beside(
    library: Library, monkeypatch: pytest.MonkeyPatch, desk: Any, path: str, content: str
) -> None:
    """Its ground alone may take seconds, in which nobody else would be shown a frame."""
    beside: list[bool] = []

    class Made:
        @staticmethod
        def from_dict(document: dict[str, Any], name: str) -> Scene:
            try:
                asyncio.get_running_loop()
            except RuntimeError:
                beside.append(True)
            else:
                beside.append(False)
            return Scene.from_dict(document, name)

    async def posted() -> httpx.Response:
        transport = httpx.ASGITransport(make_app(library), client=("127.0.0.1", 50000))
        async with httpx.AsyncClient(transport=transport, base_url=LOCAL) as client:
            if content == "place":
                return await client.post(path, content=glb(TWO_ROOMS))
            return await client.post(path, json=Scene.load("b").to_dict())

    monkeypatch.setattr(desk, "Scene", Made)
    answer = asyncio.run(posted())
    assert answer.status_code == 201, answer.text
    assert beside == [True]
