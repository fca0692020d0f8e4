"""Scenes that pages build: taken, refused in one line, kept, handed out as documents, and walked unseen."""

import asyncio
import itertools
import json
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.errors import InputError
from elbowroom.experiment.unseen_walk import WalkLimits, walk_unseen
from elbowroom.server.apart.jobs import read_scene, walk_scene
from elbowroom.server.app import make_app
from elbowroom.server.schema.bounds import MAX_SCENE
from elbowroom.server.stores.library import Library
from elbowroom.world.scene import Scene

LOCAL = "http://127.0.0.1:8765"
BOX = {"type": "box", "name": "crate", "center": [1.2, 0.5, 2.0], "size": [0.5, 1.0, 0.5], "color": "#C07A3E"}


@pytest.fixture(scope="module")
def library() -> Iterator[Library]:
    opened = Library.open("b")
    yield opened
    opened.close()


def ask(library: Library, method: str, path: str, **options: Any) -> httpx.Response:
    async def asked() -> httpx.Response:
        transport = httpx.ASGITransport(make_app(library), client=("127.0.0.1", 50000))
        async with httpx.AsyncClient(transport=transport, base_url=LOCAL) as client:
            return await client.request(method, path, **options)

    return asyncio.run(asked())


def document(*obstacles: dict[str, Any], **changes: Any) -> dict[str, Any]:
    made = Scene.of("attic", (), finish=(0.0, 4.0)).to_dict()
    return made | {"title": "My attic", "obstacles": list(obstacles)} | changes


def test_a_scene_that_was_built_is_walked_in_and_edited_again(library: Library) -> None:
    answer = ask(library, "POST", "/api/scenes", json=document(BOX))
    assert answer.status_code == 201, answer.text
    choice = answer.json()
    assert choice["title"] == "My attic"
    assert ask(library, "POST", "/api/scenes", json=document(BOX)).json() == choice
    told = ask(library, "GET", f"/api/scenes/{choice['name']}").json()
    assert [(one["name"], one["color"]) for one in told["obstacles"]] == [("crate", "#c07a3e")]
    again = ask(library, "GET", f"/api/scenes/{choice['name']}/document").json()
    assert Scene.from_dict(again).to_dict()["obstacles"][0]["color"] == "#c07a3e"
    assert choice["name"] not in {scene.name for scene in library.catalog().scenes}


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        (json.dumps(document({**BOX, "size": [0.5, -1, 0.5]})), "scene: $.obstacles[0].size[1] is -1"),
        (json.dumps(document({**BOX, "color": "red"})), "must be a colour"),
        (json.dumps(document({**BOX, "center": [0, 0.5, 0]})), "it stands in the obstacle 'crate'"),
        (json.dumps(document(place={"file": "/etc/passwd"})), "$.place names the model of a place"),
        ("{" * 2000, "not JSON"),
        ("[" * 200_000, "nested"),
        (b"\xff\xfe", "not UTF-8"),
        ('{"format": NaN}', "not a JSON number"),
    ],
)
def test_a_wrong_scene_is_told_in_one_line(tmp_path: Path, body: str | bytes, reason: str) -> None:
    file = tmp_path / "sent"
    file.write_bytes(body if isinstance(body, bytes) else body.encode())
    for job in (read_scene, partial(walk_scene, humanoid=str(file))):
        with pytest.raises(InputError) as error:
            job(str(file), "scene")
        assert reason in str(error.value)
        assert "\n" not in str(error.value)


def test_a_wrong_scene_is_refused(library: Library) -> None:
    answer = ask(library, "POST", "/api/scenes", json=document({**BOX, "size": [0.5, -1, 0.5]}))
    assert answer.status_code == 422
    assert answer.json()["error"].startswith("scene: $.obstacles[0].size[1] is -1; must be")


def test_a_scene_may_not_be_larger_than_what_a_page_builds(library: Library) -> None:
    answer = ask(library, "POST", "/api/scenes", content=b" " * (MAX_SCENE + 1))
    assert answer.status_code == 413
    assert "512 KiB" in answer.json()["error"]


@pytest.mark.long
def test_an_avatar_walks_unseen(library: Library) -> None:
    walked = ask(library, "POST", "/api/walks?avatar=stock", json=document(BOX)).json()
    assert walked["decided"]
    assert walked["passed"]
    assert walked["stuck"] == 0
    assert 1.0 < walked["seconds"] < 10.0


def test_a_walled_scene_is_not_feasible_and_work_has_an_end() -> None:
    wall = {"type": "box", "center": [0, 1.5, 2], "size": [16, 3, 0.3]}
    scene = Scene.from_dict(document(wall))
    walk = walk_unseen(Humanoid.default(), scene, WalkLimits(limit=4.0), clock=lambda: 0.0)
    assert walk.decided
    assert not walk.passed
    assert walk.z < 2.0
    seconds = itertools.count()
    given_up = walk_unseen(Humanoid.default(), scene, WalkLimits(work=5.0), clock=lambda: float(next(seconds)))
    assert not given_up.decided
    assert given_up.seconds < 1.0


def test_nobody_walks_as_an_avatar_that_is_not_here(library: Library) -> None:
    answer = ask(library, "POST", "/api/walks?avatar=nobody", json=document(BOX))
    assert answer.status_code == 422


def test_a_place_is_not_edited(library: Library) -> None:
    assert ask(library, "GET", "/api/scenes/unknown/document").status_code == 404
