"""The page and the element in a browser, with a stand-in for the engine."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from web.browser import PHONE, Browser, Page, Serve
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
            page = stack.enter_context(browser.page(serve(fake_site(attributes, **(files or {}))), **how))
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


def test_attributes_say_what_is_shown_and_from_where(opened: Open) -> None:
    given = {"clip": "wave", "speed": "0.5", "show": "template,skeleton", "azimuth": "90", "elevation": "-30"}
    page = opened({"src": "hero.muaavatar", **given})
    assert page.evaluate("[fake.clip, fake.speed]") == ["wave", 0.5]
    assert page.evaluate("Object.keys(fake.show).filter((name) => fake.show[name])") == ["template", "skeleton"]
    assert page.evaluate("[fake.camera.azimuth, fake.camera.elevation]") == pytest.approx([1.5708, -0.5236], abs=1e-4)
    assert page.evaluate(f"{part('.speed')}.value") == "0.5"
    page.evaluate(f"{ELEMENT}.setAttribute('elevation', '30')")
    assert page.evaluate("fake.camera.elevation") == pytest.approx(0.5236, abs=1e-4)


def test_attributes_say_how_finely_avatars_are_shown_and_whether_the_camera_follows(opened: Open) -> None:
    page = opened({"src": "hero.muaavatar", "level": "384", "budget": "200000", "follow": "", "stereo": ""})
    assert page.evaluate("[fake.level, fake.budget, fake.follow, fake.stereo]") == [384, 200000, True, True]
    page.evaluate(f"{ELEMENT}.setAttribute('level', 'full'), {ELEMENT}.removeAttribute('budget')")
    assert page.evaluate("[fake.level, fake.budget]") == ["full", None]
    page.evaluate(f"{ELEMENT}.setAttribute('level', 'none')")
    assert page.evaluate("fake.level") == "full", "what is no level is said, and changes nothing"
    page.evaluate(f"{ELEMENT}.removeAttribute('level')")
    assert page.evaluate("fake.level") == "auto"


def test_the_controls_play_and_choose(opened: Open) -> None:
    page = opened(files={"other": avatar("other")})
    assert page.evaluate(f"{part('canvas')}.getAttribute('aria-label')") == "hero"
    page.evaluate(f"{part('.play')}.click()")
    assert page.evaluate(f"[fake.playing, {part('.play')}.getAttribute('aria-label')]") == [False, "Play"]
    for name, value in ((".clips", "wave"), (".speed", "0.5")):
        page.evaluate(f"(({part(name)}.value = '{value}'), {part(name)}.dispatchEvent(new Event('change')))")
    assert page.evaluate("[fake.clip, fake.speed]") == ["wave", 0.5]
    page.evaluate(f"(fake.camera.distance = 9, {part('.reset')}.click())")
    assert page.evaluate("fake.camera.distance") == 4
    page.evaluate(f"({ELEMENT}.seek(1), {ELEMENT}.clip = 'wave', 0)")
    assert page.evaluate("[fake.time, fake.clip]") == [0, "wave"]


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
    page.press("1", "2", "3", "4", "5")
    shown = {"splats": False, "geometry": True, "template": True, "skeleton": True, "shadow": False}
    assert page.evaluate("fake.show") == shown
    page.press("f", "l", "l", "l")
    assert page.evaluate("[fake.follow, fake.level]") == [False, 192]
    page.press("s")
    assert page.evaluate("fake.stereo") is True
    for key, notches in (("+", 1), ("=", 2), ("-", 1), ("r", 0)):
        page.press(key)
        assert page.evaluate("fake.camera.distance") == pytest.approx(4 / 1.15**notches), key
    page.do("down", key="Control")
    page.press("c", "4")
    page.do("up", key="Control")
    assert page.evaluate("[fake.clip, fake.show.skeleton]") == ["wave", True]


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
    page.press("c")
    assert page.evaluate("fake.clip") == "wave"
    page.evaluate(f"({part('.scrub')}.step = 0.5, {part('.scrub')}.focus())")
    page.press("ArrowRight")
    assert page.evaluate("fake.time") == 0.5


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


def test_two_fingers_zoom(opened: Open) -> None:
    page = opened(size=PHONE, touch=True)
    x, y = middle(page)
    page.do("pinch", **{"from": [[x - 20, y], [x + 20, y]], "to": [[x - 60, y], [x + 60, y]]})
    assert page.evaluate("fake.camera.distance") == pytest.approx(4 / 3)
    assert page.evaluate("fake.camera.azimuth") == 0


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


def test_an_element_that_leaves_the_page_gives_its_memory_back(opened: Open) -> None:
    page = opened()
    page.evaluate(f"{ELEMENT}.remove()")
    page.wait("fake.disposed")


def test_another_src_takes_the_place_of_the_first(opened: Open) -> None:
    page = opened(files={"other": avatar("other")})
    page.evaluate(f"{ELEMENT}.setAttribute('src', 'other.muaavatar')")
    page.wait("fake.avatars[0]?.name === 'other'")
    assert page.evaluate("fake.avatars.length") == 1


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
    for seconds, said in ((1.2, "12 %, 24 %"), (0.3, "3 %, 6 %")):
        page.evaluate(f"{ELEMENT}.seek({seconds})")
        page.wait(f"{part('.outside')}.textContent === 'Outside of training: {said}'")
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
    with browser.page(serve(fake_site())) as page:
        elsewhere = serve({"x.js": b"globalThis.foreign = true"})
        reported = "addEventListener('securitypolicyviolation', (event) => done(event.effectiveDirective))"
        for code in (f"fetch('{elsewhere}x.js').catch(() => {{}})", f"import('{elsewhere}x.js').catch(() => {{}})"):
            directive = page.evaluate(f"new Promise((done) => {{ {reported}; {code}; }})")
            assert directive in ("connect-src", "script-src-elem")
        assert page.evaluate("globalThis.foreign ?? null") is None
