"""The page round the picture: panels, time, files, and the line to the server."""

from collections.abc import Callable
from pathlib import Path

import pytest

import elbowroom
from avatar_builder import Recipe, build
from live_page import READ, LivePage
from live_server import LiveServer
from shared_data import SHARED

Open = Callable[..., LivePage]

STOCK = Path(elbowroom.__file__).parent / "body" / "data" / "stock.vrm"
FILES = [pytest.param(STOCK, id="stock")]
if SHARED is not None:
    FILES.append(
        pytest.param(SHARED / "avatars" / "glb" / "VALID_AIAN_M_1_Casual.glb", id="meshopt", marks=pytest.mark.long)
    )
    FILES.append(pytest.param(SHARED / "avatars" / "glb" / "boxman.glb", id="repaired", marks=pytest.mark.long))
    FILES.append(
        pytest.param(SHARED / "avatars" / "hanim_x3d" / "JoeKick.x3d", id="skinned X3D", marks=pytest.mark.long)
    )
    FILES.append(
        pytest.param(
            SHARED / "avatars" / "hanim_vrml97" / "sample1.wrl", id="VRML97 in segments", marks=pytest.mark.long
        )
    )

SMALL = (480, 320)  # drawn soon; for tests that look at no panel


def test_the_page_comes_up_quietly_and_travels_in_less_than_700_kilobytes(open_page: Open) -> None:
    live = open_page("scene=b&theme=dark")
    state = live.wait("s.scene === 'b' && s.connected")
    assert state["settings"]["planner"] == "exact"
    assert live.page.get_attribute("html", "data-theme") == "dark"
    assert "Elbowroom" in live.page.title()
    live.wait(f"s.framesReceived > {state['framesReceived'] + 30}")
    assert live.page.evaluate("performance.getEntriesByType('resource').every((r) => r.name.startsWith(origin))")
    sizes = live.page.evaluate("""
        performance.getEntries().filter((e) => ["resource", "navigation"].includes(e.entryType))
          .map(({ name, encodedBodySize }) => [new URL(name).pathname, encodedBodySize])
    """)
    code = [(path, size) for path, size in sizes if not path.endswith(".glb")]
    assert len(code) > 4
    assert 100_000 < sum(size for _, size in code) < 700_000, code


def test_help_opens_with_a_question_mark(open_page: Open) -> None:
    live = open_page()
    live.page.keyboard.press("?")
    live.page.wait_for_selector("#help[open]")
    assert "Shift" in live.page.inner_text("#help")
    live.page.keyboard.press("Escape")
    live.page.wait_for_selector("#help:not([open])", state="attached")


def test_overlays_switch_on_and_off(open_page: Open) -> None:
    live = open_page()
    assert live.state()["overlays"] == []
    live.page.check("#overlay-capsules")
    live.page.check("#overlay-plan")
    state = live.wait("s.overlays.length === 2 && s.settings.capsules && !s.settings.plan")
    assert set(state["overlays"]) == {"capsules", "plan"}
    live.wait("s.capsulesReceived > 10")
    live.page.wait_for_selector("#hud .plan:not([hidden])")
    live.page.keyboard.press("o")
    live.wait("s.overlays.length === 0 && !s.settings.capsules")
    live.page.keyboard.press("o")
    live.wait("s.overlays.length === 2")


@pytest.mark.long
def test_time_pauses_steps_and_slows(open_page: Open) -> None:
    live = open_page("scene=empty")
    live.page.keyboard.press("p")
    live.wait("s.paused && s.settings.paused")
    live.settle()
    before = live.state()["simTime"]
    live.page.keyboard.press(".")
    live.wait(f"s.simTime > {before}")
    live.settle()
    assert live.state()["simTime"] == pytest.approx(before + 1 / 60, abs=1e-6)
    live.page.keyboard.press("m")
    live.wait("s.settings.speed < 1")
    live.page.click("#pause")
    live.wait("!s.paused")


def test_reset_brings_the_avatar_back(open_page: Open) -> None:
    live = open_page("scene=empty")
    live.wait("s.scene === 'empty'")
    start = live.state()["root"]
    live.page.keyboard.down("w")
    live.wait(f"Math.abs(s.root.z - {start['z']}) > 0.5")
    live.page.keyboard.up("w")
    live.page.keyboard.press("r")
    live.wait(f"Math.hypot(s.root.x - {start['x']}, s.root.z - {start['z']}) < 0.1 && s.simTime < 3")


_COUNT_PROGRAMS = """
const { linkProgram } = WebGL2RenderingContext.prototype;
window.__programs = 0;
WebGL2RenderingContext.prototype.linkProgram = function (...program) {
  window.__programs += 1;
  return linkProgram.apply(this, program);
};
"""


def test_menus_change_the_session(open_page: Open) -> None:
    live = open_page("queue=4", script=_COUNT_PROGRAMS)
    live.wait("s.settings.queueSize === 4")
    programs = live.page.evaluate("window.__programs")
    assert programs > 5
    live.page.select_option("#scene", "c")
    live.wait("s.scene === 'c' && s.settings.scene === 'c'")
    live.wait_for_pictures(4)
    assert live.page.evaluate("window.__programs") == programs  # what is compiled serves all scenes
    live.page.focus("#queue")
    live.page.keyboard.press("ArrowRight")
    live.wait("s.settings.queueSize === 5")


@pytest.mark.parametrize("path", FILES)
def test_a_dropped_file_becomes_the_avatar(open_page: Open, path: Path) -> None:
    live = open_page("scene=empty", viewport=SMALL)
    live.drop(("newcomer" + path.suffix, path.read_bytes()))
    state = live.wait(
        "s.settings.avatar !== 'stock' && s.avatarRevision === s.poseRevision && s.avatarRevision > 0", READ
    )
    assert state["avatarLoaded"]
    live.page.keyboard.down("w")
    live.wait("s.root.z > 0.3")
    live.page.keyboard.up("w")


@pytest.mark.long
def test_a_dropped_file_is_in_no_other_pages_menu(open_page: Open) -> None:
    titles = "[...document.querySelectorAll('#avatar option')].map((option) => option.value)"
    mine = open_page("scene=empty", viewport=SMALL)
    mine.drop(("mine.vrm", STOCK.read_bytes()))
    avatar = mine.wait("s.settings.avatar !== 'stock'", READ)["settings"]["avatar"]
    assert avatar not in open_page("scene=empty", viewport=SMALL).page.evaluate(titles)
    open_page(f"scene=empty&avatar={avatar}", viewport=SMALL).wait(
        f"s.settings.avatar === '{avatar}'"
    )  # whoever is told may use it
    mine.page.reload()
    mine.wait("s.settings && s.connected")
    assert avatar in mine.page.evaluate(titles)


@pytest.mark.long
def test_the_page_says_what_a_file_permits_and_what_was_made_of_it(open_page: Open, tmp_path: Path) -> None:
    live = open_page("scene=empty")
    file = tmp_path / "mine.vrm"
    file.write_bytes(build(Recipe(vrm="1", mesh=False)))
    live.page.set_input_files("#file", str(file))
    live.wait("s.settings.avatar !== 'stock' && s.avatarRevision === s.poseRevision && s.avatarRevision > 0", READ)
    live.page.click("#avatar-about summary")
    facts = live.page.inner_text("#avatar-about ul")
    assert "redistribution: forbidden" in facts
    assert "average proportions" in facts


def test_a_wrong_file_is_refused_in_one_sentence(open_page: Open) -> None:
    live = open_page()
    live.drop(("cat.vrm", b"this is no avatar"))
    live.page.wait_for_selector(".notice.error")
    assert live.state()["settings"]["avatar"] == "stock"
    live.excuse_refusals()


@pytest.mark.long
def test_the_page_reconnects_by_itself_and_keeps_its_choices(open_page: Open) -> None:
    with LiveServer() as server:
        live = open_page("scene=c", viewport=SMALL, server=server)
        live.wait("s.scene === 'c'")
        live.drop(("mine.vrm", STOCK.read_bytes()))
        live.wait("s.settings.avatar !== 'stock'", READ)
        server.stop()
        live.wait("!s.connected && s.connection === 'lost'")
        live.page.wait_for_selector("#veil:not([hidden])")
        server.start()
        count = live.wait("s.connected")["framesReceived"]
        live.wait(f"s.framesReceived > {count + 10} && s.settings.scene === 'c'")
        live.wait("s.settings.avatar !== 'stock' && s.avatarRevision === s.poseRevision", READ)
        live.page.wait_for_selector("#veil", state="hidden")
        live.page.goto("about:blank")  # before the server ends: a page that is left open would try to connect again
        live.excuse_lost_server()


@pytest.mark.parametrize(
    "viewport",
    [pytest.param((390, 844), id="portrait"), pytest.param((844, 390), id="landscape", marks=pytest.mark.long)],
)
def test_the_page_fits_a_phone(open_page: Open, viewport: tuple[int, int]) -> None:
    live = open_page(viewport=viewport, has_touch=True, is_mobile=True)
    width, height = viewport
    for selector in ("#bar", "#hud", "#brand"):
        box = live.page.locator(selector).bounding_box()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= width
        assert box["y"] + box["height"] <= height
    assert live.page.get_attribute("#menu-button", "aria-expanded") == "false"
    live.page.tap("#menu-button")
    live.page.wait_for_selector("#menu:not(.closed)")
    live.page.select_option("#scene", "b")
    live.wait("s.scene === 'b'")
    live.page.tap("#menu-button")
    live.page.tap("#help-button")
    live.page.wait_for_selector("#help[open]")


def test_what_an_address_asks_for_in_vain_is_told_in_one_line_each(open_page: Open) -> None:
    live = open_page("scene=nope&camera=9&speed=abc", viewport=SMALL)
    live.said("camera=9, speed=abc")
    live.said("scene 'nope' is not known here")
    state = live.wait("s.scene && s.connected")
    assert state["view"] == "behind"
    assert state["settings"]["walkSpeed"] > 0.5


def test_a_phone_that_is_turned_in_the_middle_of_a_walk_walks_on(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(390, 844), has_touch=True, is_mobile=True)
    live.page.keyboard.down("w")
    at = live.wait("s.root.z > 0.3")["root"]["z"]
    live.page.set_viewport_size({"width": 844, "height": 390})
    live.wait(f"s.root.z > {at + 0.5}")
    feet = live.state()["feet"]
    assert 0 < feet[0] < 844
    assert 0 < feet[1] < 390
    live.page.keyboard.up("w")
