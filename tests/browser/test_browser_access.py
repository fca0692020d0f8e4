"""For everyone: keys that can be changed, the language chosen in the menu."""

from collections.abc import Callable

from live_page import LivePage

Open = Callable[..., LivePage]


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


def test_the_language_is_chosen_in_the_menu_and_kept(open_page: Open) -> None:
    live = open_page("scene=empty&lang=en", viewport=(1280, 800))
    with live.page.expect_navigation():
        live.page.locator("#language").select_option("zh-Hant")
    live.wait("document.documentElement.lang === 'zh-Hant' && s.settings")
    assert live.page.locator("#share").inner_text() == "分享目前畫面"
    live.page.goto(live.page.url)
    live.wait("document.documentElement.lang === 'zh-Hant' && s.settings")
