"""The WebSocket that feeds a page with live poses: its frames as RFC 6455 has them, who may have it, what it brings."""

import http.client
import json
import socket
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from http.server import ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest
from commands import Commands
from people import person
from vmc_senders import BODY, bundle

from mua.live import live_pose
from mua.live.bones import AT_REST, BONES
from mua.live.live_pose import Live
from mua.live.receiver import Latency
from mua.live.vmc import Frame
from mua.pose.encoding import PoseEncoding
from mua.share import live_feed
from mua.share.live_feed import PATH, Feed, live_site
from mua.share.server import serving
from mua.share.site import Shown, player_site
from mua.share.websocket import MOST, WebSocket, accept

KEY, PROOF = "dGhlIHNhbXBsZSBub25jZQ==", "s3pPLMBiTxaQ9kYGzzhZRbK+xOo="  # section 1.3
HELLO = bytes.fromhex("818537fa213d7f9f4d5158")  # section 5.7: a masked "Hello"
HEAD = person().names.index("Head")
WAIT = 20.0  # seconds for what comes at once


@pytest.fixture
def ends() -> Iterator[tuple[WebSocket, socket.socket]]:
    """Our end of a connection, and the browser's."""
    ours, theirs = socket.socketpair()
    with closing(ours), closing(theirs):
        yield WebSocket(ours), theirs


def test_answers_the_handshake_of_the_standard() -> None:
    assert accept(KEY) == PROOF


@pytest.mark.parametrize(
    ("size", "head"),
    [(5, "8105"), (125, "817d"), (126, "817e007e"), (65535, "817effff"), (65536, "817f0000000000010000")],
)
def test_a_text_is_one_frame_of_its_length(ends: tuple[WebSocket, socket.socket], size: int, head: str) -> None:
    ours, theirs = ends
    sending = Thread(target=ours.send, args=("x" * size,))
    sending.start()
    expected = bytes.fromhex(head) + b"x" * size
    assert theirs.recv(len(expected), socket.MSG_WAITALL) == expected
    sending.join()


def test_reads_what_a_browser_sends_in_whatever_pieces(ends: tuple[WebSocket, socket.socket]) -> None:
    ours, theirs = ends
    assert ours.replies(0.0) == []
    theirs.sendall(HELLO + HELLO)
    assert ours.replies(WAIT) == ["Hello", "Hello"]
    for byte in HELLO[:-1]:
        theirs.sendall(bytes([byte]))
        assert ours.replies(WAIT) == []
    theirs.sendall(HELLO[-1:])
    assert ours.replies(WAIT) == ["Hello"]


@pytest.mark.parametrize(
    "sent",
    [bytes.fromhex("888000000000"), b"\x81\x05Hello", bytes.fromhex("81fe1000") + bytes(8), bytes(MOST), b""],
    ids=["closes", "not masked", "too long", "nonsense", "gone"],
)
def test_ends_with_what_it_does_not_understand(ends: tuple[WebSocket, socket.socket], sent: bytes) -> None:
    ours, theirs = ends
    theirs.sendall(sent)
    if not sent:
        theirs.close()
    assert ours.replies(WAIT) is None


class Turning:
    """A sender whose head turns on and on."""

    def newest(self, now: float) -> Frame:
        rotations = AT_REST.copy()
        rotations[BONES.index("Head")] = [np.cos(now), 0, np.sin(now), 0]
        return Frame(now, rotations, np.zeros((len(BONES), 3)), np.isin(BONES, BODY), {"A": 0.25})


@pytest.fixture
def live() -> Live:
    return Live(Turning().newest, person(), PoseEncoding(joints=(1,), rate=30.0), expressions=("aa", "happy"))


@contextmanager
def served(feed: Feed) -> Iterator[int]:
    """The port of a server of a page that is fed."""
    with serving(live_site(player_site([], Shown("live"))), {PATH: feed.feed}) as server:
        thread = Thread(target=server.serve_forever, args=(0.02,))
        thread.start()
        yield server.server_port
        server.shutdown()
        thread.join()


@pytest.fixture
def port(live: Live) -> Iterator[int]:
    with served(Feed([live, live], Latency())) as port:
        yield port


def asked(port: int, path: str = f"/{PATH}", **headers: str) -> tuple[int, http.client.HTTPConnection]:
    """The status of a request for a WebSocket, and its connection."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=WAIT)
    handshake = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13"}
    origin = {"Sec-WebSocket-Key": KEY, "Origin": f"http://127.0.0.1:{port}"}
    connection.putrequest("GET", path)
    for name, value in {**handshake, **origin, **headers}.items():
        connection.putheader(name.replace("_", "-"), value)
    connection.endheaders()
    with connection.sock.makefile("rb", buffering=0) as answer:
        status = int(answer.readline().split()[1])
        while answer.readline().strip():
            pass
    return status, connection


def text(connection: http.client.HTTPConnection) -> Any:
    """The next message."""
    size = int.from_bytes(connection.sock.recv(4, socket.MSG_WAITALL)[2:])
    return json.loads(connection.sock.recv(size, socket.MSG_WAITALL))


def test_brings_the_pose_of_every_avatar_as_it_changes(port: int, live: Live) -> None:
    status, connection = asked(port)
    with closing(connection):
        assert status == 101
        found = [text(connection) for _ in range(5)]
    assert sorted({message["id"] for message in found}) == [message["id"] for message in found]
    for message in found:
        first, second = message["avatars"]
        assert first == second
        turns = np.reshape(first["rotations"], (-1, 4))
        assert len(turns) == len(live.now.pose.rotations)
        np.testing.assert_allclose(np.linalg.norm(turns, axis=1), 1, atol=1e-5)
        assert np.shape(first["translations"]) == (3 * len(turns),)
        assert len(first["expressions"]) == 2
        assert first["expressions"][1] == 0
    heads = [np.reshape(each["avatars"][0]["rotations"], (-1, 4))[HEAD] for each in found]
    assert np.abs(np.diff(heads, axis=0)).max(axis=1).all()
    np.testing.assert_allclose(np.abs(np.array(heads)[:, [0, 2]]), 0, atol=1e-6)  # x, y, z, w: about Y alone


def test_a_pose_that_stays_is_sent_again_for_avatars_that_come_later(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live_feed, "AGAIN", 0.05)
    monkeypatch.setattr(live_pose, "EASING", 1e-9)  # two poses, then none
    still = Live(lambda now: None, person(), PoseEncoding(joints=(1,), rate=30.0))
    with served(Feed([still], Latency())) as port:
        _, connection = asked(port)
        with closing(connection):
            found = [text(connection)["avatars"] for _ in range(4)]
    assert found[1] == found[2] == found[3]


@pytest.mark.parametrize(
    ("path", "headers"),
    [
        (f"/{PATH}", {"Origin": "https://example.org"}),
        (f"/{PATH}", {"Origin": "null"}),
        ("/index.html", {}),
    ],
)
def test_nobody_but_the_page_is_given_poses(port: int, path: str, headers: dict[str, str]) -> None:
    status, connection = asked(port, path, **headers)
    connection.close()
    assert status == 403


def test_a_server_that_feeds_nobody_has_no_socket() -> None:
    with serving(player_site([], Shown("still"))) as server:
        thread = Thread(target=server.serve_forever, args=(0.02,))
        thread.start()
        status, connection = asked(server.server_port)
        connection.close()
        server.shutdown()
        thread.join()
    assert status == 403


def test_mua_view_feeds_its_page_with_what_it_hears(
    command: Commands, avatar_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found: dict[str, Any] = {}

    def visited(server: ThreadingHTTPServer) -> None:
        def answer() -> None:
            for _ in range(3):
                server.handle_request()

        thread = Thread(target=answer)
        thread.start()
        for path in ("/", "/bridge.js"):
            page = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=WAIT)
            with closing(page):
                page.request("GET", path)
                found[path] = page.getresponse().read().decode()
        _, connection = asked(server.server_port)
        with closing(connection):
            turned = bundle(("/VMC/Ext/Bone/Pos", "Head", *[0.0] * 4, 0.6, 0.0, 0.8), ("/VMC/Ext/OK", 1))
            deadline = time.monotonic() + WAIT
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as program:
                while not found.get("live") and time.monotonic() < deadline:
                    program.sendto(turned, ("127.0.0.1", free))
                    (avatar,) = text(connection)["avatars"]
                    turns = np.reshape(avatar["rotations"], (-1, 4))
                    found["live"] = 0.5 < abs(turns[2, 1]) < 0.7 and len(turns)  # x, y, z, w, once it is eased in
        thread.join()
        raise KeyboardInterrupt

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        free = probe.getsockname()[1]
    monkeypatch.setattr(ThreadingHTTPServer, "serve_forever", visited)
    mapping = tmp_path / "mapping.json"
    mapping.write_text(json.dumps({"root": "Hips", "tip": "Head"}))
    ended = command("view", avatar_file, "--web", "--no-open", "--listen", free, "--mapping", mapping)
    assert ended.status == 0, ended.err
    assert 'live="live"' in found["/"]
    assert '<script type="module" src="bridge.js"></script>' in found["/"]
    assert "setPose" in found["/bridge.js"]
    assert found["live"] == 3
    assert f"listens to VMC on 127.0.0.1:{free}, from this machine alone" in ended.out
    assert " packets, " in ended.out.splitlines()[-1]


def test_mua_view_listens_to_nothing_unless_asked(command: Commands, avatar_file: Path) -> None:
    sentence = command("view", avatar_file, "--web", "--no-open", "--mapping", "m.json").sentence
    assert sentence == "error: --mapping: works only with --motion or --listen, which is not given"
