"""An element in the life of a page: moved, away and back, beside others, out of sight, and asked for more."""

import pytest
from web.pages import ELEMENT, avatar
from web.test_page import LOADED, SETTLED, Open, opened, part

__all__ = ["opened"]  # a fixture

HOLD = "globalThis.fakeHold = new Promise((go) => (globalThis.go = go))"
SIZES = (
    f"(({{width, height, clientWidth, clientHeight}}) => [width, height, clientWidth, clientHeight])({part('canvas')})"
)


def test_an_element_that_is_moved_plays_on(opened: Open) -> None:
    page = opened()
    page.evaluate("document.body.append(document.createElement('section')), (fake.time = 1), 0")
    page.evaluate(f"document.querySelector('section').append({ELEMENT})")
    page.evaluate(SETTLED)
    assert page.evaluate("[fakes, fake.disposed, fake.started, fake.time, fake.avatars.length]") == [
        1,
        False,
        True,
        1,
        1,
    ]
    page.evaluate(f"({ELEMENT}.style.width = '300px', 0)")
    page.wait(f"{SIZES}[2] === 300 && {SIZES}[0] === 300")  # it is still watched


def test_an_element_that_comes_back_later_loads_again(opened: Open) -> None:
    page = opened()
    page.evaluate(f"(globalThis.gone = {ELEMENT}, gone.remove(), 0)")
    page.wait("fake.disposed")
    page.evaluate("document.body.append(gone)")
    page.wait(f"fakes === 2 && {LOADED} && fake.started")
    assert page.evaluate("[fake.disposed, fake.avatars.length]") == [False, 1]


def test_two_elements_play_avatars_of_their_own(opened: Open) -> None:
    page = opened(files={"other": avatar("other")})
    page.evaluate("(globalThis.first = fake, 0)")
    page.evaluate(
        """(() => {
          globalThis.second = document.createElement("mua-avatar");
          const asked = { src: "other.muaavatar", clip: "wave", speed: "0.5", autoplay: "" };
          for (const name in asked) second.setAttribute(name, asked[name]);
          second.style.cssText = "position: fixed; inset: 0 auto auto 0; width: 200px; height: 100px";
          document.body.append(second);
        })()"""
    )
    page.wait("second.player && second.firstPicture > 0")
    page.evaluate("second.pause()")
    found = "[one.avatars[0].name, one.clip, one.speed, one.playing, one.disposed]"
    assert page.evaluate(f"[first, second.player].map((one) => {found})") == [
        ["hero", "walk", 1, True, False],
        ["other", "wave", 0.5, False, False],
    ]
    assert page.evaluate(f"[{ELEMENT}.clip, second.clip, second.avatars.length]") == ["walk", "wave", 1]
    page.evaluate("second.remove()")
    page.wait("second.player === null")
    assert page.evaluate("[first.disposed, first.started]") == [False, True]


def test_an_element_that_nobody_sees_rests_and_goes_on_when_it_is_seen(opened: Open) -> None:
    page = opened()
    page.evaluate(f"({ELEMENT}.style.translate = '0 9000px', 0)")
    page.wait("!fake.started")
    assert page.evaluate(f"[fake.playing, {ELEMENT}.player.playing]") == [True, True]
    page.evaluate(f"({ELEMENT}.style.translate = '', 0)")
    page.wait("fake.started")


@pytest.mark.parametrize(("ratio", "sharp"), [(1.5, 1.5), (3, 2)])
def test_a_canvas_has_the_pixels_that_it_has_on_the_screen(opened: Open, ratio: float, sharp: float) -> None:
    page = opened(before=f"Object.defineProperty(globalThis, 'devicePixelRatio', {{ value: {ratio} }})")
    for style in ("300px", "440px"):
        page.evaluate(f"({ELEMENT}.style.width = '{style}', 0)")
        page.wait(f"{SIZES}[2] === {int(style[:3])} && {SIZES}[0] === {int(int(style[:3]) * sharp + 0.5)}")
        width, height, wide, high = page.evaluate(SIZES)
        assert (width, height) == (int(wide * sharp + 0.5), int(high * sharp + 0.5))


def test_a_canvas_that_comes_onto_a_sharper_display_has_its_pixels(opened: Open) -> None:
    page = opened(size=(400, 300))
    wide = page.evaluate(SIZES)[0]
    page.do("resize", width=400, height=300, scale=2)
    page.wait(f"{SIZES}[0] === {2 * wide}")


def test_an_element_plays_on_in_another_document_and_looks_the_same(opened: Open) -> None:
    page = opened()
    look = "getComputedStyle(gone.shadowRoot.querySelector('canvas')).position"
    page.evaluate(f"(globalThis.gone = {ELEMENT}, document.body.append(document.createElement('iframe')), 0)")
    for place in ("document.querySelector('iframe').contentDocument", "document"):
        page.evaluate(f"(document.createElement('template').content.append(gone), {place}.body.append(gone), 0)")
        page.evaluate(SETTLED)
        assert page.evaluate(f"[fakes, fake.disposed, fake.started, {look}]") == [1, False, True, "absolute"]


def test_an_element_in_another_window_needs_no_frames_of_its_page(opened: Open) -> None:
    ask = "((ask) => (globalThis.requestAnimationFrame = (draw) => ask((now) => globalThis.away || draw(now))))"
    page = opened(before=f"{ask}(requestAnimationFrame)")
    window = "document.querySelector('iframe').contentWindow"
    page.evaluate(f"(globalThis.gone = {ELEMENT}, document.body.append(document.createElement('iframe')), 0)")
    page.evaluate(f"(globalThis.away = true, {window}.document.body.append(gone))")
    page.evaluate(f"new Promise((done) => {window}.setTimeout(done, 200))")  # observers have said what they see
    page.evaluate("(fake.time = 1.5)")
    clock = "gone.shadowRoot.querySelector('.clock').textContent"
    page.wait(f"{clock}.startsWith('1.5')")
    page.evaluate("(gone.pause(), globalThis.before = fake.drawn, gone.turn(9, 0))")
    page.wait("fake.drawn > before")


def test_a_paused_element_of_another_size_is_drawn_again(opened: Open) -> None:
    page = opened()
    page.press(" ")
    page.evaluate(SETTLED)
    drawn = page.evaluate("fake.drawn")
    page.evaluate(f"({ELEMENT}.style.width = '300px', 0)")
    page.wait(f"fake.drawn > {drawn}")


def test_a_figure_stays_in_view_in_another_shape_until_the_reader_comes_nearer(opened: Open) -> None:
    page = opened()
    for width, nearer in (300, False), (200, True):
        page.evaluate(f"(globalThis.before = fake.framed, {nearer:d} && {ELEMENT}.zoom(1), 0)")
        page.evaluate(f"({ELEMENT}.style.width = '{width}px', 0)")
        page.wait(f"{SIZES}[0] === {width}")
        assert page.evaluate("fake.framed > before") is not nearer


def test_attributes_count_after_it_is_loaded_and_leave_the_others(opened: Open) -> None:
    page = opened({"src": "hero.muaavatar", "speed": "0.5"})
    page.evaluate(f"{ELEMENT}.setAttribute('clip', 'wave')")
    page.evaluate(f"({ELEMENT}.player.time = 1, 0)")
    page.evaluate(f"{ELEMENT}.setAttribute('speed', '-1')")
    assert page.evaluate("[fake.clip, fake.speed, fake.time, fakes]") == ["wave", -1, 1, 1]
    page.evaluate(f"{ELEMENT}.setAttribute('clip', 'none of it')")
    assert page.evaluate("fake.clip") == "wave"
    page.evaluate(f"{ELEMENT}.removeAttribute('speed')")
    assert page.evaluate("fake.speed") == 1


def test_events_tell_of_each_avatar_and_of_the_first_picture_once(opened: Open) -> None:
    listen = """addEventListener("DOMContentLoaded", () => { globalThis.reported = [];
      const tell = ({ type, detail }) => reported.push([type, detail?.message ?? detail?.name ?? ""]);
      for (const name of ["load", "error", "picture"])
        document.querySelector("mua-avatar").addEventListener(name, tell);
    })"""
    page = opened(files={"other": avatar("other")}, before=listen)
    page.wait("reported.length === 2")
    page.evaluate(f"{ELEMENT}.setAttribute('src', 'other.muaavatar')")
    page.wait("reported.length === 3")
    page.evaluate(f"{ELEMENT}.add('absent.muaavatar')")
    page.wait("reported.length === 4")
    assert page.evaluate("reported.slice(0, 3)") == [["picture", ""], ["load", "hero"], ["load", "other"]]
    assert "404" in page.evaluate("reported[3][1]")


def test_frames_go_round_at_both_ends_of_a_clip(opened: Open) -> None:
    page = opened()
    page.evaluate(f"({ELEMENT}.seek(0), {ELEMENT}.step(-1))")
    assert page.evaluate("[fake.time, fake.playing]") == [pytest.approx(59 / 30), False]
    page.evaluate(f"{ELEMENT}.step(1)")
    assert page.evaluate("fake.time") == pytest.approx(0)
    page.evaluate(f"{ELEMENT}.nextClip()")
    assert page.evaluate("[fake.clip, fake.time]") == ["wave", 0]
    page.evaluate(f"({ELEMENT}.seek(1), {ELEMENT}.nextClip())")
    assert page.evaluate("[fake.clip, fake.time]") == ["walk", 0]


def test_an_avatar_that_is_taken_away_lets_the_others_stand_in_the_middle_and_is_out_of_the_panel(opened: Open) -> None:
    files = {"other": avatar("other")}
    page = opened({"src": "hero.muaavatar other.muaavatar"}, files=files, until="globalThis.fake?.avatars.length === 2")
    page.evaluate(f"{ELEMENT}.dismiss({ELEMENT}.avatars[0])")
    assert page.evaluate("fake.avatars.map(({name, place}) => [name, place[0]])") == [["other", 0]]
    assert page.evaluate(f"{part('.avatars')}.querySelectorAll('button').length") == 1
