"""Build mode: a scene placed, moved, checked, walked in, saved and sent, by pointer and by keys."""

import json
import re
from collections.abc import Callable

import pytest

from elbowroom.world.scene import Scene
from live_page import LivePage

Open = Callable[..., LivePage]
VERDICT_SECONDS = 240.0  # a walk beside everything else that a busy machine does


def _build(live: LivePage, scene: str = "empty") -> None:
    live.wait(f"s.scene === '{scene}'")
    live.page.keyboard.press("u")
    live.wait("s.build && s.settings.paused")
    live.page.locator("#build .board").focus()


def _field(live: LivePage, label: str) -> str:
    return str(live.page.get_by_label(label, exact=True).input_value())


def _saved(live: LivePage) -> Scene:
    with live.page.expect_download() as download:
        live.page.get_by_role("button", name="Save as a file").click()
    return Scene.from_dict(json.loads(download.value.path().read_text("utf-8")))


@pytest.mark.long
def test_a_scene_is_built_by_keys_alone_checked_and_gone_through_by_its_tour(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(1280, 720))
    _build(live)
    keyboard = live.page.keyboard
    keyboard.press("1")
    live.wait("s.build.things.length === 1 && s.build.selected")
    before = float(_field(live, "X (m)"))
    keyboard.press("Shift+ArrowLeft")
    assert float(_field(live, "X (m)")) == pytest.approx(before + 1.0)
    keyboard.press("PageUp")
    keyboard.press("r")
    assert float(_field(live, "Turn (°)")) == pytest.approx(15.0)
    keyboard.press("c")
    live.wait("s.build.things.length === 2")
    keyboard.press("Delete")
    live.wait("s.build.things.length === 1")
    keyboard.press("Control+z")
    live.wait("s.build.things.length === 2")
    keyboard.press("Control+y")
    live.wait("s.build.things.length === 1")
    live.page.get_by_label("Title of the scene").fill("By keys")
    live.page.get_by_label("Title of the scene").press("Enter")
    live.page.locator("#build .board").focus()
    for z, view in (("1", "side"), ("4", "front")):
        keyboard.press("s")
        live.page.get_by_label("Z (m)").fill(z)
        live.page.get_by_label("Seen from").select_option(view)
        live.page.get_by_label("Stay (s)").fill("0")
        live.page.get_by_label("Words").fill(f"at {z}")
        live.page.locator("#build .board").focus()
    live.wait("s.build.verdict === 'feasible'", VERDICT_SECONDS)
    live.page.get_by_role("button", name="Walk here").click()
    live.wait("s.scene.startsWith('built:') && s.build === null && !s.settings.paused")
    keyboard.press("n")
    live.page.get_by_role("button", name="Guided tour").click()
    live.wait("s.tour === 0 && s.view === 'side'")
    assert "at 1" in live.page.locator("#notices").inner_text()
    live.wait("s.tour === 1 && s.view === 'front' && s.root.z > 0.8")
    live.wait("s.tour === null && s.root.z > 3.5")


def test_a_scene_is_built_with_the_mouse(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(1280, 720))
    _build(live)
    page = live.page
    page.get_by_role("button", name=re.compile("^Check")).click()
    board = page.locator("#build .board").bounding_box()
    middle = (board["x"] + board["width"] / 2, board["y"] + board["height"] / 2)
    page.get_by_role("button", name=re.compile("^Cylinder")).click()
    page.mouse.click(middle[0] + 60, middle[1])
    live.wait("s.build.things.length === 1 && s.build.tool === 'select'")
    before = float(_field(live, "X (m)"))
    page.mouse.move(middle[0] + 60, middle[1])
    page.mouse.down()
    page.mouse.move(middle[0] - 80, middle[1] - 30, steps=6)
    page.mouse.up()
    assert float(_field(live, "X (m)")) > before + 0.5
    page.get_by_label("Colour", exact=True).fill("#3366cc")
    page.get_by_label("Name", exact=True).fill("pillar")
    page.get_by_label("Name", exact=True).press("Tab")
    page.get_by_role("button", name=re.compile("^Let it move")).click()
    page.mouse.click(middle[0] + 100, middle[1] - 40)
    page.mouse.click(middle[0] + 100, middle[1] + 60)
    page.keyboard.press("Escape")
    page.locator("#build .choice select").select_option("loop")
    scene = _saved(live)
    assert scene.obstacles.moving.names == ("pillar",)
    assert scene.colors == {"pillar": "#3366cc"}
    assert len(scene.obstacles.moving.tracks[0].times) == 4
    page.get_by_role("button", name="Undo (Ctrl+Z)").click()
    assert _saved(live).obstacles.moving.tracks[0].repeat.value == "pingpong"


@pytest.mark.long
def test_start_and_finish_are_moved_and_what_is_wrong_is_said_in_one_line(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(1280, 720))
    _build(live)
    live.page.locator("#build .board .start").focus()
    live.page.keyboard.press("r")
    assert float(_field(live, "Turn (°)")) == pytest.approx(15.0)
    live.page.locator("#build .board .finish").focus()
    live.page.get_by_label("Z (m)").fill("-30")
    live.page.get_by_label("Z (m)").press("Enter")
    live.wait("s.build.verdict === 'wrong'", VERDICT_SECONDS)
    said = live.page.locator("#build .verdict").inner_text()
    assert said.startswith("scene: $.finish.position")
    assert "\n" not in said
    live.errors[:] = [error for error in live.errors if "422" not in error]  # which the browser logs


@pytest.mark.long
def test_a_scene_travels_in_an_address_and_drafts_stay(open_page: Open) -> None:
    live = open_page("scene=d", viewport=(1280, 720))
    _build(live, "d")
    names = live.wait("s.build.things.length > 0")["build"]["things"]
    live.page.keyboard.press("2")
    live.wait(f"s.build.things.length === {len(names) + 1}")
    live.page.get_by_role("button", name="Link", exact=True).click()
    live.wait("location.hash.startsWith('#scene=')")
    server, address = live.page.evaluate("[location.origin, location.hash]")
    live.page.get_by_role("button", name="New", exact=True).click()
    live.wait("s.build.things.length === 0")
    live.page.keyboard.press("Escape")
    live.wait("s.build === null")
    _build(live, "d")
    drafts = live.page.get_by_label("Drafts", exact=True)
    drafts.select_option(index=1)
    live.wait(f"s.build.things.length === {len(names) + 1}")
    walked: list[str] = []
    live.page.on("request", lambda request: walked.append(request.post_data or "") if "/walks" in request.url else None)
    live.page.goto("about:blank")  # an address that differs behind its # only loads no page
    live.page.goto(f"{server}/?quality=low&scene=empty{address}")
    state = live.wait("s.build")
    assert state["build"]["things"][:-1] == names
    live.wait("s.build && s.build.verdict === 'walking'")
    assert walked
    assert all(names[0] in plan for plan in walked)  # and no empty scene before it, on which it would wait


@pytest.mark.long
@pytest.mark.parametrize("size", [(390, 844), pytest.param((844, 390), marks=pytest.mark.long)])
def test_all_of_it_can_be_reached_on_a_phone(open_page: Open, size: tuple[int, int]) -> None:
    live = open_page("scene=doorway&lang=zh-Hant", viewport=size, has_touch=True)
    live.page.locator("#menu-button").click()
    live.page.locator("#build-open").click()
    live.wait("s.build && s.build.things.length > 0")
    live.settle_panels()
    board = live.page.locator("#build .board").bounding_box()
    assert board["width"] > 250
    assert board["height"] > 100
    for part in ("#build .walk", "#build .close", "#build .fields", "#build .verdict", "#build footer"):
        box = live.page.locator(part).bounding_box()
        assert box["x"] >= 0, part
        assert box["x"] + box["width"] <= size[0] + 0.5, part
        assert box["y"] + box["height"] <= size[1] + 0.5, part
    live.page.touchscreen.tap(board["x"] + board["width"] / 2, board["y"] + 12)
    live.page.locator("#build .close").click()
    live.wait("s.build === null && !s.settings.paused")


@pytest.mark.long
def test_two_fingers_zoom_and_move_the_board_and_place_nothing(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(390, 844), has_touch=True)
    live.page.locator("#menu-button").tap()
    live.page.locator("#build-open").tap()
    live.wait("s.build && !s.build.things.length")
    live.settle()
    live.page.get_by_role("button", name=re.compile("^Cylinder")).tap()
    board = live.page.locator("#build .board")
    box = board.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    wire = live.page.context.new_cdp_session(live.page)

    def fingers(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": at[0], "y": at[1], "id": n} for n, at in enumerate(places)]
        wire.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def shown() -> list[float]:
        return [float(number) for number in board.get_attribute("viewBox").split()]

    before = shown()
    fingers("touchStart", (x - 40, y))
    fingers("touchStart", (x - 40, y), (x + 40, y))
    for k in range(1, 5):
        fingers("touchMove", (x - 40 - 10 * k, y), (x + 40 + 10 * k, y))
    fingers("touchEnd")
    after = shown()
    assert after[2] == pytest.approx(0.5 * before[2], rel=0.02)
    assert after[0] + after[2] / 2 == pytest.approx(before[0] + before[2] / 2, abs=0.05)
    assert live.state()["build"]["things"] == []
    live.page.touchscreen.tap(x, y)
    live.wait("s.build.things.length === 1")


@pytest.mark.long
def test_back_leaves_what_is_built_and_a_link_in_the_same_tab_opens_it(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(1280, 720))
    live.page.locator("#scene").select_option("a")
    live.wait("s.scene === 'a'")
    _build(live, "a")
    live.page.keyboard.press("2")
    things = live.wait("s.build && s.build.things.length > 3")["build"]["things"]
    live.page.get_by_role("button", name="Link", exact=True).click()
    live.wait("location.hash.startsWith('#scene=')")
    link = live.page.evaluate("location.hash")
    live.page.go_back()
    live.wait("s.build === null && s.scene === 'empty' && location.hash === ''")
    live.page.evaluate("(link) => { location.hash = link; }", link)
    assert live.wait("s.build && s.build.things.length > 0")["build"]["things"] == things
