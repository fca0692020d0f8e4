"""The web application: what it serves, what it refuses."""

import asyncio
import errno
import http.client
import io
import json
import socket
from collections.abc import AsyncIterator, Iterator
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from starlette.applications import Starlette
from starlette.responses import PlainTextResponse
from starlette.routing import Route

from bvh_builder import BvhRecipe, random_motion, write_bvh
from elbowroom.body.stock import stock_avatar_path
from elbowroom.control.settings import QUEUE_SIZES
from elbowroom.errors import InputError
from elbowroom.server import app as app_module
from elbowroom.server.app import make_app
from elbowroom.server.entrance import reception
from elbowroom.server.entrance.guard import Guard, host_of, is_loopback
from elbowroom.server.entrance.page_key import Sender
from elbowroom.server.kernels.kernel_cache import kernels_in_memory
from elbowroom.server.serving import listen, url_of
from elbowroom.server.stores import avatar_store, uploads
from elbowroom.server.stores.library import Library
from elbowroom.server.wire.codec import plain
from live_session import running
from sampled import sampled
from sent_files import add_avatar

LOCAL = "http://127.0.0.1:8765"
KEY = "0123456789abcdef" * 2
MINE = Sender("127.0.0.1", KEY)
DANCE = write_bvh(random_motion(np.random.default_rng(0), 60, smooth=8.0), BvhRecipe())


class Page:
    """Asks an application without a network between."""

    def __init__(self, app: Any, base: str = LOCAL, client: str = "127.0.0.1") -> None:
        self._app, self._base, self._client = app, base, (client, 50000)

    def get(self, path: str, **options: Any) -> httpx.Response:
        return asyncio.run(self._ask("GET", path, options))

    def post(self, path: str, **options: Any) -> httpx.Response:
        return asyncio.run(self._ask("POST", path, options))

    async def _ask(self, method: str, path: str, options: dict[str, Any]) -> httpx.Response:
        transport = httpx.ASGITransport(self._app, client=self._client)
        async with httpx.AsyncClient(transport=transport, base_url=self._base) as client:
            return await client.request(method, path, **options)


def made(library: Library, bound: str = "127.0.0.1", base: str = LOCAL, client: str = "127.0.0.1") -> Page:
    return Page(make_app(library, bound), base, client)


@pytest.fixture(scope="module")
def library() -> Iterator[Library]:
    opened = Library.open("b")
    yield opened
    opened.close()


@pytest.fixture
def page(library: Library) -> Page:
    return made(library)


def test_the_catalog_and_the_scenes(page: Page) -> None:
    catalog = page.get("/api/catalog").json()
    assert catalog["queueSizes"] == list(QUEUE_SIZES)
    courses = [choice for choice in catalog["scenes"] if choice["name"].startswith("gauntlet:")]
    for choice in [one for one in catalog["scenes"] if one not in courses[1:]]:  # one course is made as all are
        scene = page.get(f"/api/scenes/{choice['name']}").json()
        course = choice["name"].startswith("gauntlet:")  # its title is known once it is made
        assert course or scene["title"] == choice["title"]
        assert all(len(one["form"]["size"]) == 3 for one in scene["obstacles"])
    assert page.get("/api/scenes/nowhere").status_code == 404


def test_health_tells_what_the_process_costs(page: Page) -> None:
    health = page.get("/api/health").json()
    assert health["status"] == "ok"
    assert health["sessions"] == 0
    assert health["warm"] is False  # nobody has warmed this one up
    assert 1e6 < health["ownBytes"] <= health["residentBytes"]
    assert health["kernels"] == kernels_in_memory()
    assert page.get("/api/health").json()["cpuSeconds"] >= health["cpuSeconds"]


def test_the_stock_avatar_is_served_as_it_is(page: Page) -> None:
    response = page.get("/avatars/stock.glb")
    assert response.headers["content-type"] == "model/gltf-binary"
    assert response.content == stock_avatar_path().read_bytes()
    assert page.get("/avatars/nobody.glb").status_code == 404


def test_every_answer_carries_the_security_headers(page: Page) -> None:
    for path in ("/", "/api/health", "/nothing-here", "/avatars/stock.glb"):
        headers = page.get(path).headers
        assert headers["x-content-type-options"] == "nosniff"
        assert "default-src 'self'" in headers["content-security-policy"]
        assert "'unsafe-eval'" not in headers["content-security-policy"]  # 'wasm-unsafe-eval' is: mesh decoders
        assert "server" not in headers


def test_without_a_built_page_there_is_a_word_how_to_build_it(
    library: Library, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(app_module, "client_folder", lambda: tmp_path)
    response = made(library).get("/")
    assert response.status_code == 503
    assert "make env" in response.text


def test_the_page_is_served_and_nothing_beside_it(
    library: Library, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    client = tmp_path / "client"
    (client / "assets").mkdir(parents=True)
    (client / "index.html").write_text("<title>the page</title>")
    (client / "assets" / "index-1a2b.js").write_text("1")
    (client / ".stamp").write_text("secret")
    (tmp_path / "outside.txt").write_text("secret")
    monkeypatch.setattr(app_module, "client_folder", lambda: client)
    page = made(library)
    assert "the page" in page.get("/").text
    assert page.get("/").headers["cache-control"] == "no-cache"
    assert "immutable" in page.get("/assets/index-1a2b.js").headers["cache-control"]
    ways = ("/.stamp", "/../outside.txt", "/%2e%2e/outside.txt", "/..%2foutside.txt", "/assets/..%5c..%5coutside.txt")
    for way in (*ways, "//etc/passwd", "/%00", "/assets/%2e%2e/%2e%2e/outside.txt"):
        response = page.get(way)
        assert response.status_code in (400, 404), way
        assert "secret" not in response.text


# --- who may talk to the server ----------------------------------------------------------------------------------


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example", "8.8.8.8", "localhost@evil.example", ""])
def test_foreign_hosts_are_refused(page: Page, host: str) -> None:
    assert page.get("/api/health", headers={"host": host}).status_code == 403


@pytest.mark.parametrize("host", ["localhost:8765", "127.0.0.1:9000", "[::1]:8765", "LOCALHOST", "127.1.2.3"])
def test_this_machines_own_names_are_known(page: Page, host: str) -> None:
    assert page.get("/api/health", headers={"host": host}).status_code == 200


@pytest.mark.parametrize(
    ("origin", "status"),
    [
        (LOCAL, 422),
        ("http://localhost:8765", 403),
        ("http://127.0.0.1:8766", 403),
        ("http://evil.example", 403),
        ("null", 403),
        ("", 403),
        (None, 422),
    ],
)
def test_only_the_page_itself_may_send_files(page: Page, origin: str | None, status: int) -> None:
    headers = {} if origin is None else {"origin": origin}
    assert page.post("/api/avatars", content=b"no avatar", headers=headers).status_code == status


def test_from_other_machines_only_pages_of_an_open_server_may_send(library: Library) -> None:
    there = made(library, "0.0.0.0", "http://192.168.1.5:8765", "192.168.1.9")
    assert there.get("/api/health").status_code == 403
    assert there.get("/api/health", headers={"origin": "http://192.168.1.5:8765"}).status_code == 200
    assert there.get("/avatars/stock.glb").status_code == 200  # browsers name no origin here
    assert there.post("/api/avatars", content=b"x").status_code == 403
    assert there.post("/api/avatars", content=b"x", headers={"origin": "http://192.168.1.5:8765"}).status_code == 422
    assert there.get("/api/health", headers={"host": "rebound.example"}).status_code == 403


@pytest.mark.parametrize("path", ["/api/health", "/api/catalog", "/api/scenes/b", "/api/scenes/gauntlet:5:1"])
def test_a_page_elsewhere_may_ask_for_nothing(page: Page, path: str) -> None:
    for headers in ({"origin": "http://evil.example"}, {"sec-fetch-site": "cross-site"}, {"origin": "null"}):
        assert page.get(path, headers=headers).status_code == 403
    assert page.get("/api/health", headers={"origin": LOCAL, "sec-fetch-site": "same-origin"}).status_code == 200


def test_a_page_elsewhere_may_use_no_address_under_api(library: Library, page: Page) -> None:
    """Whatever is added there: each is asked as such a page would, and none does anything."""
    found = [one for one in make_app(library).routes if isinstance(one, Route) and one.path.startswith("/api/")]
    assert {"/api/scenes/{name}", "/api/avatars", "/api/runs"} <= {route.path for route in found}
    for route in found:
        path = route.path.replace("{name}", "gauntlet:5:1")
        ask = page.post if "POST" in (route.methods or ()) else page.get
        for origin in ("http://evil.example", "http://127.0.0.1:8766", "null"):
            answer = ask(path, headers={"origin": origin})
            assert (answer.status_code, answer.text) == (403, "That page may not talk to this server.\n"), path
        if ask == page.get:  # as for a picture, without an Origin
            assert page.get(path, headers={"sec-fetch-site": "cross-site"}).status_code == 403, path


def test_a_loopback_server_does_not_know_the_addresses_of_the_network(library: Library) -> None:
    assert made(library, base="http://192.168.1.5:8765").get("/api/health").status_code == 403


def test_a_server_answers_to_the_name_it_was_given(library: Library) -> None:
    for name, status in (("my-box.local", 200), ("", 403)):
        page = Page(make_app(library, "192.168.1.5", name), "http://My-Box.local:8765")
        assert page.get("/api/health").status_code == status


def test_hosts_are_read_as_browsers_do() -> None:
    assert host_of("Example.org:80") == "example.org"
    assert host_of("[::1]:8765") == "::1"
    assert host_of("[::1") == ""
    assert is_loopback("127.9.9.9")
    assert not is_loopback("0.0.0.0")


def test_a_request_with_two_hosts_is_refused() -> None:
    async def inner(scope: object, receive: object, send: object) -> None:
        await PlainTextResponse("in")(scope, receive, send)  # type: ignore[arg-type]

    client = Page(Guard(inner, "127.0.0.1"))
    two = [("host", "127.0.0.1:8765"), ("host", "evil.example")]
    assert client.get("/", headers=two).status_code == 403


# --- files dropped on the page -----------------------------------------------------------------------------------


def test_a_file_dropped_on_the_page_becomes_an_avatar(page: Page) -> None:
    data = stock_avatar_path().read_bytes()
    answer = page.post("/api/avatars?name=mine.vrm", content=data)
    assert answer.status_code == 201
    choice = answer.json()["avatar"]
    assert page.get(f"/avatars/{choice['id']}.glb").content == data


def test_a_dropped_file_is_in_no_menu_but_its_own(page: Page, library: Library) -> None:
    mine, other = KEY, KEY[::-1]
    stock = library.catalog()
    data = stock_avatar_path().read_bytes()
    avatar = page.post(f"/api/avatars?name=mine.vrm&key={mine}", content=data).json()["avatar"]
    clip = page.post(f"/api/avatars?name=dance.bvh&key={mine}", content=DANCE).json()["clips"][0]
    own = plain(library.catalog(mine))
    assert avatar in own["avatars"]
    assert clip in own["clips"]
    for key in ("", other):
        assert library.catalog(key) == stock
    assert page.get("/api/catalog").json() == plain(stock)
    nobodys = page.post("/api/avatars?name=mine.vrm&key=short", content=data).json()["avatar"]
    assert nobodys not in plain(library.catalog("short"))["avatars"]
    library.avatars.check(avatar["id"])  # whoever is told the id may use it


@pytest.mark.parametrize(
    "data", sampled([b"", b'{"asset": {"version": "2.0"}}', b"glTF", b"{}", b"\x00" * 1000, b"PK\x03\x04"], 2)
)
def test_a_file_that_is_no_avatar_gets_one_clear_line(page: Page, data: bytes) -> None:
    answer = page.post("/api/avatars?name=broken.vrm", content=data)
    assert answer.status_code == 422
    assert "broken.vrm" in answer.json()["error"]
    assert "\n" not in answer.json()["error"]


async def twice(chunk: bytes) -> AsyncIterator[bytes]:
    yield chunk
    yield chunk


def test_a_file_that_is_too_large_is_refused(page: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reception, "MAX_UPLOAD", 1000)
    assert page.post("/api/avatars", content=b"x" * 1001).status_code == 413
    assert page.post("/api/avatars", content=twice(b"x" * 600)).status_code == 413


def test_a_length_that_is_announced_too_large_is_refused_before_the_body_comes(library: Library) -> None:
    with running(library) as url:
        connection = http.client.HTTPConnection(url.removeprefix("http://"), timeout=60)
        connection.putrequest("POST", "/api/avatars")
        connection.putheader("Content-Length", str(10**12))
        connection.endheaders()
        answer = connection.getresponse()
        assert answer.status == 413
        assert "64 MiB" in json.loads(answer.read())["error"]
        connection.close()


def test_uploads_fill_no_more_than_their_share_of_the_disk(monkeypatch: pytest.MonkeyPatch) -> None:
    data = stock_avatar_path().read_bytes()
    monkeypatch.setattr(avatar_store, "MAX_UPLOADED", len(data) + 1000)
    store = avatar_store.AvatarStore()
    add_avatar(store, data, "one.vrm", MINE)
    second = add_avatar(store, data, "two.vrm", MINE)
    assert {choice.id for choice in store.choices(KEY)} == {"stock", second.id}
    store.close()


def test_an_avatar_of_the_command_line_goes_by_its_files_name(tmp_path: Path) -> None:
    store = avatar_store.AvatarStore()
    for name, expected in [("Alice B.vrm", "alice-b"), ("alice_b.vrm", "alice-b-2"), ("stock.vrm", "stock-2")]:
        (tmp_path / name).write_bytes(stock_avatar_path().read_bytes())
        assert store.add_file(tmp_path / name).id == expected
    assert [choice.id for choice in store.choices()] == ["stock", "alice-b", "alice-b-2", "stock-2"]
    (tmp_path / "0123456789abcdef.vrm").write_bytes(stock_avatar_path().read_bytes())
    assert store.add_file(tmp_path / "0123456789abcdef.vrm").id == "avatar-0123456789abcdef"
    store.close()


def test_only_the_last_few_uploads_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(avatar_store, "MAX_UPLOADS", 2)
    store, data = avatar_store.AvatarStore(), stock_avatar_path().read_bytes()
    first, second = (add_avatar(store, data, "one.vrm", MINE) for _ in range(2))
    store.get(first.id)
    third = add_avatar(store, data, "three.vrm", MINE)
    assert {choice.id for choice in store.choices(KEY)} == {"stock", first.id, third.id}
    assert second.glb is not None
    assert not second.glb.exists()
    with pytest.raises(InputError, match="drop its file"):
        store.get(second.id)
    assert first.glb is not None
    folder = first.glb.parent
    store.close()
    assert not folder.exists()


def test_an_avatar_that_is_shown_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(avatar_store, "MAX_UPLOADS", 2)
    store, data = avatar_store.AvatarStore(), stock_avatar_path().read_bytes()
    first, second = (add_avatar(store, data, "one.vrm", MINE) for _ in range(2))
    store.hold("a session", first.id)
    add_avatar(store, data, "three.vrm", MINE)
    assert store.get(first.id) is first
    with pytest.raises(InputError, match="drop its file"):
        store.get(second.id)
    store.hold("another", *(choice.id for choice in store.choices(KEY)))
    with pytest.raises(InputError, match="all files that this server has place for are in use"):
        add_avatar(store, data, "four.vrm")
    assert len(list(store.folder.iterdir())) == 2  # and what was refused is gone
    store.hold("another")
    add_avatar(store, data, "four.vrm")
    store.close()


def test_a_sender_pushes_out_only_what_it_sent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(avatar_store, "MAX_EACH", 2)
    store, data = avatar_store.AvatarStore(), stock_avatar_path().read_bytes()
    mine = add_avatar(store, data, "mine.vrm", Sender("192.168.1.5", KEY))
    theirs = [add_avatar(store, data, "theirs.vrm", Sender("192.168.1.6", KEY)) for _ in range(4)]
    known = {choice.id for choice in store.choices(KEY)} - {"stock"}
    assert known == {mine.id, *(avatar.id for avatar in theirs[2:])}
    store.close()


async def dripping() -> AsyncIterator[bytes]:
    for _ in range(1000):
        yield b"x"
        await asyncio.sleep(0.01)


def test_a_body_that_drips_is_ended(library: Library) -> None:
    async def ask() -> httpx.Response:
        taken = uploads.UploadDesk(library, reception.Reception(library, pace)).take
        desk = Starlette(routes=[Route("/up", taken, methods=["POST"])])
        async with httpx.AsyncClient(transport=httpx.ASGITransport(desk), base_url=LOCAL) as client:
            return await client.post("/up", content=dripping())

    pace = reception.Pace(pause=5.0, grace=0.3, slowest=10_000.0)
    before = set(library.avatars.folder.iterdir())
    assert asyncio.run(ask()).status_code == 408
    assert set(library.avatars.folder.iterdir()) == before


def test_a_full_disk_refuses_one_file_and_leaves_nothing(
    library: Library, page: Page, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Full(io.BytesIO):
        def write(self, data: object) -> int:
            raise OSError(errno.ENOSPC, "No space left on device")

    def opened(path: Path, mode: str = "r") -> object:
        path.touch()
        return Full() if path.suffix == ".sent" else original(path, mode)

    original = Path.open
    before = set(library.avatars.folder.iterdir())
    with monkeypatch.context() as patched:
        patched.setattr(Path, "open", opened)
        answer = page.post("/api/avatars?name=mine.vrm", content=b"x" * 100)
    assert answer.status_code == 507
    assert "no space" in answer.json()["error"]
    assert set(library.avatars.folder.iterdir()) == before
    assert page.post("/api/avatars?name=mine.vrm", content=stock_avatar_path().read_bytes()).status_code == 201


# --- ports -------------------------------------------------------------------------------------------------------


def test_a_busy_port_gives_the_next_free_one() -> None:
    with listen("127.0.0.1", 0) as first:
        port = first.getsockname()[1]
        with listen("127.0.0.1", port) as second:
            assert second.getsockname()[1] > port
            assert url_of(second) == f"http://127.0.0.1:{second.getsockname()[1]}"


def test_frames_are_not_held_back_to_be_sent_together() -> None:
    async def accepted() -> int:
        found: asyncio.Future[int] = asyncio.get_running_loop().create_future()

        def look(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            found.set_result(writer.get_extra_info("socket").getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
            writer.close()

        opened = listen("127.0.0.1", 0)
        async with await asyncio.start_server(look, sock=opened):
            _, writer = await asyncio.open_connection(*opened.getsockname())
            delay_off = await found
            writer.close()
            return delay_off

    assert asyncio.run(accepted()) == 1


def test_an_address_that_is_not_ours_is_refused() -> None:
    for host in ("203.0.113.7", "no such host", ""):
        with pytest.raises(InputError, match="name"), listen(host, 0):
            pass


def test_a_file_that_may_not_be_handed_out_is_shown_on_this_machine_only(library: Library) -> None:
    from avatar_builder import Recipe, build

    kept = add_avatar(library.avatars, build(Recipe(vrm="1", mesh=False)), "kept.vrm")  # says nothing: forbidden
    assert made(library).get(f"/avatars/{kept.id}.glb").status_code == 200
    refused = made(library, "0.0.0.0", "http://192.168.1.5:8765", "192.168.1.9").get(f"/avatars/{kept.id}.glb")
    assert refused.status_code == 403
    assert "forbids redistribution" in refused.json()["error"]
    free = made(library, "0.0.0.0", "http://192.168.1.5:8765", "192.168.1.9").get("/avatars/stock.glb")
    assert free.status_code == 200


def test_who_sent_a_file_from_elsewhere_sees_it_there_and_nobody_else(library: Library) -> None:
    from avatar_builder import Recipe, build

    here, base = "0.0.0.0", "http://192.168.1.5:8765"
    sender, other = made(library, here, base, "192.168.1.9"), made(library, here, base, "192.168.1.10")
    data = build(Recipe(vrm="1", mesh=False))
    choice = sender.post("/api/avatars?name=mine.vrm", content=data, headers={"origin": base}).json()["avatar"]
    assert sender.get(f"/avatars/{choice['id']}.glb").content == data
    assert other.get(f"/avatars/{choice['id']}.glb").status_code == 403
