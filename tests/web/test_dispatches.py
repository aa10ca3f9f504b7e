"""The browser player makes the desktop player's dispatches: the same kernels, groups, constants and buffers."""

import json
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar, with_expressions
from web.test_modules import SECONDS, pytestmark

from mua import rotation
from mua.asset import write
from mua.avatar.camera import Camera, orbit, perspective, stereo
from mua.avatar.coarser import coarsest
from mua.gpu import Buffer, Commands, Device, open_device
from mua.gpu.kernel import Kernel
from mua.player.buffers import AvatarBuffers
from mua.player.draw import view_projection
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame
from mua.pose.resample import resample
from mua.rig.bounds import root_positions

__all__ = ["pytestmark"]  # skips where Node is missing

HERE = Path(__file__).parent
ROUNDING = 1e-5  # of poses in single precision, relative to a figure of a metre


class Noted(Commands):
    """Notes dispatches in place of running them; buffers are numbered as they are first bound."""

    def __init__(self, device: Device) -> None:
        self.made: list[dict[str, Any]] = []
        self._known: dict[int, int] = {}

    def dispatch(
        self, kernel: Kernel, groups: tuple[int, int, int], buffers: Mapping[str, Buffer], **constants: Any
    ) -> None:
        bound = {name: self._known.setdefault(id(buffer), len(self._known)) for name, buffer in buffers.items()}
        self.made.append({"entry": kernel.name, "groups": list(groups), "bound": bound, "given": constants})


def desktop(device: Device, file: Path, cameras: Sequence[Camera]) -> list[dict[str, Any]]:
    """What dispatches.mjs does, by the desktop player."""
    buffers, commands = AvatarBuffers(device, file), Noted(device)
    avatar = buffers.avatar
    clip = resample(avatar.clips[0], avatar.encoding.rate)
    windows = [clip.cut(np.maximum(index - np.arange(avatar.encoding.window), 0)) for index in (1, 2)]
    (first, then), aside = windows, rotation.dual_from_rigid(np.array([1.0, 0, 0, 0]), np.array([0.5, 0, -1]))
    frame = AvatarFrame(device, buffers)
    splats = SplatFrame(device, [frame])
    weights = [None if window.expressions is None else window.expressions[0] for window in windows]
    frame.decode(commands, first.rotations, first.translations, aside, expressions=weights[0])
    splats.sort(commands, cameras[:1])
    frame.begin(then.rotations, then.translations, weights[1], level=coarsest(avatar))
    while frame.parts_left:
        frame.advance(commands)
    frame.show()
    frame.repose(commands, then.rotations[0], then.translations[0])
    splats.sort(commands, cameras)
    return commands.made


def browser(file: Path, cameras: Sequence[Camera]) -> list[dict[str, Any]]:
    eyes = [
        {
            "view": camera.view.ravel().tolist(),
            "projection": camera.projection.ravel().tolist(),
            "viewProjection": view_projection(camera).ravel().tolist(),
            "position": camera.position.tolist(),
            "screen": list(camera.screen),
            "near": camera.near,
        }
        for camera in cameras
    ]
    line = ["node", "--no-warnings", str(HERE / "dispatches.mjs"), str(file), json.dumps(eyes)]
    ran = subprocess.run(line, capture_output=True, text=True, check=False, timeout=SECONDS)
    assert ran.returncode == 0, ran.stderr
    return [json.loads(one) for one in ran.stdout.splitlines()]


@pytest.mark.parametrize("change", [lambda avatar: avatar, with_expressions], ids=["body", "face"])
@pytest.mark.parametrize("storage", ["f16", "i8"])
def test_the_browser_makes_the_desktops_dispatches(tmp_path: Path, change: Any, storage: Any) -> None:
    avatar, file = change(synthetic_avatar()), tmp_path / "a.muaavatar"
    write(file, avatar, storage=storage)
    box = avatar.bounds + root_positions(avatar.rig, avatar.clips[0])[0]
    nearer = perspective(0.6, aspect=96 / 64, near=0.005)  # as for a small figure
    camera = replace(orbit(box, screen=(96, 64), azimuth=0.4), projection=nearer)
    cameras = stereo(camera, 0.063)
    device = open_device(None)
    expected, found = desktop(device, file, cameras), browser(file, cameras)
    device.close()
    assert [one["entry"] for one in found] == [one["entry"] for one in expected]
    for own, theirs in zip(found, expected, strict=True):
        assert own["groups"] == theirs["groups"], own["entry"]
        for name, value in own["given"].items():
            if name in theirs["given"]:
                wanted = np.ravel(theirs["given"][name])
                np.testing.assert_allclose(np.ravel(value), wanted, atol=ROUNDING, err_msg=f"{own['entry']} {name}")
    assert renumbered(found) == renumbered(expected)


def renumbered(dispatches: list[dict[str, Any]]) -> list[dict[str, int]]:
    """Which buffers are the same, whatever the order in which a dispatch names its own."""
    known: dict[int, int] = {}
    pairs = [sorted(one["bound"].items()) for one in dispatches]
    return [{name: known.setdefault(buffer, len(known)) for name, buffer in bound} for bound in pairs]
