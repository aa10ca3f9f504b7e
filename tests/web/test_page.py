"""The page and the element in a browser, with a stand-in for the engine."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from web.browser import Browser, Page, Serve
from web.pages import ELEMENT, SENTENCE, SHADOW, avatar, fake_site

LOADED = "globalThis.fake?.drawn > 0 && fake.avatars.length > 0"
SETTLED = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"
Open = Callable[..., Page]


@pytest.fixture
def opened(browser: Browser, serve: Serve) -> Iterator[Open]:
    """Opens the page with attributes of its element; at the end nothing unexplained is in its console."""
    with ExitStack() as stack:

        def begin(
            attributes: dict[str, str] | None = None, *, files: Any = None, until: str = LOADED, **how: Any
        ) -> Page:
            page = browser.page(serve(fake_site(attributes, **(files or {}))), **how)
            stack.callback(page.close)
            stack.callback(lambda: _all_explained(page))
            page.wait(until)
            page.evaluate(SETTLED)
            return page

        yield begin


def _all_explained(page: Page) -> None:
    reported = page.reported
    assert reported["errors"] == []
    assert [line for line in reported["console"] if "Failed to load resource" not in line] == []


def part(name: str) -> str:
    return f"{SHADOW}.querySelector('{name}')"


def middle(page: Page) -> list[float]:
    return page.evaluate(
        f"(({{x, y, width, height}}) => [x + width / 2, y + height / 2])({part('canvas')}.getBoundingClientRect())"
    )


def test_an_avatar_plays_as_soon_as_it_is_loaded(opened: Open) -> None:
    page = opened()
    assert page.evaluate("[fake.playing, fake.started, fake.clip]") == [True, True, "walk"]
    assert page.evaluate("document.title") == "Hero"
    assert page.evaluate(SENTENCE) == ""


def test_without_autoplay_it_waits(opened: Open) -> None:
    page = opened({"src": "hero.muaavatar"})
    page.evaluate(f"{ELEMENT}.removeAttribute('autoplay')")
    page.evaluate(f"{ELEMENT}.reload()")
    assert page.evaluate("[fake.playing, fake.started, fake.drawn > 0]") == [False, False, True]


def test_the_camera_orbits_where_that_is_asked_for(opened: Open) -> None:
    opened({"src": "hero.muaavatar", "orbit": "90"}).wait("fake.camera.azimuth > 0.01")


def test_the_panel_sets_the_level_of_detail_and_following(opened: Open) -> None:
    page = opened()
    level = part(".level")
    assert page.evaluate(f"[...{level}.options].map((one) => one.value)") == ["auto", "full", "384", "192"]
    page.evaluate(f"{level}.value = '192', {level}.dispatchEvent(new Event('change')), {part('.follow')}.click()")
    assert page.evaluate("[fake.level, fake.follow]") == [192, False]
    page.press("l", "f")
    assert page.evaluate(f"[{level}.value, {part('.follow')}.checked]") == ["auto", True]
    page.evaluate(f"{part('.stereo')}.click()")
    assert page.evaluate("fake.stereo") is True
    page.press("s")
    assert page.evaluate(f"{part('.stereo')}.checked") is False


def test_keys_do_what_they_do_on_the_desktop(opened: Open) -> None:
    page = opened()
    page.press(" ")
    assert page.evaluate("fake.playing") is False
    page.evaluate("fake.time = 0")
    page.press("ArrowRight", "ArrowRight")
    assert page.evaluate("fake.time") == pytest.approx(2 / 30)
    page.press("ArrowLeft", "ArrowLeft", "ArrowLeft")
    assert page.evaluate("fake.time") == pytest.approx(59 / 30)
    page.press("c")
    assert page.evaluate("[fake.clip, fake.time]") == ["wave", 0]
    page.press("4", "5")
    assert page.evaluate("[fake.show.skeleton, fake.show.shadow]") == [True, False]
    page.press("f", "l", "l", "l")
    assert page.evaluate("[fake.follow, fake.level]") == [False, 192]
    page.press("l", "s", "c")
    assert page.evaluate("[fake.level, fake.stereo, fake.clip]") == ["auto", True, "walk"]
    page.press("1", "2", "3", "+", "+", "-")
    assert page.evaluate("['splats', 'geometry', 'template'].map((name) => fake.show[name])") == [False, True, True]
    assert page.evaluate("fake.camera.distance") == pytest.approx(4 / 1.15)


def test_every_key_of_the_desktop_is_here() -> None:
    from mua.player.panel import KEYS

    text = (Path(__file__).parents[2] / "python" / "mua" / "web" / "keys.js").read_text()
    here = {key for key in KEYS if f"\n  {key}: [" in text or f'\n  "{key}": [' in text}
    numbers = {str(i) for i in range(1, 6)}
    assert set(KEYS) - here - numbers == set()


def test_a_control_that_has_the_focus_keeps_its_keys(opened: Open) -> None:
    page = opened({"src": "hero.muaavatar", "show": "splats"})
    page.evaluate(f"{part('.clips')}.focus()")
    page.press("c", "4")
    assert page.evaluate("[fake.clip, fake.show.skeleton]") == ["walk", False]
    page.evaluate(f"{part('.settings')}.focus()")
    page.press(" ")
    page.evaluate(f"{part('[name=skeleton]')}.focus()")
    page.press(" ")
    assert page.evaluate("[fake.playing, fake.show.skeleton]") == [True, True]
    page.evaluate(f"{part('.scrub')}.focus()")
    page.press("ArrowRight")
    assert page.evaluate("fake.time") != pytest.approx(1 / 30), "the slider's own step"
    page.press("c")
    assert page.evaluate("fake.clip") == "wave"


def test_the_controls_do_what_they_say_and_show_what_plays(opened: Open) -> None:
    page = opened({"src": "hero.muaavatar"}, files={"other": avatar("other")})
    page.evaluate(f"{part('.play')}.click()")
    assert page.evaluate(f"[fake.playing, {part('.play')}.ariaLabel]") == [False, "Play"]
    for name, value in (("clips", "wave"), ("speed", "0.5")):
        page.evaluate(f"(({part(f'.{name}')}.value = '{value}'), 0)")
        page.evaluate(f"{part(f'.{name}')}.dispatchEvent(new Event('change'))")
    assert page.evaluate("[fake.clip, fake.speed]") == ["wave", 0.5]
    page.evaluate("(fake.camera.azimuth = 1, 0)")
    page.evaluate(f"{part('.reset')}.click()")
    assert page.evaluate("fake.camera.azimuth") == 0
    page.evaluate(f"Object.assign({ELEMENT}, {{ speed: 2, clip: 'walk' }}, 0)")
    assert page.evaluate(f"[{part('.speed')}.value, {part('.clips')}.value]") == ["2", "walk"]
    page.evaluate(f"{ELEMENT}.add('other.muaavatar')")
    page.wait(f"{part('canvas')}.ariaLabel === 'hero, other'")


def test_shift_and_arrows_turn(opened: Open) -> None:
    page = opened()
    page.do("down", key="Shift")
    page.press("ArrowRight", "ArrowDown")
    page.do("up", key="Shift")
    assert page.evaluate("[fake.camera.azimuth, fake.camera.elevation]") == pytest.approx([-0.1396, 0.1396], abs=1e-3)


def test_the_mouse_turns_moves_and_zooms(opened: Open) -> None:
    page = opened()
    x, y = middle(page)
    page.do("drag", **{"from": [x, y], "to": [x + 50, y - 10]})
    assert page.evaluate("[fake.camera.azimuth, fake.camera.elevation]") == pytest.approx([-0.349, -0.0698], abs=1e-3)
    page.do("drag", **{"from": [x, y], "to": [x, y + 50]}, button="right")
    assert page.evaluate("fake.camera.target[1]") > 0.95
    assert page.evaluate("fake.camera.azimuth") == pytest.approx(-0.349, abs=1e-3)
    page.do("wheel", by=-100)
    page.wait("fake.camera.distance < 4")
    assert page.evaluate("fake.camera.distance") == pytest.approx(4 / 1.15)
    page.press("r")
    assert page.evaluate("[fake.camera.azimuth, fake.camera.distance]") == [0, 4]


def test_a_paused_avatar_is_drawn_only_when_something_changes(opened: Open) -> None:
    page = opened()
    page.press(" ")
    page.evaluate(SETTLED)
    drawn = page.evaluate("fake.drawn")
    page.evaluate("new Promise((done) => setTimeout(done, 200))")
    assert page.evaluate("[fake.drawn, fake.started]") == [drawn, False]
    page.press("1")
    page.wait(f"fake.drawn === {drawn + 1}")


def test_scrubbing_pauses_and_seeks(opened: Open) -> None:
    page = opened()
    page.evaluate(f"((scrub) => {{ scrub.value = '1.5'; scrub.dispatchEvent(new Event('input')); }})({part('.scrub')})")
    assert page.evaluate("[fake.time, fake.playing]") == [1.5, False]
    assert page.evaluate(f"{part('.clock')}.textContent") == "1.5 / 2.0 s"
    assert page.evaluate(f"{part('.scrub')}.getAttribute('aria-valuetext')") == "1.5 of 2.0 seconds"


def test_several_avatars_stand_side_by_side(opened: Open) -> None:
    files = {"other": avatar("other")}
    page = opened({"src": "hero.muaavatar other.muaavatar"}, files=files, until="globalThis.fake?.avatars.length === 2")
    left, right = page.evaluate("fake.avatars.map(({place}) => place[0])")
    assert right - left == pytest.approx(1.15)
    assert left + right == pytest.approx(0)
    page.press("a")
    assert page.evaluate("fake.camera.target[0]") == pytest.approx(left)
    page.evaluate(f"{part('.settings')}.click()")
    page.evaluate(f"{part('.avatars button')}.click()")
    assert page.evaluate("fake.avatars.map(({name, place}) => [name, place])") == [["other", [0, 0, 0]]]


DROP = """((target, name, content) => {
  const transfer = new DataTransfer();
  transfer.items.add(new File([content], name));
  for (const kind of ["dragover", "drop"])
    target.dispatchEvent(new DragEvent(kind, {dataTransfer: transfer, bubbles: true, cancelable: true}));
})"""


@pytest.mark.parametrize("target", [ELEMENT, "document.body"], ids=["on the avatar", "beside it"])
def test_a_file_that_is_dropped_is_shown(opened: Open, target: str) -> None:
    page = opened({}, until=f"Boolean({SHADOW})")
    assert page.evaluate("document.querySelector('#empty').checkVisibility()")
    page.evaluate(f"{DROP}({target}, 'dropped.muaavatar', '{avatar('dropped').decode()}')")
    page.wait(LOADED)
    assert page.evaluate("fake.avatars[0].name") == "dropped"
    assert not page.evaluate("document.querySelector('#empty').checkVisibility()")


def test_a_file_that_is_chosen_is_shown(opened: Open, tmp_path: Path) -> None:
    page = opened({}, until=f"Boolean({SHADOW})")
    (tmp_path / "chosen.muaavatar").write_bytes(avatar("chosen"))
    page.do("choose", code="document.querySelector('#open').click()", files=[str(tmp_path / "chosen.muaavatar")])
    page.wait(LOADED)
    assert page.evaluate("fake.avatars[0].name") == "chosen"
    page.do("choose", code="document.querySelector('#open').click()", files=[str(tmp_path / "chosen.muaavatar")])
    page.wait("fake.avatars.length === 2")  # a browser says nothing of a file that is chosen twice


def test_a_wrong_file_leaves_what_is_shown(opened: Open) -> None:
    page = opened()
    page.evaluate(f"{DROP}({ELEMENT}, 'notes.txt', 'hello')")
    page.wait(f"{SENTENCE} === 'notes.txt: not an avatar.'")
    assert page.evaluate("[fake.avatars.length, fake.playing]") == [1, True]
    page.evaluate(f"{part('.close')}.click()")
    assert page.evaluate(SENTENCE) == ""


def test_an_absent_file_is_a_sentence_and_can_be_tried_again(opened: Open) -> None:
    page = opened({"src": "absent.muaavatar"}, until=f"{SENTENCE}.includes('404')")
    assert page.evaluate(f"{part('.says p')}.getAttribute('role')") == "alert"
    assert page.evaluate(f"{part('.says')}.getBoundingClientRect().width") > 100
    assert page.evaluate(f"{part('.again')}.checkVisibility()")
    page.evaluate(f"{part('.again')}.click()")
    page.wait("fakes === 2")
    page.wait(f"{SENTENCE}.includes('404')")


def test_a_browser_without_webgpu_is_told_below_the_poster(opened: Open) -> None:
    given = {"src": "hero.muaavatar", "poster": "icon.svg"}
    page = opened(given, until=f"{SENTENCE}.includes('WebGPU')", before="globalThis.fakeMissing = true")
    assert page.evaluate(f"{part('.poster')}.checkVisibility()")
    assert page.evaluate(f"{part('.says')}.classList.contains('low')")
    assert not page.evaluate(f"{part('.bar')}.checkVisibility()")


def test_the_poster_is_there_until_the_first_picture(opened: Open) -> None:
    hold = "globalThis.fakeHold = new Promise((go) => (globalThis.go = go))"
    given = {"src": "hero.muaavatar", "poster": "icon.svg"}
    page = opened(given, until=f"{SENTENCE} === 'Loading half of it'", before=hold)
    assert page.evaluate(f"[{part('.poster')}.checkVisibility(), {part('progress')}.value]") == [True, 0.5]
    page.evaluate("go()")
    page.wait(LOADED)
    page.evaluate(SETTLED)
    assert page.evaluate(f"{part('.poster')}.checkVisibility()") is False
    assert page.evaluate(f"{ELEMENT}.firstPicture > 0")


def test_a_device_that_is_lost_is_told_and_loads_again(opened: Open) -> None:
    page = opened()
    page.evaluate(
        "fake.onerror(Object.assign(new (fakeError())('The device was lost.')))".replace("fakeError()", "Error")
    )
    page.wait(f"{SENTENCE}.includes('The device was lost.')")
    assert page.evaluate("fake.started") is False
    page.evaluate("(globalThis.old = fake, null)")
    page.evaluate(f"{part('.again')}.click()")
    page.wait("fakes === 2 && fake.drawn > 0")
    assert page.evaluate("[old.disposed, fake.avatars.length]") == [True, 1]


def test_a_picture_is_saved_under_the_avatars_name(opened: Open) -> None:
    page = opened()
    code = """new Promise((done) => {
      HTMLAnchorElement.prototype.click = function () { done([this.download, this.href.slice(0, 5)]); };
      document.dispatchEvent(new KeyboardEvent("keydown", {key: "p"}));
    })"""
    assert page.evaluate(code) == ["hero.png", "blob:"]


def test_the_panel_says_how_far_outside_of_training_each_pose_is(opened: Open) -> None:
    far = avatar("far", far=2)
    page = opened({"src": "hero.muaavatar far.muaavatar"}, files={"far": far}, until="fake?.avatars.length === 2")
    for seconds, shares in ((1.2, "12 %, 24 %"), (0.3, "3 %, 6 %")):
        page.evaluate(f"{ELEMENT}.seek({seconds})")
        page.wait(f"{part('.outside')}.textContent === 'Outside of training: {shares}'")
        assert page.evaluate(f"{ELEMENT}.outsideTraining") == pytest.approx(seconds / 10)
    page.evaluate(f"fake.avatars.map({ELEMENT}.dismiss, {ELEMENT})")
    assert page.evaluate(f"[{ELEMENT}.outsideTraining, {part('.outside')}.textContent]") == [0, ""]


def test_the_times_name_stages_and_device(opened: Open) -> None:
    page = opened()
    page.press("t")
    page.wait(f"{part('.adapter')}.textContent === 'fake adapter (software)'")
    rows = page.evaluate(f"[...{SHADOW}.querySelectorAll('.times td')].map((cell) => cell.textContent)")
    assert rows == ["decode", "1.25 ms", "sort", "0.50 ms", "all stages", "1.75 ms"]


def test_the_page_asks_for_nothing_but_its_own_folder(opened: Open) -> None:
    page = opened()
    home = page.evaluate("location.origin")
    assert [url for url in page.reported["requests"] if not url.startswith((home, "blob:", "data:"))] == []
    assert "script-src 'self'" in page.evaluate("document.querySelector('meta[http-equiv]').content")


def test_the_page_may_not_ask_for_anything_else(browser: Browser, serve: Serve) -> None:
    page = browser.page(serve(fake_site()))
    elsewhere = serve({"x.js": b"globalThis.foreign = true"})
    reported = "addEventListener('securitypolicyviolation', (event) => done(event.effectiveDirective))"
    for code in (f"fetch('{elsewhere}x.js').catch(() => {{}})", f"import('{elsewhere}x.js').catch(() => {{}})"):
        directive = page.evaluate(f"new Promise((done) => {{ {reported}; {code}; }})")
        assert directive in ("connect-src", "script-src-elem")
    assert page.evaluate("globalThis.foreign ?? null") is None
    page.close()
