"""The server that shows a page on this machine: no other file can be reached; and `mua-view --web`."""

import http.client
import re
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from threading import Thread
from typing import Any, BinaryIO

import pytest
from commands import Commands
from page_tags import Tags
from servers import answering

from mua.cli.view_options import Asked
from mua.cli.view_web import attributes
from mua.share import server, site
from mua.share.poster import front, opening
from mua.share.server import serving

BYTES = bytes(range(256)) * 4
AUTHORITY = "127.0.0.1"


@pytest.fixture
def port(tmp_path: Path) -> Iterator[int]:
    """That of a server of a small site, beside a file that is not of it."""
    (tmp_path / "hero.muaavatar").write_bytes(BYTES)
    (tmp_path / "secret.txt").write_text("secret")
    names = ("index.html", "a.js", "x.wgsl", "style.css", "poster.png", "icon.svg")
    files: dict[str, site.Content] = dict.fromkeys(names, b"1")
    files |= {"my hero.muaavatar": tmp_path / "hero.muaavatar", "gone": tmp_path / "gone"}
    with serving(files) as server, answering(server):
        assert server.server_address[0] == AUTHORITY  # no other machine reaches it
        yield server.server_port


def ask(port: int, path: str, method: str = "GET", **headers: str) -> tuple[int, dict[str, str], bytes]:
    """Status, headers and body of an answer."""
    with closing(http.client.HTTPConnection(AUTHORITY, port)) as connection:
        connection.request(method, path, headers=headers)
        with connection.getresponse() as answer:
            return answer.status, dict(answer.getheaders()), answer.read()


def test_a_connection_that_is_reset_prints_nothing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with serving({"index.html": b"1"}) as server:
        server.daemon_threads = False  # so that closing waits for the answer
        thread = Thread(target=server.handle_request, daemon=True)
        thread.start()
        client = socket.create_connection((AUTHORITY, server.server_port))
        client.sendall(b"GET / HTTP/1.1\r\nHost: another\r\n\r\n")
        client.recv(1)
        client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        client.close()
        thread.join()
    assert capfd.readouterr().err == ""


class Changing(type(Path())):  # type: ignore[misc]  # the class of paths on this system
    """A file in whose place a shorter one, or none, comes when it has been looked at."""

    def open(self, *given: Any, **named: Any) -> Any:
        self.unlink()
        if self.stem == "short":
            Path(self).write_bytes(BYTES[:10])
        return super().open(*given, **named)


@pytest.mark.parametrize(("stem", "got"), [("short", 10), ("none", 0)])
def test_an_answer_ends_where_its_file_is_replaced_meanwhile(tmp_path: Path, stem: str, got: int) -> None:
    path = tmp_path / f"{stem}.muaavatar"
    path.write_bytes(BYTES)
    with serving({"a": Changing(path)}) as server:
        thread = Thread(target=server.handle_request, daemon=True)
        thread.start()
        with pytest.raises(http.client.IncompleteRead) as cut:
            ask(server.server_port, "/a")
        thread.join()
    assert len(cut.value.partial) == got


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


@pytest.mark.parametrize(
    "asked", ["bytes=0-1,4-5", "lines=1-2", "bytes=-", pytest.param(f"bytes={'9' * 5000}-", id="a number too long")]
)
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
    assert ask(port, "/", Host=f"localhost.evil.example:{port}")[0] == 421
    assert ask(port, "/", Host=f"localhost:{port}")[0] == 200
    assert ask(port, "/", Host="localhost:8080")[0] == 200, "a port that ssh forwards"


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
