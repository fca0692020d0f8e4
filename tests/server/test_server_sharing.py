"""Two servers with one shelf: what a client sends to one, the other finds."""

from collections.abc import Iterator
from contextlib import ExitStack, closing
from dataclasses import replace

import httpx
import numpy as np
import pytest

from bvh_builder import BvhRecipe, random_motion, write_bvh
from elbowroom.body.stock import stock_avatar_path
from elbowroom.errors import InputError
from elbowroom.server.schema.commands import Configure
from elbowroom.server.schema.menus import Settings
from elbowroom.server.stores.library import Library
from elbowroom.server.stores.shelf import OwnShelf
from elbowroom.world.scene import Scene
from live_session import LONG, client_of, running

DANCE = write_bvh(random_motion(np.random.default_rng(0), 60, smooth=8.0), BvhRecipe())


@pytest.fixture(scope="module")
def two() -> Iterator[tuple[str, str]]:
    shelf = OwnShelf()
    with ExitStack() as stack:
        opened = [stack.enter_context(closing(Library.open("empty"))) for _ in range(2)]
        libraries = [replace(library, shelf=shelf, shared=True) for library in opened]
        first, second = (stack.enter_context(running(library)) for library in libraries)
        yield first, second


@pytest.mark.long
def test_an_avatar_is_found_by_the_other_server(two: tuple[str, str]) -> None:
    first, second = two
    data = stock_avatar_path().read_bytes()
    told = httpx.post(f"{first}/api/avatars?name=mine.vrm&key={'1' * 32}", content=data, timeout=LONG).json()
    avatar = told["avatar"]["id"]
    with client_of(second) as client:
        client.send(Configure(avatar=avatar))
        assert client.wait_for(Settings, lambda settings: settings.avatar == avatar)
    shown = httpx.get(f"{second}/avatars/{avatar}.glb", timeout=LONG)
    assert shown.content == httpx.get(f"{first}/avatars/{avatar}.glb", timeout=LONG).content
    assert avatar not in httpx.get(f"{second}/api/catalog").text  # the page that sent it has it in its menu alone
    assert httpx.get(f"{second}/avatars/{'0' * 16}.glb").status_code == 404


@pytest.mark.long
def test_so_are_a_motion_and_a_scene(two: tuple[str, str]) -> None:
    first, second = two
    told = httpx.post(f"{first}/api/avatars?name=dance.bvh", content=DANCE, timeout=LONG).json()
    scene = replace(Scene.load("a"), title="Built")
    built = httpx.post(f"{first}/api/scenes", json=scene.to_dict(), timeout=LONG).json()["name"]
    assert httpx.get(f"{second}/api/scenes/{built}").json()["title"] == "Built"
    with client_of(second) as client:
        clip = told["clips"][0]["id"]
        client.send(Configure(scene=built, clip=clip))
        assert client.wait_for(Settings, lambda settings: (settings.scene, settings.clip) == (built, clip))


def test_a_shelf_keeps_the_newest_for_a_while() -> None:
    now = 0.0
    shelf = OwnShelf(lambda: now)
    shelf.put("a", b"1")
    assert (shelf.get("a"), shelf.get("b")) == (b"1", None)
    now = 601.0
    assert shelf.get("a") is None
    for number in range(1100):
        shelf.put(str(number), b"")
    assert (shelf.get("0"), shelf.get("1099")) == (None, b"")
    shelf.drop("1099")
    assert shelf.get("1099") is None


def test_alone_a_server_shares_nothing() -> None:
    with closing(Library.open("empty")) as library, pytest.raises(InputError, match="not known here"):
        library.avatars.check("0" * 16)
    assert not library.shared
