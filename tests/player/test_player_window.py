"""The interactive player answers mouse and keys; its window opens on a display and says so where there is none.

Most tests drive a window without a display (driven_window.py); one opens a window on a virtual display and looks at the
screen.
"""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from driven_window import COLOR, EMPTY, LOOK, SIZE, Driven
from PIL import ImageGrab

from mua.cli.view_options import Asked, look_of
from mua.errors import InputError
from mua.gpu import Device
from mua.player.panel import KEYS, WIDTH
from mua.player.played_files import Source
from mua.player.toggles import Toggles
from mua.player.window import show

DEADLINE = 120.0  # seconds for a window to open on a busy machine; it takes a few


def test_orbits_pans_and_zooms_by_mouse(window: Driven) -> None:
    middle = (470, 180)
    seen = [window.picture()]
    before = window.session.view
    assert before is not None
    window.drag(middle, (530, 160), button=1)
    turned = window.session.view
    assert turned is not None
    assert turned.azimuth < before.azimuth  # the figure follows the mouse
    assert turned.elevation < before.elevation
    seen.append(window.picture())
    window.drag(middle, (500, 180), button=2)
    panned = window.session.view
    assert panned is not None
    assert panned.azimuth == turned.azimuth
    assert np.linalg.norm(panned.target - turned.target) > 0
    seen.append(window.picture())
    window.send({"event_type": "wheel", "dx": 0, "dy": -200, "x": 470, "y": 180, "buttons": (), "modifiers": ()})
    assert window.session.view is not None
    assert window.session.view.distance < panned.distance
    seen.append(window.picture())
    window.drag(middle, (480, 190), button=1, modifiers=("Shift",))
    assert window.session.view.azimuth == turned.azimuth
    for one, other in pairwise(seen):
        assert (one[:, WIDTH:] != other[:, WIDTH:]).any()


def test_every_key_does_what_the_panel_says(window: Driven) -> None:
    session = window.session
    window.press(" ")
    assert session.playing
    window.press("ArrowRight")
    assert not session.playing
    index = session.index
    window.press("ArrowLeft")
    assert session.index == (index - 1) % len(session.clip)
    for key, name in zip("12345", ("splats", "geometry", "template", "skeleton", "shadow"), strict=True):
        before = getattr(session.toggles, name)
        window.press(key)
        assert getattr(session.toggles, name) is not before
    for key, name in (("s", "stereo"), ("f", "follow"), ("t", "timed")):
        before = getattr(session, name)
        window.press(key)
        assert getattr(session, name) is not before
        window.picture()
    window.press("r")
    assert session.view is None
    window.press("a")
    assert session.file == session.files[1]
    window.press("c")
    assert session.clip.name == "twice"
    assert set(KEYS) == {" ", "ArrowLeft", "ArrowRight", *"12345", *"acflrst"}


def test_changes_the_picture_with_every_toggle(window: Driven) -> None:
    window.session.toggles = Toggles(splats=False)
    empty = window.picture()[:, WIDTH + 20 :]
    for name in ("splats", "geometry", "template", "skeleton", "shadow"):
        window.session.toggles = replace(Toggles(splats=False), **{name: True})
        assert (window.picture()[:, WIDTH + 20 :] != empty).any(), name


def test_stops_drawing_at_rest_and_draws_on_while_playing(window: Driven) -> None:
    asked: list[bool] = []
    window.canvas.request_draw = lambda *_: asked.append(True)
    for _ in range(5):
        window.picture()
    asked.clear()
    window.picture()
    assert not asked
    window.session.playing = True
    window.picture()
    assert asked


def test_times_the_kernels_that_ran(window: Driven) -> None:
    window.session.timed = True
    window.session.step(1)
    window.picture()
    if window.session.can_time:
        assert {"MlpMatmul", "SplatProject", "ScatterDigits"} <= set(window.session.milliseconds)
        assert min(window.session.milliseconds.values()) >= 0
    else:
        assert not window.session.milliseconds


def test_keeps_the_avatar_where_the_next_is_broken(window: Driven) -> None:
    session = window.session
    session.choose_file(session.files[2])
    assert session.file == session.files[0]
    assert "broken.muaavatar" in session.failure
    window.picture()
    session.choose_file(session.files[1])
    assert session.file == session.files[1]
    assert session.failure == ""
    assert session.clip.name == "wave"  # the clip of the same name


def test_plays_round_and_scrubs(window: Driven) -> None:
    session = window.session
    count, rate = len(session.clip), session.clip.rate
    session.playing, session.speed, session.time = True, 1.0, 0.0
    session.advance((count - 0.5) / rate)
    assert session.index == count - 1
    session.advance(1 / rate)
    assert session.index == 0
    session.step(-1)
    assert (session.index, session.playing) == (count - 1, False)
    session.advance(10.0)
    assert session.index == count - 1


def test_draws_two_eyes_beside_each_other(window: Driven) -> None:
    window.session.toggles = Toggles()
    window.session.stereo = True
    window.picture()
    image = window.picture()
    for half in (image[:, : SIZE[0] // 2], image[:, SIZE[0] // 2 :]):
        assert (half != COLOR).any()


@pytest.mark.parametrize(
    "options",
    [
        {"show": "skeleton"},
        {"azimuth": 90.0},
        {"elevation": 50.0},
        {"zoom": 2.0},
        {"look_at": "tip", "zoom": 1.0},
        {"stereo": True},
    ],
)
def test_shows_what_the_options_ask_for(
    device: Device, avatar_files: tuple[Path, ...], options: dict[str, Any]
) -> None:
    shown = []
    for look in (LOOK, look_of(Asked(**options), None)):
        driven = Driven(device, avatar_files, look)
        shown.append(driven.picture()[:, WIDTH + 20 :])
        driven.canvas.close()
    assert (shown[0] != shown[1]).any()


def test_has_the_background_asked_for(device: Device, avatar_files: tuple[Path, ...]) -> None:
    driven = Driven(device, avatar_files, look_of(Asked(background="#204060"), None))
    np.testing.assert_array_equal(driven.picture()[EMPTY][0, 0], [0x20, 0x40, 0x60])
    driven.canvas.close()


def test_says_that_there_is_no_display(avatar_files: tuple[Path, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(InputError, match="a window needs a display and there is none; -o writes an image"):
        show(Source(avatar_files), LOOK)


@pytest.fixture
def display() -> Iterator[str]:
    """A virtual display of this test's own."""
    if shutil.which("Xvfb") is None:
        pytest.skip("needs Xvfb (Debian's xvfb, which tools/setup.sh installs)")
    reader, writer = os.pipe()
    server = subprocess.Popen(
        # -noreset: else it starts anew, and refuses whoever comes meanwhile, each time that its last client leaves
        ["Xvfb", "-displayfd", str(writer), "-screen", "0", "1400x950x24", "-nolisten", "tcp", "-noreset"],
        pass_fds=[writer],
        stderr=subprocess.DEVNULL,
    )
    os.close(writer)
    with os.fdopen(reader) as answer:
        name = f":{answer.readline().strip()}"
    yield name
    server.terminate()
    server.wait()


@pytest.mark.parametrize("options", [[], ["--size", "760x600", "--background", "#204060"]])
def test_opens_a_window_on_a_display(display: str, avatar_files: tuple[Path, ...], options: list[str]) -> None:
    color = (0x20, 0x40, 0x60) if options else COLOR
    covered = 0.15 if options else 0.3  # least share of the screen
    device = ["--device", os.environ["MUA_DEVICE"]] if "MUA_DEVICE" in os.environ else []
    code = "from mua.cli.view import run; run()"
    environment = {**os.environ, "DISPLAY": display}
    environment.pop("WAYLAND_DISPLAY", None)
    child = subprocess.Popen([sys.executable, "-c", code, str(avatar_files[0]), *options, *device], env=environment)
    try:
        deadline = time.monotonic() + DEADLINE
        while True:
            assert child.poll() is None, "the window closed by itself"
            screen = np.asarray(ImageGrab.grab(xdisplay=display))[..., :3]
            background = (screen == color).all(axis=2)
            if background.mean() > covered and background[:150, :WIDTH].mean() < 0.1:  # the panel covers its corner
                break
            assert time.monotonic() < deadline, "no window within the deadline"
            time.sleep(0.2)
    finally:
        child.terminate()
        child.wait()
