"""A packed file that is shown while it arrives: its stages, and what is wrong with them."""

import base64
import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest
from servers import answering
from synthetic_avatar import synthetic_avatar, with_expressions, with_surface
from tree_edits import edited
from unpackable import trailing
from web.browser import Page
from web.pages import ELEMENT, SENTENCE
from web.test_modules import node, pytestmark  # noqa: F401  needs Node

from mua.asset.read import parse_checked
from mua.asset.write import encode

STEP = 101  # bytes that arrive together
TIMEOUT = 60  # seconds, after which a server no longer waits for a test that failed
Give = Callable[[bytes, bytes, int], str]  # first and second half of a file, and its length; its address


@pytest.fixture(scope="module")
def packed() -> bytes:
    """A file with a surface and two clips."""
    avatar = with_surface(synthetic_avatar())
    return encode(replace(avatar, clips=(*avatar.clips, replace(avatar.clips[0], name="again"))), storage="packed")


def stages(folder: Path, content: bytes, step: int = STEP) -> list[dict[str, Any]]:
    file = folder / "a.muaavatar"
    file.write_bytes(content)
    return node("stages", file, step)


def claiming(content: bytes, lie: Callable[[Any], Any]) -> bytes:
    """The file with other ends of its stages, at most as many."""
    ends = np.asarray(parse_checked(content)["stages"], dtype="<u4")
    other = np.asarray(lie(ends), dtype="<u4")
    assert content.count(ends.tobytes()) == 1
    there = np.uint32(len(ends)).tobytes() + ends.tobytes()
    other_bytes = np.uint32(len(other)).tobytes() + other.tobytes()
    return content.replace(there, other_bytes.ljust(len(there), b"\0"))


def test_a_browser_refuses_bytes_after_a_stream(page: Page, packed: bytes) -> None:
    """Node needs a stand-in for that: strict_inflate.mjs."""
    longer = edited(packed, trailing)
    bytes_of = [base64.b64encode(content).decode() for content in (packed, longer)]
    bytes_in = "Uint8Array.from(atob(text), (byte) => byte.charCodeAt(0)).buffer"
    asked = f"(text) => read({bytes_in}).then(() => 'ok', (error) => error.code)"
    given = f"{json.dumps(bytes_of)}.map({asked})"
    found = page.evaluate(f"import('./format/read.js').then(({{ read }}) => Promise.all({given}))")
    assert found == ["ok", "packed"]


def test_each_stage_shows_more_as_soon_as_it_is_there(tmp_path: Path, packed: bytes) -> None:
    found = stages(tmp_path, packed)
    ends = [int(end) for end in parse_checked(packed)["stages"]]
    assert [one["end"] for one in found] == ends[:4]
    assert all(one["got"] - one["end"] < STEP for one in found)
    texels = len(with_surface(synthetic_avatar()).rig.texels.texels)
    assert [one["texels"] for one in found] == [0, texels, texels, texels]
    assert [[one[part] > 0 for part in ("mean", "low", "details", "fixed")] for one in found] == [
        [False, False, False, False],
        [True, False, False, False],
        [True, True, True, False],
        [True, True, True, True],
    ]
    assert all((one["clips"], one["surface"]) == (1, None) for one in found)


def test_expressions_have_names_before_they_move_anything(tmp_path: Path) -> None:
    """So that a page may set weights, which the clip has too."""
    avatar = with_expressions(synthetic_avatar())
    found = [one["face"] for one in stages(tmp_path, encode(avatar, storage="packed"))]
    assert len(found) == 4
    weights = avatar.clips[0].expressions
    assert weights is not None
    assert found == [{"expressions": list(avatar.expressions), "weights": weights.ravel().tolist(), "moved": 0}] * 4


def test_of_stages_that_arrive_together_only_the_last_is_shown(tmp_path: Path, packed: bytes) -> None:
    ends = parse_checked(packed)["stages"]
    assert [one["end"] for one in stages(tmp_path, packed, int(ends[2]))] == [ends[2]]


def test_a_file_that_arrives_at_once_is_only_shown_whole(tmp_path: Path, packed: bytes) -> None:
    assert stages(tmp_path, packed, len(packed)) == []


MEGABYTE = 2**20


@pytest.mark.parametrize(
    ("total", "arriving", "soon"),
    [
        (10 * MEGABYTE, [MEGABYTE] * 3, [True, True, True]),
        (100 * MEGABYTE, [MEGABYTE] * 3, [False, False, False]),
        (4 * MEGABYTE, [MEGABYTE // 10] * 8 + [MEGABYTE], [False] * 8 + [True]),
        (10 * MEGABYTE, [5 * MEGABYTE, 0, 0, 0, 0, 0, MEGABYTE], [True, True, True, True, True, False, True]),
        (10 * MEGABYTE, [0, 0], [False, False]),
    ],
    ids=["fast", "slow", "slow at first", "still for a while", "nothing yet"],
)
def test_the_rest_is_expected_by_how_fast_bytes_come_and_whether_they_do(
    total: int, arriving: list[int], soon: list[bool]
) -> None:
    assert node("soon", total, *arriving)[0] == soon


@pytest.mark.parametrize("storage", ["f16", "i8"])
def test_a_plain_file_is_only_shown_whole(tmp_path: Path, storage: Any) -> None:
    assert stages(tmp_path, encode(synthetic_avatar(), storage=storage)) == []


@pytest.mark.parametrize(
    ("lie", "faults"),
    [
        (lambda ends: np.zeros_like(ends), []),
        (lambda ends: ends[:3], []),
        (lambda ends: ends // 2, ["truncated"]),
        (lambda ends: np.minimum(ends + 10**9, 2**32 - 1), []),
        (lambda ends: ends[[3, 0, 1, 2, 4]], ["value"]),
    ],
    ids=["none", "too few", "too early", "beyond the file", "falling"],
)
def test_stages_that_lie_are_faults_or_show_nothing(
    tmp_path: Path, packed: bytes, lie: Callable[[Any], Any], faults: list[str]
) -> None:
    found = stages(tmp_path, claiming(packed, lie))
    assert {one.get("code") for one in found} <= {*faults, None}
    assert all(one.get("code") for one in found[:1]) or not faults


def test_a_damaged_stage_is_a_fault(tmp_path: Path, packed: bytes) -> None:
    ends = parse_checked(packed)["stages"]
    damaged = bytearray(packed)
    damaged[int(ends[0]) + 8 : int(ends[1])] = bytes(int(ends[1]) - int(ends[0]) - 8)
    assert [one.get("code") is None for one in stages(tmp_path, bytes(damaged))] == [True, False, False, False]


@pytest.fixture
def halves() -> Iterator[tuple[Give, Event]]:
    """A server that gives a file up to a byte and the rest when the event is set; where there is none, it hangs up."""
    rest = Event()
    files: dict[str, tuple[bytes, bytes, int]] = {}

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            first, second, length = files[self.path]
            self.send_response(200)
            self.send_header("Content-Length", str(length))
            self.send_header("Access-Control-Allow-Origin", "*")
            self.end_headers()
            self.wfile.write(first)
            self.wfile.flush()
            rest.wait(TIMEOUT)
            self.wfile.write(second)

        def log_message(self, format: str, *arguments: object) -> None:
            """Say nothing."""

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:

        def give(first: bytes, second: bytes, length: int) -> str:
            files["/slow.muaavatar"] = first, second, length
            return f"http://127.0.0.1:{server.server_port}/slow.muaavatar"

        with answering(server):
            yield give, rest
            rest.set()


# Counts what is not transparent in an image.
COUNT = """(picture) => {
  const flat = new OffscreenCanvas(picture.width, picture.height).getContext("2d");
  flat.drawImage(picture, 0, 0);
  const { data } = flat.getImageData(0, 0, picture.width, picture.height);
  return data.filter((value, i) => i % 4 === 3 && value > 0).length;
}"""


def seen(page: Page) -> int:
    """Pixels of the present image that are not transparent."""
    picture = f"{ELEMENT}.player.draw().then(() => {ELEMENT}.screenshot()).then(createImageBitmap)"
    return int(page.evaluate(f"{picture}.then({COUNT})"))


def show(page: Page, url: str, until: str) -> None:
    page.evaluate(f"{ELEMENT}.setAttribute('show', 'splats'), {ELEMENT}.setAttribute('src', '{url}')")
    page.wait(f"{ELEMENT}.firstPicture > 0 && {ELEMENT}.avatars.length === 1 && {until}")


@pytest.mark.parametrize(("stage", "splats"), [(0, False), (1, True)], ids=["template", "coarse splats"])
def test_the_first_half_of_a_file_is_a_picture(
    page: Page, halves: tuple[Give, Event], packed: bytes, stage: int, splats: bool
) -> None:
    give, rest = halves
    end = int(parse_checked(packed)["stages"][stage])
    part = f"{ELEMENT}.avatars[0]"
    show(page, give(packed[:end], packed[end:], len(packed)), f"({part}.splats > 0) === {json.dumps(splats)}")
    assert page.evaluate(f"[{part}.whole, {part}.clips.length, {SENTENCE}.includes('Fetching')]") == [False, 1, True]
    assert seen(page) > 0
    page.evaluate(
        f"{ELEMENT}.addEventListener('load', () => (globalThis.loaded = {part})), globalThis.part = {part}, 0"
    )
    rest.set()
    page.wait("globalThis.loaded")
    assert page.evaluate(f"[loaded === part, part.whole, part.clips.length, {ELEMENT}.avatars.length]") == [
        True,
        True,
        2,
        1,
    ]
    assert page.evaluate(SENTENCE) == ""
    assert seen(page) > 0


def test_a_template_does_not_take_the_place_of_a_poster(page: Page, halves: tuple[Give, Event], packed: bytes) -> None:
    give, rest = halves
    end = int(parse_checked(packed)["stages"][0])
    page.evaluate(f"{ELEMENT}.setAttribute('poster', 'icon.svg')")
    page.evaluate(f"{ELEMENT}.setAttribute('src', '{give(packed[:end], packed[end:], len(packed))}')")
    page.wait(f"{ELEMENT}.avatars.length === 1")
    poster = f"{ELEMENT}.shadowRoot.querySelector('.poster')"
    assert page.evaluate(f"[{ELEMENT}.firstPicture, {poster}.hidden]") == [0, False]
    rest.set()
    page.wait(f"{ELEMENT}.firstPicture > 0 && {poster}.hidden && {ELEMENT}.avatars[0].whole")


@pytest.mark.parametrize(
    ("came", "begins", "says"),
    [(True, "slow.muaavatar: crc32: ", "the file is damaged"), (False, "", "was not fetched whole")],
)
def test_what_was_shown_goes_where_the_rest_is_damaged_or_does_not_come(
    page: Page, halves: tuple[Give, Event], packed: bytes, came: bool, begins: str, says: str
) -> None:
    give, rest = halves
    end = int(parse_checked(packed)["stages"][1])
    damaged = packed[end:-40] + bytes(byte ^ 1 for byte in packed[-40:])
    show(page, give(packed[:end], damaged if came else b"", len(packed)), "true")
    rest.set()
    page.wait(f"{SENTENCE}.includes('{says}')")
    assert page.evaluate(SENTENCE).startswith(begins)
    assert page.evaluate(f"{ELEMENT}.avatars.length") == 0
    assert seen(page) == 0


def test_an_avatar_that_is_taken_away_while_it_arrives_stays_away(
    page: Page, halves: tuple[Give, Event], packed: bytes
) -> None:
    give, rest = halves
    end = int(parse_checked(packed)["stages"][1])
    show(page, give(packed[:end], packed[end:], len(packed)), "true")
    page.evaluate(
        f"{ELEMENT}.addEventListener('load', () => (globalThis.loaded = true)), {ELEMENT}.avatars[0].remove()"
    )
    rest.set()
    page.wait("globalThis.loaded")
    assert page.evaluate(f"{ELEMENT}.avatars.length") == 0
    assert seen(page) == 0
