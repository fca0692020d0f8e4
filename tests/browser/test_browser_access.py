"""For everyone: no serious barrier by axe-core, keys that can be changed, the language of the menu, twice the size."""

from collections.abc import Callable
from itertools import product
from typing import Any

import pytest

from axe import grave_barriers
from live_page import LivePage

Open = Callable[..., LivePage]

# What of the panels that are shown lies in another one or beyond the window, and which words do not fit their button.
CROWDED = """
() => {
  const all = (at) => [...document.querySelectorAll(at)];
  const shown = (element) => element.checkVisibility({ visibilityProperty: true, opacityProperty: true });
  const boxes = all("#brand, #bar button, #hud, #status, #show-all").filter(shown)
    .map((element) => ({ name: element.id, box: element.getBoundingClientRect() }))
    .filter(({ box }) => box.width > 1 && box.height > 1);
  const besides = (a, b) => a.right <= b.left + 1 || b.right <= a.left + 1;
  const apart = (a, b) => besides(a, b) || a.bottom <= b.top + 1 || b.bottom <= a.top + 1;
  const beyond = (box) => box.left < -1 || box.top < -1 || box.right > innerWidth + 1 || box.bottom > innerHeight + 1;
  const over = boxes.flatMap((a, i) => boxes.slice(i + 1).filter((b) => !apart(a.box, b.box))
    .map((b) => `${a.name} over ${b.name}`));
  const outside = boxes.filter(({ box }) => beyond(box)).map(({ name }) => `${name} outside`);
  const cut = all("button, select, h1, h2, label").filter(shown)
    .filter((element) => element.scrollWidth > element.clientWidth + 1)
    .filter((element) => getComputedStyle(element).overflowX !== "visible")
    .map(({ id, textContent }) => `${id || textContent} cut`);
  return [...over, ...outside, ...cut];
}
"""


LOOKS = list(product(("light", "dark"), ("no-preference", "more")))


def barriers_in_looks(page: Any, looks: list[tuple[str, str]]) -> dict[str, list[dict[str, Any]]]:
    """What axe finds in the page as it stands, by how the system wants it to look; looks without any are left out."""
    found = {}
    for scheme, contrast in looks:
        page.emulate_media(color_scheme=scheme, contrast=contrast)
        page.wait_for_selector(f'html[data-theme="{scheme}"]', state="attached")
        if barriers := grave_barriers(page):
            found[f"{scheme}, {contrast}"] = barriers
    return found


@pytest.mark.parametrize(
    "looks",
    [pytest.param(LOOKS[:1], id="one look"), pytest.param(LOOKS, id="every look", marks=pytest.mark.long)],
)
def test_axe_finds_nothing_serious_wherever_one_can_be(open_page: Open, looks: list[tuple[str, str]]) -> None:
    live = open_page("scene=doorway&theme=auto", viewport=(1280, 800), reduced_motion="reduce")
    live.wait("s.scene === 'doorway'")
    page = live.page
    found = {"menu": barriers_in_looks(page, looks)}
    page.keyboard.press("n")
    live.settle_panels()
    found["page"] = barriers_in_looks(page, looks)
    page.keyboard.press("?")
    found["help"] = barriers_in_looks(page, looks)
    page.keyboard.press("Escape")
    page.keyboard.press("n")
    live.settle_panels()
    page.locator("#keys-open").click()
    found["keys"] = barriers_in_looks(page, looks)
    page.keyboard.press("Escape")
    page.keyboard.down("w")
    live.wait("s.root.z > 0.4")
    page.keyboard.up("w")
    page.keyboard.press("k")
    live.wait("s.replay")
    found["replay"] = barriers_in_looks(page, looks)
    page.keyboard.press("Escape")
    live.wait("s.replay === null")
    page.keyboard.press("u")
    live.wait("s.build && s.build.things.length > 0")
    page.locator("#build .board .thing").first.focus()
    found["build"] = barriers_in_looks(page, looks)
    assert {place: barriers for place, barriers in found.items() if barriers} == {}


@pytest.mark.long
def test_another_key_walks_once_it_is_given_and_after_a_reload(open_page: Open) -> None:
    live = open_page("scene=empty")
    live.wait("s.scene === 'empty'")
    page = live.page
    if page.locator("#menu.closed").count():
        page.keyboard.press("n")
    page.locator("#keys-open").click()
    page.locator("#keys [data-deed=forward]").click()
    page.keyboard.press("z")
    assert page.locator("#keys [data-deed=forward]").inner_text() == "Z"
    page.locator("#keys [data-deed=pause]").click()
    page.keyboard.press("w")
    page.keyboard.press("Escape")
    assert page.locator("#pause").get_attribute("title") == "Pause (W)"
    page.keyboard.press("w")
    live.wait("s.settings.paused")
    page.keyboard.press("w")
    live.wait("!s.settings.paused")
    page.keyboard.down("z")
    live.wait("s.root.z > 0.3")
    page.keyboard.up("z")
    page.reload()
    live.wait("s.scene === 'empty' && s.root && s.root.z < 0.1")
    page.keyboard.press("?")
    page.wait_for_selector("#help[open]")
    assert "Z" in page.locator("#help kbd").all_inner_texts()


@pytest.mark.long
def test_the_language_is_chosen_in_the_menu_and_kept(open_page: Open) -> None:
    live = open_page("scene=empty&lang=en", viewport=(1280, 800))
    with live.page.expect_navigation():
        live.page.locator("#language").select_option("zh-Hant")
    live.wait("document.documentElement.lang === 'zh-Hant' && s.settings")
    assert live.page.locator("#share").inner_text() == "分享目前畫面"
    live.page.goto(live.page.url)
    live.wait("document.documentElement.lang === 'zh-Hant' && s.settings")


@pytest.mark.long
def test_all_of_it_can_be_reached_at_twice_the_size(open_page: Open) -> None:
    live = open_page("scene=doorway", viewport=(640, 360), device_scale_factor=2, forced_colors="active")
    live.wait("s.scene === 'doorway'")
    live.settle_panels()
    assert live.page.evaluate(CROWDED) == []
    live.page.locator("#menu-button").click()
    live.settle_panels()
    assert [said for said in live.page.evaluate(CROWDED) if said.endswith("cut")] == []
    for name in ("#keys-open", "#language", "#hide-all"):
        live.page.locator(name).scroll_into_view_if_needed()
        box = live.page.locator(name).bounding_box()
        assert box is not None
        assert box["x"] >= 0, name
        assert box["x"] + box["width"] <= 640, name
    live.page.locator("#build-open").click()
    live.wait("s.build && s.build.things.length > 0")
    live.settle_panels()
    for name in ("#build .walk", "#build .close", "#build .verdict", "#build .board"):
        box = live.page.locator(name).bounding_box()
        assert box is not None
        assert box["y"] + box["height"] <= 360.5, name


def test_in_forced_colours_buttons_have_edges_and_what_has_the_focus_hides_nothing(open_page: Open) -> None:
    live = open_page("scene=doorway", viewport=(1280, 720), forced_colors="active", color_scheme="dark")
    page = live.page
    page.locator("#build-open").click()
    live.wait("s.build && s.build.things.length > 0")
    width = page.locator("#build .walk").evaluate("(button) => parseFloat(getComputedStyle(button).borderTopWidth)")
    assert width >= 1
    page.locator("#build .board").focus()
    page.keyboard.press("Tab")
    thing = "document.activeElement.closest('#build .board :not(svg)')"
    assert page.evaluate(f"!!{thing} && {thing}.matches(':focus-visible')")
    assert page.evaluate(f"getComputedStyle({thing}).outlineStyle") == "none"


# Which controls of a scrolled panel are shown, wholly in its window, and yet have something else before their middle.
HIDDEN_BEHIND = """
(at) => {
  const panel = document.querySelector(at), { left, top, width, height } = panel.getBoundingClientRect();
  const x = left + panel.clientLeft, y = top + panel.clientTop;
  return [...panel.querySelectorAll("button, select, input, label")].filter((control) => {
    const box = control.getBoundingClientRect();
    if (!control.checkVisibility() || box.width === 0) return false;
    const inside = box.top >= y && box.bottom <= Math.min(y + panel.clientHeight, innerHeight);
    if (!inside || box.left < x) return false;
    const seen = document.elementFromPoint(box.left + box.width / 4, box.top + box.height / 2);
    return !panel.contains(seen);
  }).map(({ id, textContent }) => id || textContent);
}
"""


def test_on_a_phone_nothing_lies_over_the_menu_however_far_it_is_scrolled(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(390, 844), has_touch=True, is_mobile=True)
    live.page.tap("#menu-button")
    live.page.wait_for_selector("#menu:not(.closed)")
    live.settle_panels()
    menu = live.page.locator("#menu")
    for part in (0.0, 0.13, 0.31, 0.5, 0.73, 1.0):
        menu.evaluate("(menu, part) => menu.scrollTo({ top: part * menu.scrollHeight, behavior: 'instant' })", part)
        assert live.page.evaluate(HIDDEN_BEHIND, "#menu") == [], part


def test_what_the_page_says_stands_before_whatever_fills_it(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(1280, 720), permissions=["clipboard-read", "clipboard-write"])
    live.page.locator("#build-open").click()
    live.wait("s.build && s.build.things")
    live.page.get_by_role("button", name="Link", exact=True).click()
    live.said("copied")
    box = live.page.locator("#notices .notice").bounding_box()
    assert box is not None
    for part in (0.1, 0.5, 0.9):
        at = [box["x"] + part * box["width"], box["y"] + 0.5 * box["height"]]
        assert live.page.evaluate("([x, y]) => !!document.elementFromPoint(x, y)?.closest('.notice')", at), part
