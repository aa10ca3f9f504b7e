"""A whole frame on a device against decode() in float64 on the same stored values: pose to sorted splats.

As a command, `python tests/parity/frame_errors.py FILE ...` prints the errors of files.
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from packed_splats import colors_of, opacities_of, unpacked
from splat_rounding import exact_keys

from mua.arrays import Array
from mua.avatar.camera import EYE_DISTANCE, Camera, orbit, stereo
from mua.avatar.decode import Splats, decode_clip_frame
from mua.gpu import Device, open_device
from mua.kernels.splat_draw import splat_colors
from mua.kernels.splat_project import LAST_KEY
from mua.player.buffers import AvatarBuffers
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame
from mua.pose.clip import Clip
from mua.pose.resample import resample
from mua.rig.bounds import frame_boxes, union
from mua.rig.rig import Rig

VISIBLE_WORD = 4  # its place in `arguments`


@dataclass(frozen=True)
class FrameErrors:
    """Largest errors over splats; the last four are of the splats that some eye sees."""

    position: float  # metres
    color: float  # in one channel, sRGB 0..1
    opacity: float
    key: float  # in 65535ths, beyond half a key: what rounding leaves to the order
    key_bound: float  # what the error of positions and the rounding of depths may leave


class PosedFrame:
    """One frame of a clip, decoded and sorted on a device, and the reference."""

    def __init__(
        self,
        device: Device,
        frame: SplatFrame[AvatarFrame],
        clip: Clip,
        index: int,
        *,
        eyes: int,
        screen: int,
        level: int = 0,
    ) -> None:
        (gpu,) = frame.avatars
        avatar = gpu.avatar.avatar
        window = avatar.encoding.frames(index)
        shown = avatar.at_level(level)
        self.frame, self.exact = frame, decode_clip_frame(shown, clip, frame=index, dtype=np.float64)
        self.cameras = cameras_of(avatar.rig, clip, eyes=eyes, screen=screen)
        self.bounds = self.exact.bounds
        commands = device.commands()
        weights = clip.pose(index).expressions
        gpu.decode(commands, clip.rotations[window], clip.translations[window], level=level, expressions=weights)
        frame.sort(commands, self.cameras)
        commands.submit()
        self.visible = int(frame.arguments.read()[VISIBLE_WORD])
        self.order = frame.order.read()[: self.visible]  # [M]
        self.keys = frame.keys.read(np.uint16)[self.order]  # [M] as sorted

    def errors(self) -> FrameErrors:
        splats = unpacked(self.frame.splats.read())[: len(self.exact.centres)]
        colors, opacities = colors_of(splats)[:, self.order], opacities_of(splats)[self.order]
        position = np.abs(splats["centre"] - self.exact.centres)
        exact, rounding = exact_keys(
            self.exact.centres[self.order], np.stack([camera.view for camera in self.cameras]), self.bounds
        )
        span = np.ptp(exact_depths(self.bounds, self.cameras))
        moved = LAST_KEY * np.linalg.norm(position, axis=1).max(initial=0) / span
        return FrameErrors(
            position=float(position.max(initial=0)),
            color=float(np.abs(colors - exact_colors(self.exact, self.cameras)[:, self.order]).max(initial=0)),
            opacity=float(np.abs(opacities - self.exact.opacities[self.order]).max(initial=0)),
            key=float(np.abs(self.keys - exact).max(initial=0)) - 0.5,
            key_bound=float(rounding + moved),
        )


def cameras_of(rig: Rig, clip: Clip, *, eyes: int, screen: int) -> Sequence[Camera]:
    """One eye or two that see all of the clip."""
    camera = orbit(union(frame_boxes(rig, clip)), screen=(screen, screen), azimuth=0.4, elevation=0.2)
    return (camera,) if eyes == 1 else stereo(camera, EYE_DISTANCE)


def exact_colors(frame: Splats, cameras: Sequence[Camera]) -> Array:
    """Colours [2, N, 3] towards either eye."""
    eyes = cameras[0], cameras[-1]
    return np.stack([splat_colors(frame.centres, frame.texel_dq, frame.sh, eye.position) for eye in eyes])


def exact_depths(bounds: Array, cameras: Sequence[Camera]) -> Array:
    """Depths [8] of the corners of the box, metres, in the eyes' mean."""
    mean = -np.mean([camera.view[2] for camera in cameras], axis=0)
    corners = np.stack(np.meshgrid(*bounds.T)).reshape(3, -1).T
    return np.asarray(corners @ mean[:3] + mean[3])


def main(files: Sequence[str]) -> None:
    """Print the largest errors over five frames of a file's first clip, for one eye and for two."""
    device = open_device()
    print(f"on {device.adapter}")
    for file in files:
        frame = SplatFrame(device, [AvatarFrame(device, AvatarBuffers(device, Path(file)))])
        avatar = frame.avatars[0].avatar.avatar
        clip = resample(avatar.clips[0], avatar.encoding.rate)
        frames = np.linspace(0, len(clip) - 1, 5).astype(int)
        errors = [
            PosedFrame(device, frame, clip, index, eyes=eyes, screen=512).errors()
            for index in frames
            for eyes in (1, 2)
        ]
        worst = {name: max(getattr(e, name) for e in errors) for name in ("position", "color", "opacity", "key")}
        print(
            f"{file}: {frame.splat_count} splats, position {1e3 * worst['position']:.5f} mm, "
            f"colour {worst['color']:.6f} (1/{1 / worst['color']:.0f}), opacity {worst['opacity']:.6f}, "
            f"depth key {worst['key']:.2f} of 65535"
        )


if __name__ == "__main__":
    main(sys.argv[1:])
