"""The events that feed a page with live poses: who may have them, what they bring."""

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
from servers import answering
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

HEAD = person().names.index("Head")
WAIT = 20.0  # seconds for what comes at once


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
    with serving(live_site(player_site([], Shown("live"))), {PATH: feed}) as server, answering(server):
        yield server.server_port


@pytest.fixture
def port(live: Live) -> Iterator[int]:
    with served(Feed([live, live], Latency())) as port:
        yield port


def asked(
    port: int, path: str = f"/{PATH}", *, method: str = "GET", body: str | None = None, **headers: str
) -> tuple[http.client.HTTPResponse, http.client.HTTPConnection]:
    """What the server answers, and the connection."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=WAIT)
    connection.request(method, path, body, headers)
    return connection.getresponse(), connection


def text(answer: http.client.HTTPResponse) -> Any:
    """The next message."""
    name, message = answer.readline().split(b": ", 1)
    assert (name, answer.readline()) == (b"data", b"\n")
    return json.loads(message)


def test_brings_the_pose_of_every_avatar_as_it_changes(port: int, live: Live) -> None:
    answer, connection = asked(port)
    with closing(connection):
        assert (answer.status, answer.headers["Content-Type"]) == (200, "text/event-stream")
        found = [text(answer) for _ in range(5)]
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
        answer, connection = asked(port)
        with closing(connection):
            found = [text(answer)["avatars"] for _ in range(4)]
    assert found[1] == found[2] == found[3]


@pytest.mark.parametrize(
    ("path", "headers"),
    [
        (f"/{PATH}", {"Origin": "https://example.org"}),
        (f"/{PATH}", {"Origin": "null"}),
        (f"/{PATH}", {"Origin": "http://127.0.0.1:3000"}),  # another server of this machine
        (f"/{PATH}", {"Host": "example.org"}),
        (f"/{PATH}", {"Host": "example.org", "Origin": "http://example.org"}),
    ],
)
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_nobody_but_the_page_is_given_poses(port: int, method: str, path: str, headers: dict[str, str]) -> None:
    answer, connection = asked(port, path, method=method, body="1" if method == "POST" else None, **headers)
    with closing(connection):
        assert answer.status == 403


def test_a_page_on_a_port_that_ssh_forwards_is_given_poses(port: int) -> None:
    answer, connection = asked(port, Host="localhost:8080", Origin="http://localhost:8080")
    with closing(connection):
        assert len(text(answer)["avatars"]) == 2


@pytest.mark.parametrize(("path", "body", "status"), [("/index.html", "1", 403), (f"/{PATH}", 33 * "1", 400)])
def test_an_answer_is_short_and_of_a_stream(port: int, path: str, body: str, status: int) -> None:
    answer, connection = asked(port, path, method="POST", body=body)
    with closing(connection):
        assert answer.status == status


def test_what_a_page_has_drawn_is_timed(live: Live) -> None:
    latency = Latency()
    feed = Feed([live], latency)
    number = json.loads(next(feed.texts()))["id"]
    feed.replied("another")
    assert str(latency) == "no picture yet"
    feed.replied(str(number))
    assert "from packet to picture" in str(latency)


def test_a_server_that_feeds_nobody_has_no_stream() -> None:
    with serving(player_site([], Shown("still"))) as server, answering(server):
        answer, connection = asked(server.server_port)
        with closing(connection):
            assert answer.status == 404


def test_mua_view_feeds_its_page_with_what_it_hears(
    command: Commands, avatar_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found: dict[str, Any] = {}

    def visited(server: ThreadingHTTPServer) -> None:
        def answer() -> None:
            for _ in range(3):
                server.handle_request()

        thread = Thread(target=answer, daemon=True)
        thread.start()
        for path in ("/", "/bridge.js"):
            page = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=WAIT)
            with closing(page):
                page.request("GET", path)
                found[path] = page.getresponse().read().decode()
        live, connection = asked(server.server_port)
        with closing(connection):
            turned = bundle(("/VMC/Ext/Bone/Pos", "Head", *[0.0] * 4, 0.6, 0.0, 0.8), ("/VMC/Ext/OK", 1))
            deadline = time.monotonic() + WAIT
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as program:
                while not found.get("live") and time.monotonic() < deadline:
                    program.sendto(turned, ("127.0.0.1", free))
                    (avatar,) = text(live)["avatars"]
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
