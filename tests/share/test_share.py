"""A shared folder, a single file and the server: content, errors, and that no other file can be reached."""

import base64
import hashlib
import http.client
import json
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from threading import Thread
from typing import Any, BinaryIO

import numpy as np
import pytest
from commands import Commands
from PIL import Image
from synthetic_avatar import synthetic_avatar

from mua.asset import write
from mua.avatar.camera import FILL
from mua.cli.view_options import Asked
from mua.cli.view_web import attributes
from mua.rig.bounds import root_positions
from mua.rotation import multiply
from mua.share import folder, server, single, site
from mua.share.poster import front, opening, view
from mua.share.server import serving
from mua.share.single import in_order

BYTES = bytes(range(256)) * 4
AUTHORITY = "127.0.0.1"
ON_DEMAND = (  # modules that no page needs before it shows an avatar
    *(
        "names/",
        "retarget/",
        "worker.js",
        "expressing.js",
        "rules.js",
        "wgsl/expressions.js",
        "vr.js",
        "headset.js",
        "picture.js",
    ),
    *("anatomy.js", "surface_mesh.js", "wgsl/skeleton.js", "wgsl/surface.js"),
)


class Tags(HTMLParser):
    """The start tags of a page, with their attributes."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))

    def one(self, name: str) -> dict[str, str | None]:
        (attributes,) = [attributes for tag, attributes in self.found if tag == name]
        return attributes


def share(command: Commands, *arguments: object) -> str:
    """The printed output of mua-share."""
    ended = command("share", "--reference", *arguments)
    assert ended.status == 0, ended.err
    return ended.out


def test_a_folder_holds_player_avatar_poster_and_page(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    printed = share(command, avatar_file, "-o", tmp_path / "out", "--title", 'A <"hero">', "--clip", "wave")
    files = {path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*") if path.is_file()}
    assert {"index.html", "page.js", "style.css", "player.js", "poster.png", "a.muaavatar"} <= files
    assert printed.startswith(f"{tmp_path / 'out'}: {len(files)} files, ")
    assert (tmp_path / "out" / "a.muaavatar").read_bytes() == avatar_file.read_bytes()
    element = Tags((tmp_path / "out" / "index.html").read_text()).one("mua-avatar")
    assert (element["src"], element["poster"], element["clip"]) == ("a.muaavatar", "poster.png", "wave")
    assert {"autoplay", "controls", "azimuth"} <= set(element)
    assert "<title>A &lt;&quot;hero&quot;&gt;</title>" in (tmp_path / "out" / "index.html").read_text()


def test_the_poster_shows_the_figure_on_nothing(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    share(command, avatar_file, "-o", tmp_path / "out")
    with Image.open(tmp_path / "out" / "poster.png") as poster:
        assert (poster.mode, poster.size[1]) == ("RGBA", 960)
        alpha = np.asarray(poster.getchannel("A"))
        assert (alpha.min(), alpha.max() > 200) == (0, True)


def test_the_box_of_the_figure_fills_width_and_height_of_the_poster(avatar_file: Path) -> None:
    avatar, clip = opening(avatar_file, None)
    gone = np.array([5, 0.5, -3], np.float32)
    translations = clip.translations.copy()
    translations[:, avatar.rig.skeleton.root] += gone
    for wide in (1, 3):
        bounds = avatar.bounds * [wide, 1, 1]
        camera = view(replace(avatar, bounds=bounds), replace(clip, translations=translations))
        box = bounds + root_positions(avatar.rig, clip)[0] + gone
        corners = np.array(np.meshgrid(*box.T, [1.0])).reshape(4, -1)
        x, y, _, w = camera.projection @ camera.view @ corners
        assert [np.abs(x / w).max(), np.abs(y / w).max()] == pytest.approx([FILL, FILL], rel=0.01)


def test_poster_and_page_show_the_front_that_the_first_frame_has() -> None:
    avatar = synthetic_avatar()
    first = avatar.clips[0].cut(np.zeros(1, int))
    turned = first.rotations.copy()
    turned[:, 0] = multiply(np.array([np.sqrt(0.5), 0, np.sqrt(0.5), 0]), turned[:, 0])
    turning = first.then(replace(first, rotations=turned))
    assert front(avatar, turning) == front(avatar, first)
    assert np.array_equal(view(avatar, turning).view, view(avatar, first).view)


def test_poster_and_page_begin_with_the_clip_asked_for(command: Commands, tmp_path: Path) -> None:
    avatar = synthetic_avatar()
    clip, root = avatar.clips[0], avatar.rig.skeleton.root
    rotations = clip.rotations.copy()
    rotations[:, root] = multiply(np.array([0.6, 0, 0.8, 0]), rotations[:, root])  # about the vertical
    backward = replace(clip, name="turned", rotations=rotations[::-1])
    write(tmp_path / "a.muaavatar", replace(avatar, clips=(clip, backward)))
    begins = {}
    for name in ("wave", "turned"):
        share(command, tmp_path / "a.muaavatar", "-o", tmp_path / "out", "--clip", name)
        element = Tags((tmp_path / "out" / "index.html").read_text()).one("mua-avatar")
        fronts = front(*opening(tmp_path / "a.muaavatar", name))
        assert float(element["azimuth"] or 0) == pytest.approx(fronts, abs=0.06)
        begins[name] = element["azimuth"], (tmp_path / "out" / "poster.png").read_bytes()
    assert all(one != other for one, other in zip(begins["wave"], begins["turned"], strict=True))


def test_everything_that_the_page_names_is_in_the_folder(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    share(command, avatar_file, "-o", tmp_path / "out")
    tags = Tags((tmp_path / "out" / "index.html").read_text()).found
    modules = [path for path in site.player_files() if path.endswith(".js") and not path.startswith(ON_DEMAND)]
    assert [given["href"] for _, given in tags if given.get("rel") == "modulepreload"] == modules
    named = [value for _, given in tags for name, value in given.items() if name in ("src", "href", "poster")]
    assert len(named) == 5 + len(modules)
    assert all((tmp_path / "out" / str(name)).is_file() for name in named)


def test_avatars_of_one_name_and_of_odd_names_all_have_a_place(avatar_file: Path, tmp_path: Path) -> None:
    odd = tmp_path / "my hero & co.muaavatar"
    odd.write_bytes(avatar_file.read_bytes())
    found = site.player_site([avatar_file, odd, avatar_file], site.Shown("three"))
    paths = [path for path in found if path.endswith(".muaavatar")]
    assert paths == ["a.muaavatar", "my-hero-co.muaavatar", "a-1.muaavatar"]


def test_a_shared_folder_is_replaced_whole(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    share(command, avatar_file, "-o", tmp_path / "out")
    (tmp_path / "out" / "stale.js").touch()
    share(command, avatar_file, "-o", tmp_path / "out", "--title", "again")
    assert not (tmp_path / "out" / "stale.js").exists()
    assert "<title>again</title>" in (tmp_path / "out" / "index.html").read_text()
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_folder_with_other_files_is_left_alone(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "index.html").write_text("<p>mine</p>")
    ended = command("share", avatar_file, "-o", tmp_path / "own")
    assert ended.sentence == (
        f"error: -o {tmp_path / 'own'}: holds other files, which would be lost; expected a new folder or a shared one"
    )
    assert (tmp_path / "own" / "index.html").read_text() == "<p>mine</p>"


def test_a_folder_that_cannot_be_finished_leaves_the_old_one(tmp_path: Path) -> None:
    out = tmp_path / "out"
    folder.write_folder(out, {"index.html": b"old"})
    with pytest.raises(folder.InputError, match="cannot be written"):
        folder.write_folder(out, {"index.html": b"new", "gone.muaavatar": tmp_path / "gone"})
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    assert (out / "index.html").read_bytes() == b"old"


def test_a_damaged_avatar_is_not_shared(command: Commands, tmp_path: Path) -> None:
    (tmp_path / "bad.muaavatar").write_bytes(b"not an avatar")
    ended = command("share", tmp_path / "bad.muaavatar", "-o", tmp_path / "out")
    assert "bad.muaavatar" in ended.sentence
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("more", [(), ("--single-file",)])
def test_an_avatar_that_is_damaged_beside_a_sound_one_is_named(
    command: Commands, avatar_file: Path, tmp_path: Path, more: tuple[str, ...]
) -> None:
    (tmp_path / "bad.muaavatar").write_bytes(b"not an avatar")
    output = tmp_path / ("out.html" if more else "out")
    assert "bad.muaavatar" in command("share", avatar_file, tmp_path / "bad.muaavatar", *more, "-o", output).sentence
    assert not output.exists()


def test_rejects_an_unknown_clip_before_anything_is_written(
    command: Commands, avatar_file: Path, tmp_path: Path
) -> None:
    assert "'jump'" in command("share", avatar_file, "--clip", "jump", "-o", tmp_path / "out").sentence
    assert not (tmp_path / "out").exists()


def test_a_single_file_holds_the_avatar_and_allows_only_its_own_script(
    command: Commands, avatar_file: Path, tmp_path: Path
) -> None:
    share(command, avatar_file, "--single-file", "-o", tmp_path / "one.html")
    page = (tmp_path / "one.html").read_text()
    held = re.search(r'data-name="a\.muaavatar">([^<]*)<', page)
    assert held
    assert base64.b64decode(held[1]) == avatar_file.read_bytes()
    (script,) = re.findall(r"<script>(.*?)</script>", page, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    (meta,) = [given for tag, given in Tags(page).found if tag == "meta" and "http-equiv" in given]
    assert f"script-src 'sha256-{digest}' blob:;" in str(meta["content"])
    assert [
        given for _, given in Tags(page).found if str(given.get("src") or given.get("href") or "data:")[:5] != "data:"
    ] == []


def test_every_module_of_the_single_file_finds_those_that_it_imports(avatar_file: Path) -> None:
    page = single.single_page([avatar_file], site.Shown("one"))
    found = re.search(r'id="modules">(.*?)</script>', page, re.DOTALL)
    assert found
    made: set[str] = set()
    for path, text in json.loads(found[1]):
        assert set(re.findall(r'"mua:([^"]+)"', text)) <= made, path
        code = re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.DOTALL)
        assert not re.search(r'(?:from|import|import\()\s*"\.', code), path
        assert "import.meta" not in code, path
        made.add(path)
    assert "page.js" in made


def test_modules_that_import_each_other_in_a_circle_are_refused() -> None:
    assert in_order({"a.js": 'import { b } from "./b.js";', "b.js": ""}) == ["b.js", "a.js"]
    with pytest.raises(ValueError, match="in a circle"):
        in_order({"a.js": 'import { b } from "./b.js";', "b.js": 'export { a } from "./a.js";'})


def test_avatars_too_large_for_a_single_file_are_refused(
    command: Commands, avatar_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(single, "LARGEST", 1000)
    sentence = command("share", avatar_file, "--single-file", "-o", tmp_path / "one.html").sentence
    assert "expected at most" in sentence
    assert not (tmp_path / "one.html").exists()


def test_a_single_file_is_an_html_file(command: Commands, avatar_file: Path, tmp_path: Path) -> None:
    sentence = command("share", avatar_file, "--single-file", "-o", tmp_path / "one").sentence
    assert sentence == f"error: -o is {tmp_path / 'one'}; expected a name that ends in .html with --single-file"


@pytest.fixture
def port(tmp_path: Path) -> Iterator[int]:
    """That of a server of a small site, beside a file that is not of it."""
    (tmp_path / "hero.muaavatar").write_bytes(BYTES)
    (tmp_path / "secret.txt").write_text("secret")
    names = ("index.html", "a.js", "x.wgsl", "style.css", "poster.png", "icon.svg")
    files: dict[str, site.Content] = dict.fromkeys(names, b"1")
    with serving({**files, "my hero.muaavatar": tmp_path / "hero.muaavatar", "gone": tmp_path / "gone"}) as server:
        thread = Thread(target=server.serve_forever, args=(0.02,))
        thread.start()
        assert server.server_address[0] == AUTHORITY  # no other machine reaches it
        yield server.server_port
        server.shutdown()
        thread.join()


def ask(port: int, path: str, method: str = "GET", **headers: str) -> tuple[int, dict[str, str], bytes]:
    """Status, headers and body of an answer."""
    connection = http.client.HTTPConnection(AUTHORITY, port)
    connection.request(method, path, headers=headers)
    answer = connection.getresponse()
    found = answer.status, dict(answer.getheaders()), answer.read()
    connection.close()
    return found


def test_a_body_does_not_wait_until_its_header_is_confirmed(port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    undelayed = []

    def copy(source: BinaryIO, target: Any, first: int, end: int) -> None:
        undelayed.append(target._sock.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
        target.write(source.read(end))

    monkeypatch.setattr(server, "_copy", copy)
    assert ask(port, "/a.js")[2] == b"1"
    assert undelayed == [1]


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("/", "text/html; charset=utf-8"),
        ("/index.html?x=1", "text/html; charset=utf-8"),
        ("/a.js", "text/javascript; charset=utf-8"),
        ("/x.wgsl", "text/wgsl; charset=utf-8"),
        ("/style.css", "text/css; charset=utf-8"),
        ("/poster.png", "image/png"),
        ("/icon.svg", "image/svg+xml"),
        ("/my%20hero.muaavatar", "application/octet-stream"),
    ],
)
def test_the_server_names_the_kind_of_each_file(port: int, path: str, kind: str) -> None:
    status, headers, body = ask(port, path)
    assert (status, headers["Content-Type"], headers["X-Content-Type-Options"]) == (200, kind, "nosniff")
    assert len(body) == int(headers["Content-Length"]) > 0


@pytest.mark.parametrize(
    "path", ["/secret.txt", "/../secret.txt", "/%2e%2e/secret.txt", "//etc/passwd", "/gone", "/a.js/", "/nothing"]
)
def test_nothing_but_the_site_is_served(port: int, path: str) -> None:
    status, _, body = ask(port, path)
    assert (status, body) == (404, b"Not Found\n")


@pytest.mark.parametrize(
    ("asked", "first", "end"),
    [("bytes=0-9", 0, 10), ("bytes=1000-", 1000, 1024), ("bytes=-24", 1000, 1024), ("bytes=1020-9999", 1020, 1024)],
)
def test_a_part_of_a_file_can_be_asked_for(port: int, asked: str, first: int, end: int) -> None:
    status, headers, body = ask(port, "/my%20hero.muaavatar", Range=asked)
    assert (status, body) == (206, BYTES[first:end])
    assert headers["Content-Range"] == f"bytes {first}-{end - 1}/1024"


@pytest.mark.parametrize("asked", ["bytes=1024-", "bytes=9-8", "bytes=-0"])
def test_a_part_that_is_not_there_is_refused(port: int, asked: str) -> None:
    status, headers, _ = ask(port, "/my%20hero.muaavatar", Range=asked)
    assert (status, headers["Content-Range"]) == (416, "bytes */1024")


@pytest.mark.parametrize("asked", ["bytes=0-1,4-5", "lines=1-2", "bytes=-"])
def test_what_is_no_single_range_is_answered_by_the_whole(port: int, asked: str) -> None:
    assert ask(port, "/my%20hero.muaavatar", Range=asked)[::2] == (200, BYTES)


def test_a_browser_keeps_nothing_for_the_next_run_at_the_same_address(port: int) -> None:
    for path in ("/", "/my%20hero.muaavatar"):
        assert ask(port, path)[1]["Cache-Control"] == "no-store"


def test_a_head_has_no_body(port: int) -> None:
    status, headers, body = ask(port, "/my%20hero.muaavatar", "HEAD")
    assert (status, headers["Content-Length"], body) == (200, "1024", b"")
    with socket.create_connection((AUTHORITY, port)) as plain, plain.makefile("rb") as answer:
        plain.sendall(f"HEAD /nothing HTTP/1.1\r\nHost: {AUTHORITY}:{port}\r\nConnection: close\r\n\r\n".encode())
        assert answer.read().endswith(b"\r\n\r\n")


def test_another_name_for_this_address_is_refused(port: int) -> None:
    assert ask(port, "/", Host=f"evil.example:{port}")[0] == 421
    assert ask(port, "/", Host=f"localhost:{port}")[0] == 200


def test_mua_view_serves_until_it_is_interrupted(avatar_file: Path) -> None:
    heeds = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"  # also in a job in the background
    code = f"{heeds}; import sys; sys.argv[0] = 'mua-view'; from mua.cli.view import run; run()"
    line = [sys.executable, "-u", "-c", code, str(avatar_file), "--web", "--no-open"]
    line += ["--show", "splats,template", "--stereo", "--clip", "wave"]
    line += ["--azimuth", "30", "--elevation", "10", "--orbit", "-5"]
    with subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as ran:
        try:
            _assert_served(ran, avatar_file)
        finally:
            ran.kill()  # where it is not as it should be, it would serve for ever


def _assert_served(ran: "subprocess.Popen[str]", avatar_file: Path) -> None:
    assert ran.stdout is not None
    assert ran.stderr is not None
    printed = ran.stdout.readline()
    found = re.fullmatch(r"a: http://127\.0\.0\.1:(\d+)/ \(Ctrl-C ends\)\n", printed)
    assert found, (printed, ran.stderr.read() if ran.poll() is not None else "")
    element = Tags(ask(int(found[1]), "/")[2].decode()).one("mua-avatar")
    assert (element["src"], element["show"], element["stereo"]) == ("a.muaavatar", "splats,template", "")
    assert (element["clip"], element["elevation"], element["orbit"]) == ("wave", "10", "-5")
    assert float(element["azimuth"] or "nan") == pytest.approx(30 + front(*opening(avatar_file, "wave")), abs=0.06)
    ran.send_signal(signal.SIGINT)
    assert ran.wait(timeout=60) == 0
    assert ran.stderr.read() == ""


def test_the_page_looks_from_beside_the_figures_front() -> None:
    assert attributes(Asked(azimuth=30.0, elevation=5.0), 90.0) == {"azimuth": "120.0", "elevation": "5"}


@pytest.mark.parametrize("option", ["-o=a.png", "--ipd=0.06", "--motion=a.bvh", "--frame=3"])
def test_what_a_browser_would_not_follow_is_refused(command: Commands, avatar_file: Path, option: str) -> None:
    name, _, value = option.partition("=")
    sentence = command("view", avatar_file, "--web", "--no-open", name, *([value] if value else [])).sentence
    assert sentence == f"error: {name}: does not work with --web; the page has controls of its own"


def test_no_open_alone_is_refused(command: Commands, avatar_file: Path) -> None:
    assert command("view", avatar_file, "--no-open").sentence == (
        "error: --no-open: works only with --web, which is not given"
    )
