"""Every option of mua-view shows in the window, the file or the page that the command line opens."""

import json
import socket
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from http.server import ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import Any

import imageio_ffmpeg
import numpy as np
import pytest
from bvh_files import BVH
from commands import Commands
from PIL import Image
from rendercanvas.offscreen import RenderCanvas
from vmc_senders import bundle

import mua.gpu
from mua.arrays import Array
from mua.errors import InputError
from mua.live.live_pose import EASING
from mua.live.receiver import LOOPBACK, Address, Receiver
from mua.player import viewer, window
from mua.player.panel import WIDTH
from mua.player.session import Session

SIZE = ("--size", f"{2 * WIDTH + 160}x160")  # the figure in the middle, beside the panel
REST = ("--frame", "3")


@dataclass
class Opened:
    """A window as it is first seen."""

    size: tuple[int, int]  # logical pixels
    session: Session
    picture: Array  # [H, W, 3], beside the panel
    devices: list[str | None]  # asked for


@pytest.fixture
def opened(
    command: Commands, avatar_files: tuple[Path, ...], device: mua.gpu.Device, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[..., Opened]]:
    """Runs the command line with a canvas in place of the screen."""
    canvases: list[RenderCanvas] = []

    def run(*options: str) -> Opened:
        found: dict[str, Any] = {"devices": []}

        class Kept(viewer.Viewer):
            def __init__(self, *given: Any) -> None:
                super().__init__(*given)
                found["session"] = self.session

        class Loop:
            def run(self) -> None:
                found["picture"] = np.asarray(canvases[-1].draw())[:, WIDTH:, :3].copy()

        def open_canvas(size: tuple[int, int]) -> tuple[RenderCanvas, Loop]:
            found["size"] = size
            canvases.append(RenderCanvas(size=size))
            return canvases[-1], Loop()

        def open_device(name: str | None) -> object:
            found["devices"].append(name)
            return device

        monkeypatch.setattr(mua.gpu, "open_device", open_device)
        monkeypatch.setattr(viewer, "Viewer", Kept)
        monkeypatch.setattr(window, "require_display", lambda: None)
        monkeypatch.setattr(window, "_open_canvas", open_canvas)
        ended = command("view", avatar_files[1], *options)
        assert ended.status == 0, ended.err
        return Opened(**found)

    yield run
    for canvas in canvases:
        canvas.close()


@pytest.fixture
def motion(tmp_path: Path) -> Path:
    """Motion of two joints, and mappings of the second to either joint of the avatar."""
    (tmp_path / "nod.bvh").write_text(BVH.replace("spine", "thing"))
    for joint in ("middle", "tip"):
        (tmp_path / f"{joint}.json").write_text(json.dumps({"root": "hips", joint: "thing"}))
    return tmp_path / "nod.bvh"


@pytest.mark.parametrize(
    ("options", "beside"),
    [
        (("--azimuth", "90"), ()),
        (("--elevation", "50"), ()),
        (("--zoom", "2"), ()),
        (("--look-at", "tip", "--zoom", "1"), ()),
        (("--background", "#204060"), ()),
        (("--show", "skeleton"), ()),
        (("--level", "8"), ()),
        (("--expressions", "jawOpen=1"), ()),
        (("--stereo",), ()),
        (("--ipd", "0.5"), ("--stereo",)),
        (("--frame", "6"), ()),
    ],
    ids=lambda value: value[0] if value else "",
)
def test_a_window_looks_otherwise(opened: Callable[..., Opened], options: tuple[str, ...], beside: tuple[str]) -> None:
    plain, chosen = opened(*SIZE, *REST, *beside), opened(*SIZE, *REST, *beside, *options)
    assert plain.picture.shape != chosen.picture.shape or (plain.picture != chosen.picture).any()


def test_a_window_is_as_large_as_asked_for_and_twice_as_wide_with_two_eyes(opened: Callable[..., Opened]) -> None:
    assert opened("--size", "300x200").size == (300, 200)
    assert opened("--size", "300x200", "--stereo").size == (600, 200)


def test_two_eyes_share_the_width_of_a_window(opened: Callable[..., Opened]) -> None:
    """The right one, beside the panel, has all of the figure in its middle."""
    right = opened("--size", f"{WIDTH}x160", "--stereo", "--show", "splats", "--no-follow", *REST).picture
    assert right.shape == (160, WIDTH, 3)
    columns = np.flatnonzero((right != right[0, 0]).any(axis=(0, 2)))
    assert 0 < columns.min() < columns.max() < WIDTH - 1
    assert abs(columns.mean() - WIDTH / 2) < WIDTH / 20


def test_a_window_plays_the_clip_asked_for(opened: Callable[..., Opened]) -> None:
    assert opened(*SIZE).session.clip.name == "wave"
    assert opened(*SIZE, "--clip", "twice").session.clip.name == "twice"
    resting = opened(*SIZE, "--clip", "twice", "--frame", "9").session
    assert (resting.index, resting.playing) == (9, False)


def test_a_window_goes_round_and_follows_as_asked_for(opened: Callable[..., Opened]) -> None:
    turning = opened(*SIZE, "--orbit", "90", "--follow").session
    assert turning.turning == pytest.approx(np.pi / 2)
    assert turning.follow
    assert not opened(*SIZE, "--no-follow").session.follow


def moved(session: Session) -> list[str]:
    """The joints that the clip turns."""
    turned = np.abs(session.clip.rotations - session.clip.rotations[:1]).max(axis=(0, 2)) > 1e-6
    return [name for name, turns in zip(session._stage.rig.skeleton.names, turned, strict=True) if turns]


@pytest.mark.parametrize("joint", ["middle", "tip"])
def test_a_window_plays_motion_of_another_file_on_the_joints_of_the_mapping(
    opened: Callable[..., Opened], motion: Path, joint: str
) -> None:
    session = opened(*SIZE, "--motion", str(motion), "--mapping", str(motion.with_name(f"{joint}.json"))).session
    assert (session.clip.name, moved(session)) == ("nod", [joint])


def test_a_window_shows_what_another_program_sends(
    opened: Callable[..., Opened], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By default it listens on the loopback address; another one is asked for."""
    heard: list[Address] = []
    turned = bundle(
        ("/VMC/Ext/Bone/Pos", "Head", 0.0, 0.1, 0.0, 0.0, 0.6, 0.0, 0.8),
        ("/VMC/Ext/Blend/Val", "Joy", 0.5),
        ("/VMC/Ext/Blend/Apply",),
    )

    class Heard(Receiver):
        """Hears a program for as long as it is open."""

        def __init__(self, address: Address) -> None:
            super().__init__(Address(0, address.host))
            heard.append(address)
            self.program = Thread(target=self.send, daemon=True)
            self.program.start()

        def send(self) -> None:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as program:
                while self._open:
                    program.sendto(turned, (LOOPBACK, self.address.port))
                    time.sleep(0.01)

        def close(self) -> None:
            super().close()
            self.program.join()

    monkeypatch.setattr("mua.cli.listening.Receiver", Heard)
    mapping = tmp_path / "mapping.json"
    mapping.write_text(json.dumps({"root": "Hips", "tip": "Head"}))
    live = opened(*SIZE, "--listen", "39539", "--mapping", str(mapping)).session
    assert heard == [Address(39539)]
    assert live.live is not None
    assert live.live.arrived is not None
    live.live.advance(live.live.arrived + 1.5 * EASING)
    assert live.live.now.expressions == {"Joy": 0.5}
    turned = np.abs(live._pose_shown.rotations - live.clip.rotations[0]).max(axis=1) > 0.1
    assert [name for name, turns in zip(live._stage.rig.skeleton.names, turned, strict=True) if turns] == ["tip"]
    live.choose_clip(live.clips[1])
    assert (live.live, live.clip.name) == (None, "wave")
    opened(*SIZE, "--listen", "0.0.0.0:39540", "--mapping", str(mapping))
    assert heard[1:] == [Address(39540, "0.0.0.0")]


def test_a_window_is_drawn_by_the_device_asked_for(opened: Callable[..., Opened]) -> None:
    assert opened(*SIZE, "--device", "one of mine").devices == ["one of mine"]


def image(command: Commands, file: Path, *options: object) -> Array:
    output = file.with_name("v.png")
    ended = command("view", file, "-o", output, "--size", "32x48", *options)
    assert ended.status == 0, ended.err
    with Image.open(output) as picture:
        return np.asarray(picture).copy()


def test_a_file_shows_the_clip_level_motion_and_mapping_asked_for(
    command: Commands, avatar_files: tuple[Path, ...], motion: Path
) -> None:
    nod = ("--motion", motion, "--frame", 4, "--mapping")
    pictures = [
        image(command, avatar_files[1], *options)
        for options in (
            ("--frame", 3),
            ("--frame", 3, "--level", "8"),
            ("--frame", 3, "--expressions", "jawOpen=1,Mund auf=0.5"),
            (*nod, motion.with_name("tip.json")),
            (*nod, motion.with_name("middle.json")),
        )
    ]
    assert len({picture.tobytes() for picture in pictures}) == len(pictures)
    again = image(command, avatar_files[1], "--clip", "twice", "--frame", 10)
    np.testing.assert_array_equal(again, pictures[0])  # the clip twice over has no 10th frame but there


def test_a_face_of_another_file_plays_beside_the_body(
    command: Commands, avatar_files: tuple[Path, ...], tmp_path: Path, opened: Callable[..., Opened]
) -> None:
    face = tmp_path / "speech.csv"
    rows = [f"00:00:00:{frame:02}.000,61,{frame / 20}" for frame in range(20)]
    face.write_text("\n".join(["Timecode,BlendShapeCount,JawOpen", *rows]))
    plain, speaking = (image(command, avatar_files[1], "--frame", 6, *more) for more in ((), ("--face", face)))
    assert (plain != speaking).any()
    held = opened(*SIZE, "--frame", "6", "--face", str(face)).session.expressions
    assert 0 < held["jawOpen"] < 1
    assert not any(weight for name, weight in held.items() if name != "jawOpen")


def test_a_file_is_drawn_by_the_device_asked_for(
    command: Commands, avatar_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str | None] = []
    open_device = mua.gpu.open_device

    def keep(name: str | None) -> object:
        asked.append(name)
        return open_device(None)

    monkeypatch.setattr(mua.gpu, "open_device", keep)
    image(command, avatar_file, "--device", "one of mine")
    assert asked == ["one of mine"]


@pytest.mark.parametrize("name", ["view", "share"])
def test_the_reference_draws_without_a_device(
    command: Commands, avatar_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    def none(_: str | None) -> None:
        raise InputError("no device")

    monkeypatch.setattr(mua.gpu, "open_device", none)
    monkeypatch.setattr("mua.share.poster.HEIGHT", 32)
    asked = (avatar_file, "-o", tmp_path / ("v.png" if name == "view" else "site"))
    assert command(name, *asked, "--reference").status == 0
    assert command(name, *asked).sentence == "error: no device"


def test_videos_last_as_long_as_the_motion_and_turntables_as_their_turn(command: Commands, avatar_file: Path) -> None:
    for name, options, seconds in (("v.mp4", (), 7 / 24), ("t.mp4", ("--turntable", "--orbit", "180"), 2.0)):
        output = avatar_file.with_name(name)
        assert command("view", avatar_file, "-o", output, "--size", "16", *options).status == 0
        assert imageio_ffmpeg.count_frames_and_secs(str(output))[1] == pytest.approx(seconds, abs=0.02)


@pytest.mark.parametrize("opens", [True, False])
def test_a_page_opens_in_a_browser_unless_asked_not_to(
    command: Commands, avatar_file: Path, monkeypatch: pytest.MonkeyPatch, opens: bool
) -> None:
    seen: list[str] = []

    def interrupted(_: ThreadingHTTPServer) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(ThreadingHTTPServer, "serve_forever", interrupted)
    monkeypatch.setattr("webbrowser.open", seen.append)
    ended = command("view", avatar_file, "--web", *([] if opens else ["--no-open"]))
    assert ended.status == 0
    assert len(seen) == opens
    assert all(address in ended.out for address in seen)
