"""The page with a player that tests of the engine open, and the desktop player's picture of what it shows."""

import base64
import io
import json
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from synthetic_avatar import synthetic_avatar, with_surface
from web.browser import Browser, Page, Serve

from mua.arrays import Array
from mua.asset.write import encode
from mua.avatar.camera import EYE_DISTANCE, Camera, stereo
from mua.gpu import Device
from mua.player.buffers import AvatarBuffers
from mua.player.cpu_image import over
from mua.player.levels import FULL, Levels
from mua.player.offscreen import Offscreen
from mua.player.toggles import Toggles
from mua.player.viewpoint import Viewpoint
from mua.pose.resample import resample
from mua.share.site import player_files

SCREEN = (240, 320)
LEAST_PSNR = 45.0  # dB beside the desktop player's image, both of 8 bits
GREY = (0.5, 0.5, 0.5)
PAGE = f"<!doctype html><body><canvas width={SCREEN[0]} height={SCREEN[1]}></canvas>".encode()
START = """(async () => {
  const { createPlayer } = await import("./player.js");
  globalThis.player = await createPlayer(document.querySelector("canvas"));
  player.playing = false;
  player.level = "full";
  globalThis.faults = [];
  player.onerror = (error) => faults.push(error.message);
})()"""
SPLATS = Toggles()
SHOWN = {
    "splats": Toggles(),
    "shadow": Toggles(shadow=True),
    "geometry": Toggles(splats=False, geometry=True),
    "all": Toggles(geometry=True, template=True, skeleton=True, shadow=True),
}
Open = Callable[..., Page]


@pytest.fixture
def opened(browser: Browser, serve: Serve) -> Iterator[Open]:
    """A page with a player, and files beside it by name; at its end nothing is left in its console."""
    with ExitStack() as stack:

        def begin(*, before: str = "", **files: bytes) -> Page:
            named = {f"{name}.muaavatar": content for name, content in files.items()}
            address = serve({**player_files(), **named, "index.html": PAGE})
            page = stack.enter_context(browser.page(address, before=before))
            stack.callback(lambda: _explained(page))
            page.evaluate(START)
            return page

        yield begin


def _explained(page: Page) -> None:
    reported = page.reported
    assert [line for line in reported["console"] if "404" not in line] == []
    assert reported["errors"] == []


def load(page: Page, source: str = '"a.muaavatar"') -> str:
    """Load an avatar; the sentence that says why not, or nothing."""
    return str(
        page.evaluate(f'player.load({source}).then((a) => {{ globalThis.avatar = a; return ""; }}, (e) => e.message)')
    )


def screenshot(page: Page) -> Array:
    """The image over grey, [H, W, 3] of 0 to 1."""
    straight = transparent(page)
    return np.asarray(straight[..., :3] * straight[..., 3:] + (1 - straight[..., 3:]) * GREY)


def transparent(page: Page) -> Array:
    """The image, [H, W, 4] of 0 to 1."""
    code = """player.screenshot().then((blob) => new Promise((resolve) => {
      const reader = new FileReader();
      reader.onload = () => resolve(reader.result);
      reader.readAsDataURL(blob);
    }))"""
    content = base64.b64decode(page.evaluate(code).split(",")[1])
    return np.asarray(Image.open(io.BytesIO(content)).convert("RGBA")) / 255


def psnr(image: Array, exact: Array) -> float:
    return float(-10 * np.log10(np.maximum(np.mean((image - exact) ** 2), 1e-12)))


def desktop(
    device: Device,
    file: Path,
    page: Page,
    frame: int,
    toggles: Toggles = SPLATS,
    level: str | int = FULL,
    *,
    both: bool = False,
) -> Array:
    """The desktop player's image from where the page's camera is, of both eyes where asked for."""
    buffers = AvatarBuffers(device, file)
    clip = resample(buffers.avatar.clips[0], buffers.avatar.encoding.rate)
    levels = Levels(buffers.avatar, level)
    cameras = stereo(camera_of(page, (SCREEN[0] // 2, SCREEN[1])), EYE_DISTANCE) if both else [camera_of(page)]
    image = Offscreen(device, buffers, clip, toggles, levels=levels).picture(frame, cameras)
    return over(image, GREY) / 255


def camera_of(page: Page, screen: tuple[int, int] = SCREEN) -> Camera:
    at = json.loads(page.evaluate("JSON.stringify(player.camera)"))
    return Viewpoint(np.array(at["target"]), at["distance"], at["azimuth"], at["elevation"]).camera(screen)


def show(page: Page, toggles: Toggles, frame: int, rate: float) -> None:
    page.evaluate(f"Object.assign(player.show, {json.dumps(asdict(toggles))})")
    page.evaluate(f"player.time = {frame / rate}")


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("small") / "a.muaavatar"
    path.write_bytes(encode(with_surface(synthetic_avatar()), storage="i8"))
    return path
