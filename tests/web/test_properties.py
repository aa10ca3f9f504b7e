"""Attributes of the element as properties, set before, while and after an avatar loads; the engine is a stand-in."""

import json

import pytest
from web.browser import Browser, Serve
from web.pages import ELEMENT, SENTENCE, avatar, fake_site
from web.test_page import LOADED, SETTLED, Open, opened, part
from web.test_page_life import HOLD

__all__ = ["opened"]  # a fixture

BARE = b"<!doctype html><body><mua-avatar></mua-avatar>"
GIVEN = {
    "src": "hero.muaavatar",
    "clip": "wave",
    "speed": 0.5,
    "show": "template",
    "level": 384,
    "budget": 5000,
    "framebudget": 11.1,
    "stereo": True,
    "follow": True,
    "controls": True,
    "azimuth": 90,
    "elevation": -30,
    "orbit": 0,
    "autoplay": False,
    "poster": "icon.svg",
    "alt": "A dancer",
}
PLAYED = (
    "[fake.clip, fake.speed, fake.show.template, fake.show.splats, fake.level, fake.budget, fake.frameBudget, "
    "fake.stereo, fake.follow]"
)
WANTED = ["wave", 0.5, True, False, 384, 5000, 11.1, True, True]


@pytest.mark.parametrize("known", [False, True], ids=["before the module", "after it"])
def test_properties_that_are_set_before_an_avatar_loads_count(browser: Browser, serve: Serve, known: bool) -> None:
    with browser.page(serve({**fake_site(), "bare.html": BARE}) + "bare.html") as page:
        ask = f"(Object.assign({ELEMENT}, {json.dumps(GIVEN)}), 0)"
        module = "import('./element.js').then(() => 0)"
        for step in [module, ask] if known else [ask, module]:
            page.evaluate(step)
        page.wait(LOADED)
        page.evaluate(SETTLED)
        assert page.evaluate(PLAYED) == WANTED
        assert page.evaluate("[fake.camera.azimuth, fake.camera.elevation]") == pytest.approx(
            [1.5708, -0.5236], abs=1e-4
        )
        read = f"Object.fromEntries({json.dumps(list(GIVEN))}.map((name) => [name, {ELEMENT}[name]]))"
        assert page.evaluate(read) == GIVEN
        assert page.evaluate(f"Object.keys({ELEMENT})") == ["firstPicture", "offersVR"], (
            "each is a property of the class"
        )
        assert page.evaluate(f"[{part('.bar')}.hidden, {part('canvas')}.ariaLabel]") == [False, "A dancer"]
        assert page.reported["errors"] == []


def test_properties_that_are_set_while_it_loads_count(opened: Open) -> None:
    page = opened(until=f"{SENTENCE} === 'Loading half of it'", before=HOLD)
    page.evaluate(f"(Object.assign({ELEMENT}, {json.dumps({**GIVEN, 'src': 'hero.muaavatar?again'})}), 0)")
    page.evaluate("go()")
    page.wait(f"{LOADED} && fake.clip === 'wave'")
    page.evaluate(SETTLED)
    assert page.evaluate(PLAYED) == WANTED


def test_what_is_asked_before_an_avatar_is_there_is_done_when_it_is(opened: Open) -> None:
    for asked, wanted in [
        ("play()", [True, 0]),
        ("pause()", [False, 0]),
        ("seek(0.5)", [False, 0.5]),
        ("togglePlaying()", [True, 0]),
    ]:
        attributes = {"src": "hero.muaavatar"}
        page = opened(attributes, until=f"{SENTENCE} === 'Loading half of it'", before=HOLD)
        page.evaluate(f"{ELEMENT}.autoplay = {json.dumps(asked in ('pause()', 'seek(0.5)'))}")
        page.evaluate(f"({ELEMENT}.{asked}, go(), 0)")
        page.wait(LOADED)
        page.evaluate(SETTLED)
        assert page.evaluate("[fake.playing, fake.time]") == wanted, asked


def test_a_reader_who_paused_is_not_made_to_watch_by_another_avatar(opened: Open) -> None:
    page = opened(files={"other": avatar("other")})
    page.press(" ")
    page.evaluate(f"{ELEMENT}.add('other.muaavatar')")
    assert page.evaluate("[fake.avatars.length, fake.playing]") == [2, False]


def test_properties_follow_what_the_reader_does(opened: Open) -> None:
    page = opened({"src": "hero.muaavatar", "show": "splats"})
    page.press("s", "4", "1", "c", "l")
    read = "['stereo', 'show', 'clip', 'level']"
    wanted = [True, "skeleton", "wave", "full"]
    assert page.evaluate(f"{read}.map((name) => {ELEMENT}[name])") == wanted
    page.evaluate(f"{ELEMENT}.reload()")
    page.evaluate(SETTLED)
    assert page.evaluate(f"[fakes, ...{read}.map((name) => {ELEMENT}[name])]") == [2, *wanted]


def test_properties_are_taken_away_by_none(opened: Open) -> None:
    page = opened({"src": "hero.muaavatar", "speed": "2", "budget": "7", "stereo": ""})
    page.evaluate(f"Object.assign({ELEMENT}, {{ speed: null, budget: undefined, stereo: false, src: '' }})")
    page.wait(f"{ELEMENT}.player === null")
    assert page.evaluate(f"[{ELEMENT}.speed, {ELEMENT}.getAttribute('budget'), {ELEMENT}.stereo]") == [1, None, False]
    assert page.evaluate(f"[{ELEMENT}.budget, {ELEMENT}.framebudget].every((limit) => limit === null)")


def test_what_cannot_be_shown_is_said_and_the_picture_stays(opened: Open) -> None:
    listen = """addEventListener("DOMContentLoaded", () => { globalThis.reported = [];
      document.querySelector("mua-avatar").addEventListener("error", ({ detail }) => reported.push(detail.message));
    })"""
    page = opened({"src": "hero.muaavatar", "show": "splat"}, before=listen)
    said = 'show="splat": "splat" cannot be shown, only splats, geometry, template, skeleton, shadow.'
    assert page.evaluate(f"[fake.show.splats, reported, {SENTENCE}]") == [True, [said], said]
    page.evaluate(f"{ELEMENT}.show = 'template'")
    assert page.evaluate("[fake.show.splats, fake.show.template]") == [False, True]


@pytest.mark.parametrize(
    ("attribute", "value", "said"),
    [
        ("clip", "dnace", 'clip="dnace": hero has no such clip, only walk, wave.'),
        ("speed", "fast", 'speed="fast": expected a number.'),
    ],
)
def test_what_cannot_be_asked_for_is_said(opened: Open, attribute: str, value: str, said: str) -> None:
    page = opened({"src": "hero.muaavatar", attribute: value})
    page.wait(f"{SENTENCE} === {json.dumps(said)}")
    assert page.evaluate("[fake.clip, fake.speed]") == ["walk", 1]
    page.evaluate(f"{ELEMENT}.{attribute} = {json.dumps({'clip': 'wave', 'speed': '2'}[attribute])}")
    page.evaluate(f"({ELEMENT}.setAttribute('{attribute}', '{value}'))")
    page.wait(f"{SENTENCE} === {json.dumps(said)}")


def test_a_clip_of_another_avatar_may_be_set_before_its_src(opened: Open) -> None:
    listen = """addEventListener("DOMContentLoaded", () => { globalThis.reported = [];
      document.querySelector("mua-avatar").addEventListener("error", ({ detail }) => reported.push(detail.message));
    })"""
    other = avatar("other", [{"name": "bow", "seconds": 1.0, "frames": 30}])
    page = opened({"src": "hero.muaavatar"}, files={"other": other}, before=listen)
    page.evaluate(f"(({ELEMENT}.clip = 'bow'), ({ELEMENT}.src = 'other.muaavatar'))")
    page.wait("fake.avatars[0]?.name === 'other'")
    page.evaluate(SETTLED)
    assert page.evaluate("[fake.clip, reported]") == ["bow", []]


def test_an_element_tells_how_far_it_is_and_when_it_is_loaded(opened: Open) -> None:
    page = opened()
    page.evaluate("""(() => { globalThis.reported = [];
      const element = document.querySelector("mua-avatar");
      element.addEventListener("progress", ({ detail }) => reported.push([detail.totalProgress, element.loaded]));
      element.addEventListener("load", () => reported.push(["load", element.loaded]));
      element.src = "hero.muaavatar?again";
    })()""")
    page.wait("reported.length === 2")
    assert page.evaluate("reported") == [[0.5, False], ["load", True]]
    page.evaluate(f"{ELEMENT}.src = 'absent.muaavatar'")
    assert page.evaluate(f"{ELEMENT}.loaded") is False
    page.wait(f"{SENTENCE}.includes('404')")
    assert page.evaluate(f"{ELEMENT}.loaded") is False


def test_the_poster_is_back_until_another_avatar_is_drawn(opened: Open) -> None:
    page = opened({"src": "hero.muaavatar", "poster": "icon.svg"})
    page.wait(f"{part('.poster')}.hidden")
    page.evaluate(
        f"(globalThis.fakeHold = new Promise((go) => (globalThis.go = go)), {ELEMENT}.src = 'hero.muaavatar?2', 0)"
    )
    page.wait(f"!{part('.poster')}.hidden")
    page.evaluate("(go(), 0)")
    page.wait(f"{part('.poster')}.hidden && {LOADED}")
