"""The engine in a browser from the first load to the last: memory, a lost device, files that are wrong."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from web.browser import Browser, Page, Serve
from web.conftest import PLAIN
from web.engine import Open, load, opened, screenshot, small
from web.pages import COUNTED, LOSABLE

from mua.share.site import Site, player_files

__all__ = ["opened", "small"]  # fixtures
LOADS = 50


def test_fifty_loads_leave_no_memory_behind(opened: Open, small: Path) -> None:
    page = opened(a=small.read_bytes())
    empty = page.evaluate("player.bytes")
    held = set()
    for _ in range(LOADS):
        assert load(page) == ""
        held.add(page.evaluate("player.bytes"))
        page.evaluate("(avatar.remove(), avatar.remove())")
    assert len(held) == 1
    assert page.evaluate("player.bytes") == empty < min(held)


def test_a_lost_device_comes_back_with_its_avatars(opened: Open, small: Path) -> None:
    page = opened(before=LOSABLE, a=small.read_bytes())
    assert load(page) == ""
    before = screenshot(page)
    page.evaluate("new Promise((resolve) => setTimeout(resolve, 2100))")  # a device lost at once is given up
    page.evaluate('lose("unknown")')
    page.wait("player.bytes > 0")
    np.testing.assert_array_equal(screenshot(page), before)
    assert page.evaluate("faults") == []


def test_a_device_that_is_lost_again_at_once_is_given_up_in_a_sentence(opened: Open, small: Path) -> None:
    page = opened(before=LOSABLE, a=small.read_bytes())
    page.evaluate('lose("unknown")')
    page.wait("faults.length > 0")
    assert page.evaluate("faults") == ["The graphics device was lost twice at once; reload the page to try again."]
    assert load(page) == "The graphics device is away; try again in a moment."


@pytest.mark.parametrize(
    ("source", "reported"),
    [
        ('"none.muaavatar"', "none.muaavatar cannot be fetched: the server answers 404 Not Found."),
        ('"http://127.0.0.1:9/a.muaavatar"', "a.muaavatar cannot be fetched: the server is out of reach"),
        ('"half.muaavatar"', "half.muaavatar: the file has .* it is cut short or damaged; download or copy it again"),
        ('"damaged.muaavatar"', "damaged.muaavatar: crc32: .* the file is damaged"),
        ('new TextEncoder().encode("not an avatar").buffer', "this is not an avatar"),
        ('new File(["no"], "b.muaavatar")', "b.muaavatar: the file has 2 bytes and needs at least 8: it is cut short"),
    ],
    ids=["absent", "out of reach", "half", "damaged", "bytes", "file"],
)
def test_a_file_that_is_wrong_is_a_sentence(opened: Open, small: Path, source: str, reported: str) -> None:
    content = small.read_bytes()
    damaged = bytearray(content)
    damaged[-1] ^= 1
    page = opened(half=content[: len(content) // 2], damaged=bytes(damaged))
    assert re.match(reported, load(page, source))
    assert page.evaluate("player.avatars.length") == 0


def test_what_is_disposed_of_holds_nothing_and_may_be_disposed_of_again(opened: Open, small: Path) -> None:
    page = opened(a=small.read_bytes())
    assert load(page) == ""
    page.evaluate("(player.start(), player.dispose(), player.dispose())")
    assert page.evaluate("player.bytes") == 0


def test_a_picture_that_is_being_drawn_when_the_player_is_given_back_is_no_error(opened: Open) -> None:
    page = opened()
    assert page.evaluate("(() => { const drawn = player.draw(); player.dispose(); return drawn })()") is None


CALLED = (
    "(async () => {{ try {{ await ({}); return '' }} catch (error) {{ return error.name + ': ' + error.message }} }})()"
)
DISPOSED = "The player was disposed of; create another one."


@pytest.mark.parametrize(
    ("call", "said"),
    [
        ("player.load(null)", "Expected an address, a File or an ArrayBuffer to load, found null."),
        ("player.load(new Uint8Array(9))", "Expected an address, a File or an ArrayBuffer to load, found Uint8Array."),
        ("player.load('http://[')", '"http://[" is no address.'),
        ("avatar.playClip(3)", "Expected an address, a File or an ArrayBuffer to load, found Number."),
        ("avatar.retarget(null)", "retarget: expected names, parents, rotations and positions of joints."),
        ("avatar.retarget({ names: [] })", "retarget: expected names, parents, rotations and positions of joints."),
        ("avatar.setPose(3)", "setPose: expected rotations, translations or expressions, found 3."),
        (
            "avatar.setPose({ rotations: 3 })",
            "setPose: rotations: expected numbers, of all joints or by name, found 3.",
        ),
        ("avatar.setExpressions(0.5)", "setExpressions: expected weights by name, found 0.5."),
        ("(player.canvas.height = 0, player.screenshot())", "There is no picture of 0 x 0 pixels; give the canvas"),
        ("(player.dispose(), player.load('a.muaavatar'))", DISPOSED),
        ("(player.dispose(), player.screenshot())", DISPOSED),
        ("(() => { const loaded = player.load('a.muaavatar'); player.dispose(); return loaded })()", DISPOSED),
    ],
)
def test_a_wrong_call_is_a_sentence(opened: Open, small: Path, call: str, said: str) -> None:
    page = opened(a=small.read_bytes())
    assert load(page) == ""
    assert page.evaluate(CALLED.format(call)).startswith(f"AvatarError: {said}")


@pytest.mark.parametrize(
    "call",
    [
        "avatar.setPose({ rotations: null })",
        "(player.canvas.width = 0, player.draw())",
        "(player.time = NaN, player.time = -1, player.time = 1e300, player.draw())",
        "(player.speed = NaN, player.level = 7, player.clip = 'nobody', player.draw())",
        "(Object.assign(player.camera, { distance: 0 }), player.draw())",
        "(avatar.remove(), avatar.setPose({}), avatar.setExpressions({ nobody: 1 }), player.draw())",
        "(player.dispose(), player.draw(), player.start(), player.frameAll(), avatar.setPose({}), avatar.remove())",
    ],
)
def test_what_shows_nothing_else_is_no_error_and_a_picture_comes_after(opened: Open, small: Path, call: str) -> None:
    page = opened(a=small.read_bytes())
    assert load(page) == ""
    assert page.evaluate(CALLED.format(call)) == ""
    assert page.evaluate("Number.isFinite(player.time)")
    assert page.evaluate("faults") == []
    if "dispose" not in call:
        page.evaluate("(player.canvas.width = 64, player.canvas.height = 64, player.clip = 'wave', player.time = 0)")
        page.evaluate("player.camera.distance = 3")
        assert load(page) == ""
        assert screenshot(page).std() > 0.01


OTHER_SRC = "element.setAttribute('src', 'a.muaavatar?other')"
BACK = "(element.remove(), setTimeout(() => document.body.append(element)))"


@pytest.mark.parametrize("change", [OTHER_SRC, BACK], ids=["another src", "away and back"])
@pytest.mark.parametrize("after", [0, 120])  # milliseconds: while the device opens, and while kernels compile
def test_an_element_that_changes_before_its_first_picture_shows_one(
    browser: Browser, serve: Serve, small: Path, change: str, after: int
) -> None:
    site: Site = {**player_files(), "index.html": PLAIN, "a.muaavatar": small.read_bytes()}
    with browser.page(serve(site), size=(160, 200)) as page:
        page.wait("Boolean(customElements.get('mua-avatar'))")
        page.evaluate(f"""globalThis.element = document.querySelector("mua-avatar"), globalThis.reported = [];
          for (const kind of ["load", "error"])
            element.addEventListener(kind, ({{ detail }}) => reported.push(detail.message ?? kind));
          element.setAttribute("src", "a.muaavatar");
          setTimeout(() => ({change}, reported.length = 0), {after});""")
        page.wait("reported.length > 0 && element.firstPicture > 0")
        assert page.evaluate("[reported, element.avatars.length]") == [["load"], 1]
        assert page.reported["errors"] == []


BESIDE = """(async () => { const beside = document.createElement("mua-avatar");
  beside.src = "a.muaavatar";
  document.body.append(beside);
  await new Promise((load) => beside.addEventListener("load", load));
  return beside;
})()"""
# What the device remembers of avatars, and how many players it would tell of its loss.
REMEMBERED = """(() => { const { binders, losing } = first.player.renderer.device;
  return [[...binders].reduce((sum, { groups }) => sum + groups.length, 0), losing.size];
})()"""


@pytest.fixture
def one_of_two(browser: Browser, serve: Serve, small: Path) -> Iterator[Page]:
    """A page that shows an element, `first`; BESIDE adds another one."""
    site: Site = {**player_files(), "index.html": b"<!doctype html>", "a.muaavatar": small.read_bytes()}
    with browser.page(serve(site), size=(160, 400), before=COUNTED + LOSABLE) as page:
        page.evaluate("import('./element.js').then(() => 0)")
        page.evaluate(f"{BESIDE}.then((it) => (globalThis.first = it, first.player.renderer.compile())).then(() => 0)")
        yield page
        assert page.reported["errors"] == []


def test_a_second_element_uses_the_device_of_the_first_and_compiles_nothing(one_of_two: Page) -> None:
    page = one_of_two
    before = page.evaluate("({ ...asked })")
    assert before["requestDevice"] == 1
    page.evaluate(f"{BESIDE}.then((it) => (globalThis.second = it, 0))")
    assert page.evaluate("second.player.renderer.ready"), "its first picture waits for no compilation"
    assert page.evaluate("({ ...asked })") == before
    pixels = "(async (of) => [...new Uint8Array(await (await of.screenshot()).arrayBuffer())])"
    picture = page.evaluate(f"{pixels}(second)")
    assert picture == page.evaluate(f"{pixels}(first)")
    page.evaluate("first.remove()")
    page.wait("first.player === null")
    assert picture == page.evaluate(f"{pixels}(second)")


def test_elements_that_come_and_go_leave_nothing_on_the_device_of_those_that_stay(one_of_two: Page) -> None:
    page = one_of_two
    page.evaluate("first.screenshot().then(() => 0)")
    before = page.evaluate(REMEMBERED)
    held = page.evaluate("first.player.bytes")
    for _ in range(3):
        page.evaluate(f"{BESIDE}.then(async (it) => (await it.screenshot(), it.remove())).then(() => 0)")
    assert page.evaluate(f"[{REMEMBERED}, first.player.bytes]") == [before, held]


def test_all_elements_come_back_after_their_device_is_lost(one_of_two: Page) -> None:
    page = one_of_two
    page.evaluate(f"{BESIDE}.then((it) => (globalThis.second = it, 0))")
    page.evaluate("new Promise((resolve) => setTimeout(resolve, 2100))")  # a device lost at once is given up
    page.evaluate('lose("unknown")')
    page.wait("[first, second].every(({ player }) => player.renderer && player.bytes > 0)")
    assert page.evaluate("[asked.requestDevice, first.player.renderer.device === second.player.renderer.device]") == [
        2,
        True,
    ]
    assert page.evaluate("second.screenshot().then(({ size }) => size > 500)")
