"""Places on the page: the model that a page fetches, and models that are dropped there."""

import asyncio
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from elbowroom.formats.gltf import parse_gltf
from elbowroom.server.app import make_app
from elbowroom.server.stores.library import Library
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.scene import Scene
from place_builder import TWO_ROOMS, glb, write_place

LOCAL = "http://127.0.0.1:8765"


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Library]:
    file = write_place(tmp_path_factory.mktemp("place") / "rooms.glb")
    opened = Library.open(Scene.load(file, PlaceOptions(drop=("Door_*",))))
    yield opened
    opened.close()


def ask(library: Library, method: str, path: str, **options: Any) -> httpx.Response:
    async def asked() -> httpx.Response:
        transport = httpx.ASGITransport(make_app(library), client=("127.0.0.1", 50000))
        async with httpx.AsyncClient(transport=transport, base_url=LOCAL) as client:
            return await client.request(method, path, **options)

    return asyncio.run(asked())


def names_in(answer: httpx.Response) -> set[str]:
    nodes = parse_gltf(answer.content, "shown.glb").root.at("nodes").items()
    return {node.at("name").text() for node in nodes if node.at("mesh").present}


def test_a_scene_tells_where_its_model_is_and_not_each_part(library: Library) -> None:
    told = ask(library, "GET", f"/api/scenes/{library.scene}").json()
    assert told["obstacles"] == []
    assert told["model"]["title"] == "rooms.glb"
    fetched = ask(library, "GET", f"/{told['model']['url']}")
    assert fetched.headers["content-type"] == "model/gltf-binary"
    assert names_in(fetched) == set(TWO_ROOMS) - {"Door_1"}


def test_scenes_without_a_model_say_so(library: Library) -> None:
    told = ask(library, "GET", "/api/scenes/b").json()
    assert told["model"] is None
    assert told["obstacles"]


@pytest.mark.parametrize("name", ["unknown", "..%2f..%2fetc", "a.b"])
def test_other_places_are_not_there(library: Library, name: str) -> None:
    assert ask(library, "GET", f"/places/{name}.glb").status_code == 404


def test_a_model_that_is_dropped_becomes_a_scene_of_its_own(library: Library) -> None:
    answer = ask(library, "POST", "/api/avatars?name=my rooms.glb", content=glb(TWO_ROOMS))
    assert answer.status_code == 201, answer.text
    sent = answer.json()
    assert sent["avatar"] is None
    assert sent["scene"]["title"] == "my rooms"
    told = ask(library, "GET", f"/api/scenes/{sent['scene']['name']}").json()
    assert names_in(ask(library, "GET", f"/{told['model']['url']}")) == set(TWO_ROOMS)
    offered = ask(library, "GET", "/api/catalog").json()["scenes"]
    assert sent["scene"]["name"] not in {choice["name"] for choice in offered}


def test_what_holds_nothing_to_walk_in_is_refused(library: Library) -> None:
    answer = ask(library, "POST", "/api/avatars?name=empty.wrl", content=b"#VRML V2.0 utf8\n")
    assert answer.status_code == 422
    assert "empty.wrl" in answer.json()["error"]
