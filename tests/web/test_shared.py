"""What mua-share writes, in a browser with the real engine: it plays, and what is wrong is a sentence on the page."""

import base64
import gzip
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from servers import answering
from web.browser import Browser, Page, Serve
from web.pages import ELEMENT, LOSABLE, SENTENCE, SHADOW

from mua.arrays import Array
from mua.share.poster import front, opening, poster
from mua.share.single import single_page
from mua.share.site import FIRST, Content, Shown, needed, player_files, player_site

THREE = Path(__file__).parent / "node_modules" / "three"
EXAMPLES = Path(__file__).parents[2] / "docs" / "examples" / "web"
LARGEST_PLAYER = 150_000  # bytes that every page loads, compressed as a web server would
PLAIN = b'<!doctype html><script type="module" src="element.js"></script><mua-avatar controls></mua-avatar>'
FULL = "GPUDevice.prototype.popErrorScope = async () => new GPUOutOfMemoryError('full')"
DRAWN = f"{ELEMENT}?.firstPicture > 0 && {ELEMENT}.avatars.length > 0"
Open = Callable[..., Page]


@pytest.fixture
def folder(avatar_file: Path) -> dict[str, Content]:
    """A shared folder with one avatar."""
    return player_site([avatar_file], Shown("A small avatar"))


@pytest.fixture
def opened(browser: Browser, serve: Serve) -> Iterator[Open]:
    """Opens a site; at the end nothing but what a server refused is in its console."""
    with ExitStack() as stack:

        def begin(site: dict[str, Content], *, until: str = DRAWN, **how: Any) -> Page:
            page = stack.enter_context(browser.page(serve(site), size=(320, 400), **how))
            stack.callback(lambda: _explained(page))
            page.wait(until)
            return page

        yield begin


def _explained(page: Page) -> None:
    reported = page.reported
    assert reported["errors"] == []
    known = ("Failed to load resource", "blocked by CORS policy")
    assert [line for line in reported["console"] if not any(word in line for word in known)] == []


def test_a_shared_folder_plays(opened: Open, folder: dict[str, Content]) -> None:
    page = opened(folder)
    assert page.evaluate(f"[{ELEMENT}.player.playing, {ELEMENT}.avatars.length]") == [True, 1]
    page.wait(f"{ELEMENT}.player.time > 0")
    home = page.evaluate("location.origin")
    assert all(url.startswith((home, "blob:")) for url in page.reported["requests"])


def test_the_first_picture_is_drawn_once(opened: Open, folder: dict[str, Content]) -> None:
    before = """globalThis.drawn = 0;
    const draw = GPUCanvasContext.prototype.getCurrentTexture;
    GPUCanvasContext.prototype.getCurrentTexture = function () { globalThis.drawn += 1; return draw.apply(this); };
    document.addEventListener("DOMContentLoaded", () => document.querySelector("mua-avatar")
      .addEventListener("picture", () => (globalThis.first = globalThis.drawn)));"""
    page = opened(folder, before=before)
    assert page.evaluate("globalThis.first") == 1


def test_the_example_of_plain_html_plays(opened: Open, avatar_file: Path) -> None:
    player = {f"player/{path}": file for path, file in player_files().items()}
    page = opened({**player, "index.html": EXAMPLES / "plain.html", "hero.muaavatar": avatar_file})
    assert page.evaluate("document.querySelector('#says').textContent").endswith(": 1 clips")


def test_the_example_of_three_draws_the_avatar_over_its_scene(opened: Open, avatar_file: Path, tmp_path: Path) -> None:
    player = {f"player/{path}": file for path, file in player_files().items()}
    used = ["build/three.module.js", "build/three.core.js", "examples/jsm/controls/OrbitControls.js"]
    three = {f"three/{path}": THREE / path for path in used}
    files = {**player, **three, "index.html": EXAMPLES / "three.html", "hero.muaavatar": avatar_file}
    count = """globalThis.drawn = 0; const draw = GPUCanvasContext.prototype.getCurrentTexture;
    GPUCanvasContext.prototype.getCurrentTexture = function () { globalThis.drawn += 1; return draw.call(this); };"""
    page = opened(files, until="globalThis.drawn > 2", before=count)

    def seen(hidden: str = "") -> Array:
        code = (
            "for (const one of document.querySelectorAll('canvas')) one.style.opacity = Number('#' + one.id !== '%s')"
        )
        page.evaluate(code % hidden)
        return np.asarray(Image.open(page.screenshot(tmp_path / "seen.png")).convert("RGB")).astype(float)

    both, scene, avatar = seen(), seen("#avatar"), seen("#scene")
    changed = [np.abs(both - one).max(axis=-1) > 8 for one in (scene, avatar)]
    assert 0.02 < changed[0].mean() < 0.6, "the figure, over a part of the scene"
    assert changed[1].mean() > 0.3, "the scene around it"


def test_the_picture_shows_the_figure_and_the_page_behind_it(opened: Open, folder: dict[str, Content]) -> None:
    page = opened(folder, prefers_reduced_motion="reduce")
    code = f"""{ELEMENT}.screenshot().then(createImageBitmap).then((picture) => {{
      const flat = new OffscreenCanvas(picture.width, picture.height).getContext("2d");
      flat.drawImage(picture, 0, 0);
      const alphas = flat.getImageData(0, 0, picture.width, picture.height).data.filter((_, i) => i % 4 === 3);
      return [Math.min(...alphas), Math.max(...alphas)];
    }})"""
    assert page.evaluate(code) == [0, 255]


def test_a_single_file_plays_from_the_disk(browser: Browser, avatar_file: Path, tmp_path: Path) -> None:
    (tmp_path / "one.html").write_text(single_page([avatar_file], Shown("One file")), encoding="utf-8")
    with browser.page(f"file://{tmp_path / 'one.html'}", size=(320, 400)) as page:
        page.wait(DRAWN)
        reported = page.reported
        assert (reported["console"], reported["errors"]) == ([], [])
        assert all(url.startswith(("file:", "blob:", "data:")) for url in reported["requests"])
        assert page.evaluate(f"{ELEMENT}.avatars.length") == 1


def test_no_webgpu_is_a_sentence(opened: Open, folder: dict[str, Content]) -> None:
    before = "Object.defineProperty(Navigator.prototype, 'gpu', { get: () => undefined })"
    opened(folder, until=f"{SENTENCE}.includes('WebGPU')", before=before)


def test_no_graphics_device_is_a_sentence(opened: Open, folder: dict[str, Content]) -> None:
    before = "GPU.prototype.requestAdapter = async () => null"
    page = opened(folder, until=f"{SENTENCE} && !{SENTENCE}.includes('Starting')", before=before)
    assert page.evaluate(SENTENCE).endswith(".")


def test_too_little_memory_is_a_sentence(opened: Open, folder: dict[str, Content]) -> None:
    opened(folder, until=f"{SENTENCE}.includes('too little free memory')", before=FULL)


def test_a_device_that_is_lost_for_good_is_a_sentence_and_can_be_tried_again(
    opened: Open, folder: dict[str, Content]
) -> None:
    page = opened(folder, before=LOSABLE)
    page.evaluate("globalThis.ask = GPU.prototype.requestAdapter, null")
    page.evaluate("GPU.prototype.requestAdapter = async () => null, lose('unknown')")
    page.wait(f"{SENTENCE} !== ''")
    page.evaluate(f"GPU.prototype.requestAdapter = ask, {ELEMENT}.shadowRoot.querySelector('.again').click()")
    page.wait(f"{SENTENCE} === '' && {DRAWN}")


@pytest.fixture
def elsewhere() -> Iterator[str]:
    """A server of another origin: it forbids others to read /closed and breaks the connection within /broken."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Length", "1000000")
            if self.path.startswith("/broken"):
                self.send_header("Access-Control-Allow-Origin", "*")
            self.end_headers()
            self.wfile.write(bytes(100_000))

        def log_message(self, format: str, *arguments: object) -> None:
            """Say nothing."""

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server, answering(server):
        yield f"http://127.0.0.1:{server.server_port}"


@pytest.mark.parametrize(
    ("path", "said"), [("closed", "does not allow this page to read it"), ("broken", "was not fetched whole")]
)
def test_what_another_server_does_not_give_is_a_sentence(opened: Open, elsewhere: str, path: str, said: str) -> None:
    page = opened({**player_files(), "index.html": PLAIN}, until="Boolean(customElements.get('mua-avatar'))")
    page.evaluate(f"{ELEMENT}.setAttribute('src', '{elsewhere}/{path}.muaavatar')")
    page.wait(f"{SENTENCE}.includes('{said}')")


def compressed(names: set[str]) -> int:
    files = player_files()
    return sum(len(gzip.compress(files[name].read_bytes())) for name in names)


def test_the_player_is_small() -> None:
    others = {name for name in player_files() if not name.endswith(".js")}
    assert compressed(needed(*FIRST, "worker.js") | others) < LARGEST_PLAYER


@pytest.mark.parametrize(
    ("roots", "largest"),
    [
        (["retarget/play.js", "retarget/rig.js"], 42_000),
        (["vr.js"], 10_000),
        (["anatomy.js"], 6_500),
        (["expressing.js"], 7_000),
        (["rules.js"], 700),
        (["names/face.js"], 5_500),
        (["picture.js"], 1_000),
    ],
    ids=["motion", "headset", "geometry and skeleton", "expressions", "rules", "names", "screenshot"],
)
def test_what_is_loaded_on_demand_is_small(roots: list[str], largest: int) -> None:
    assert 0 < compressed(needed(*roots) - needed(*FIRST)) < largest


def test_what_cannot_be_fetched_on_demand_is_a_sentence_and_the_splats_stay(
    opened: Open, folder: dict[str, Content]
) -> None:
    page = opened({name: content for name, content in folder.items() if name != "anatomy.js"})
    page.evaluate(f"{ELEMENT}.show = 'splats,geometry,shadow'")
    page.wait(f"{SENTENCE}.includes('Geometry and skeleton cannot be shown')")
    assert page.evaluate(f"{ELEMENT}.show") == "splats,shadow"


@pytest.mark.parametrize(
    ("module", "asked", "cannot"),
    [
        ("retarget/play.js", "avatars[0].playClip('walk.bvh')", "playClip: "),
        ("retarget/rig.js", "avatars[0].retarget({})", "retarget: "),
        ("picture.js", "screenshot()", "screenshot: "),
    ],
)
def test_what_a_page_asks_for_and_cannot_be_fetched_is_one_error(
    opened: Open, folder: dict[str, Content], module: str, asked: str, cannot: str
) -> None:
    page = opened({name: content for name, content in folder.items() if name != module})
    said = page.evaluate(f"{ELEMENT}.{asked}.catch(({{ name, message }}) => [name, message])")
    assert said[0] == "AvatarError"
    assert said[1].startswith(cannot)
    assert module in said[1]


def test_motion_that_cannot_be_fetched_is_a_sentence_and_the_avatar_stays(
    opened: Open, folder: dict[str, Content]
) -> None:
    page = opened({name: content for name, content in folder.items() if name != "retarget/play.js"})
    assert page.evaluate(f"{ELEMENT}.playClip('walk.bvh')") is None
    page.wait(f"{SENTENCE}.includes('playClip: ')")
    assert page.evaluate(f"{ELEMENT}.avatars.length") == 1


def extent(alpha: Array) -> Array:
    """First and last row and column [2, 2] in which anything shows."""
    places = np.argwhere(alpha > 0.1)
    return np.array([places.min(axis=0), places.max(axis=0) + 1])


@pytest.mark.parametrize("size", [(400, 200), (120, 300)], ids=["wide", "narrow"])
def test_the_poster_is_framed_as_the_figure(
    opened: Open, avatar_file: Path, monkeypatch: pytest.MonkeyPatch, size: tuple[int, int]
) -> None:
    monkeypatch.setattr("mua.share.poster.HEIGHT", 240)
    begins = opening(avatar_file, None)
    content = poster(avatar_file, *begins, reference=True)
    with Image.open(BytesIO(content)) as image:
        there = extent(np.asarray(image)[..., 3] / 255)
        scale = min(size[0] / image.width, size[1] / image.height)  # as object-fit: contain
        middle = np.array([image.height, image.width]) / 2
    style = f"min-height: 0; width: {size[0]}px; height: {size[1]}px"
    more = {"show": "splats", "azimuth": str(front(*begins))}
    page = opened(player_site([avatar_file], Shown("Hero", more=more)))
    page.evaluate(f"({ELEMENT}.style.cssText = '{style}', {ELEMENT}.controls = false, {ELEMENT}.seek(0), 0)")
    page.wait(
        f"(({{ width, height }}) => width === {size[0]} && height === {size[1]})({SHADOW}.querySelector('canvas'))"
    )
    page.evaluate(f"{ELEMENT}.resetView()")
    url = page.evaluate(f"""{ELEMENT}.screenshot().then((blob) => new Promise((done) => {{
      const reader = Object.assign(new FileReader(), {{ onload: () => done(reader.result) }});
      reader.readAsDataURL(blob);
    }}))""")
    with Image.open(BytesIO(base64.b64decode(url.split(",")[1]))) as image:
        assert image.size == size
        drawn = extent(np.asarray(image)[..., 3] / 255)
    expected = (there - middle) * scale + np.array(size[::-1]) / 2
    np.testing.assert_allclose(drawn, expected, atol=0.03 * max(size))
