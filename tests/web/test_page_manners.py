"""The page for everybody: keyboard, names, less motion, light and dark, all sizes, with a headset and without."""

import re
from pathlib import Path
from typing import Any

import pytest
from web.browser import DESKTOP, PHONE, TABLET, Browser, Serve
from web.pages import ELEMENT, SENTENCE, SHADOW, fake_site
from web.test_page import LOADED, SETTLED, Open, middle, opened, part
from web.test_page_life import HOLD

from mua.share.folder import write_folder

__all__ = ["opened"]  # a fixture
GUIDE = Path(__file__).parents[2] / "docs" / "web.md"


def test_who_wants_less_motion_gets_none_unasked(opened: Open) -> None:
    page = opened({"src": "hero.muaavatar", "orbit": "90"}, prefers_reduced_motion="reduce")
    assert page.evaluate("[fake.playing, fake.camera.azimuth]") == [False, 0]
    page.press(" ")
    page.evaluate(SETTLED)
    assert page.evaluate("[fake.playing, fake.camera.azimuth]") == [True, 0]


def test_every_control_is_reached_by_the_keyboard_and_has_a_name(opened: Open) -> None:
    page = opened(before="globalThis.fakeHeadset = 'willing'")
    page.evaluate(f"{part('.settings')}.click()")
    seen = set()
    for _ in range(40):
        page.press("Tab")
        seen.add(page.evaluate(f"{SHADOW}.activeElement?.className || {SHADOW}.activeElement?.name || ''"))
    bar = {"play", "scrub", "clips", "speed", "settings", "picture", "whole", "vr"}
    assert bar | {"splats", "shadow", "stereo", "follow", "level", "reset"} <= seen
    assert [node for node in _controls(page.do("tree")) if not node.get("name")] == []


def _controls(node: dict[str, Any]) -> list[dict[str, Any]]:
    """What of an accessibility tree can be used."""
    roles = ("button", "checkbox", "slider", "combobox", "application", "textbox")
    inner = [found for child in node.get("children", []) for found in _controls(child)]
    return ([node] if node["role"] in roles else []) + inner


def test_escape_closes_the_panel(opened: Open) -> None:
    page = opened()
    page.evaluate(f"{part('.settings')}.click()")
    page.evaluate(f"{part('[type=checkbox]')}.focus()")
    page.press("Escape")
    assert page.evaluate(f"[{part('.panel')}.hidden, {SHADOW}.activeElement.className]") == [True, "settings"]


def test_without_a_headset_there_is_no_button_for_it(opened: Open) -> None:
    assert opened().evaluate(f"{part('.vr')}.checkVisibility()") is False


def test_a_headset_is_entered_and_left_by_a_button(opened: Open) -> None:
    page = opened(before="globalThis.fakeHeadset = 'willing'")
    page.evaluate(f"{part('.vr')}.focus()")
    page.press("Enter")
    assert page.evaluate(f"[fake.vr, {part('.vr')}.getAttribute('aria-pressed')]") == [True, "true"]
    page.evaluate(f"{part('.vr')}.click()")
    assert page.evaluate(f"[fake.vr, {part('.vr')}.getAttribute('aria-pressed')]") == [False, "false"]
    page.evaluate("fake.onvr(fake.vr = true)")  # by itself
    assert page.evaluate(f"{part('.vr')}.getAttribute('aria-pressed')") == "true"


def test_a_headset_that_is_refused_is_a_sentence_beside_the_avatar(opened: Open) -> None:
    page = opened(before="globalThis.fakeHeadset = 'unwilling'")
    page.evaluate(f"{part('.vr')}.click()")
    page.wait(f"{SENTENCE} === 'The headset cannot show the avatar: denied'")
    assert page.evaluate("[fake.vr, fake.playing, fake.avatars.length]") == [False, True, 1]


@pytest.mark.parametrize("size", [DESKTOP, TABLET, PHONE], ids=["desktop", "tablet", "phone"])
def test_nothing_is_cut_off_at_any_size(opened: Open, size: tuple[int, int]) -> None:
    page = opened(size=size, touch=size == PHONE, before="globalThis.fakeHeadset = 'willing'")
    page.evaluate(f"{part('.settings')}.click()")
    code = f"""[...{SHADOW}.querySelectorAll("button, select, input, canvas, .panel")]
      .filter((part) => part.checkVisibility() && !part.closest(".panel"))
      .map((part) => [part.className, part.getBoundingClientRect()])
      .filter(([, at]) => at.left < -0.5 || at.right > innerWidth + 0.5 || at.bottom > innerHeight + 0.5)
      .map(([name]) => name)"""
    assert page.evaluate(code) == []
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_all_buttons_take_two_rows_of_a_phone(opened: Open) -> None:
    page = opened(size=PHONE, touch=True, before="globalThis.fakeHeadset = 'willing'")
    tops = f"[...{SHADOW}.querySelectorAll('.bar button, .bar select')].map((one) => one.getBoundingClientRect().top)"
    assert len(set(page.evaluate(tops))) == 2


@pytest.mark.parametrize(("scheme", "bright"), [("light", True), ("dark", False)])
def test_the_page_follows_the_readers_light_or_dark(opened: Open, scheme: str, bright: bool) -> None:
    page = opened(prefers_color_scheme=scheme)
    code = "getComputedStyle(document.documentElement).backgroundColor.match(/\\d+/g).map(Number)"
    assert (sum(page.evaluate(code)) > 384) is bright


ARTICLE = """(() => { document.body.style.cssText = "height: auto; display: block";
  document.querySelector("main").style.height = "400px";
  document.body.append(Object.assign(document.createElement("p"), { style: "height: 3000px" })); })()"""


def test_swipes_over_an_element_scroll_the_page_around_it_and_turn_the_figure(opened: Open) -> None:
    page = opened(size=PHONE, touch=True)
    x, y = middle(page)
    page.do("swipe", **{"from": [x, y], "to": [x, y - 150]})
    turned = abs(page.evaluate("fake.camera.elevation"))
    assert turned > 0.8, "there is nothing to scroll in a page of the player alone"
    page.evaluate("(fake.camera.elevation = 0)")
    page.evaluate(f"({part('canvas')}.part.remove('canvas'), {ARTICLE})")  # as in a page without that style
    page.evaluate(SETTLED)
    x, y = middle(page)
    page.do("swipe", **{"from": [x, y], "to": [x + 100, y]})
    assert page.evaluate("[Math.abs(fake.camera.azimuth) > 0.3, scrollY]") == [True, 0]
    page.do("swipe", **{"from": [x, y], "to": [x, y - 150]})
    page.wait("scrollY > 50")
    assert abs(page.evaluate("fake.camera.elevation")) < 0.15


BAR = {"play", "scrub", "clips", "settings", "vr"}


@pytest.mark.parametrize(("size", "bar"), [((240, 192), BAR), ((400, 300), BAR | {"whole"})], ids=["tiny", "small"])
def test_the_bar_leaves_a_small_element_to_the_figure(opened: Open, size: tuple[int, int], bar: set[str]) -> None:
    page = opened(before="globalThis.fakeHeadset = 'willing'")
    page.evaluate(f"({ELEMENT}.style.cssText = 'width: {size[0]}px; height: {size[1]}px', 0)")
    page.wait(f"{part('canvas')}.clientWidth === {size[0]}")
    page.evaluate(SETTLED)
    assert page.evaluate(f"{part('.bar')}.offsetHeight") < 0.25 * size[1]
    shown = page.evaluate(
        f"[...{part('.bar')}.children].filter((one) => one.checkVisibility())"
        ".map((one) => [one.className, one.getBoundingClientRect().right])"
    )
    assert {name for name, _ in shown} == bar
    assert max(right for _, right in shown) <= size[0]


def test_an_element_of_which_only_the_height_is_given_stays_in_its_place(opened: Open) -> None:
    page = opened()
    page.evaluate("(document.querySelector('main').style.width = '320px', 0)")
    page.evaluate(f"({ELEMENT}.style.cssText = 'height: 300px; aspect-ratio: 4 / 3', 0)")
    assert page.evaluate(f"[{ELEMENT}.offsetWidth, {ELEMENT}.offsetHeight]") == [320, 300]


def test_a_page_with_the_policy_of_the_guide_plays_and_shows_its_poster(browser: Browser, serve: Serve) -> None:
    said = re.search(r"content security policy needs (.*?),\s+as the", GUIDE.read_text(), re.DOTALL)
    assert said
    trusting = ["default-src 'none'", "require-trusted-types-for 'script'", "trusted-types 'none'"]
    policy = "; ".join([*trusting, *re.findall(r"`(.*?)`", said[1].replace("\n", " "))])
    html = f"""<!doctype html><meta http-equiv="Content-Security-Policy" content="{policy}">
      <mua-avatar src="hero.muaavatar" poster="icon.svg" controls></mua-avatar>
      <script type="module" src="element.js"></script>"""
    with browser.page(serve({**fake_site(), "own.html": html.encode()}) + "own.html", before=HOLD) as page:
        page.wait(f"{part('.poster')}?.naturalWidth > 0")
        page.evaluate("go()")
        page.wait(LOADED)
        assert [line for line in page.reported["console"] if "Content Security Policy" in line] == []


def test_a_page_that_is_opened_from_the_disk_says_what_to_do(browser: Browser, tmp_path: Path) -> None:
    write_folder(tmp_path / "hero", fake_site())
    with browser.page((tmp_path / "hero" / "index.html").as_uri()) as page:
        stuck = "document.querySelector('#stuck')"
        page.wait(f"{stuck} && {stuck}.checkVisibility({{ visibilityProperty: true }})")
        said = page.evaluate(f"{stuck}.innerText")
        assert "python3 -m http.server" in said
        assert "--single-file" in said
        assert page.evaluate("document.querySelector('#open').disabled")


def test_a_page_that_plays_says_nothing_of_the_disk(opened: Open) -> None:
    page = opened()
    assert page.evaluate("[document.querySelector('#stuck'), document.querySelector('#open').disabled]") == [
        None,
        False,
    ]
