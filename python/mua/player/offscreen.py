"""Pictures and videos without a window."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import chain
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen
from tempfile import TemporaryFile

import imageio_ffmpeg
import numpy as np

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.camera import Camera
from mua.decode import decode_clip_frame
from mua.errors import InputError
from mua.files import replacing
from mua.gpu import Device
from mua.motion.clip import Clip
from mua.player.buffers import AvatarBuffers
from mua.player.draw import image_format
from mua.player.overlays import ground_height
from mua.player.scene import Scene, Toggles, draw_picture
from mua.player.splats import SplatFrame
from mua.rendering import render_premultiplied, to_bytes

BT709 = "bt709"  # what players take a video for that is larger than television's; the encoder is told the same
ENCODING = (
    *("-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18"),  # visually lossless
    *("-vf", f"scale=out_color_matrix={BT709}:out_range=tv", "-colorspace", BT709),
    *("-color_primaries", BT709, "-color_trc", BT709),
    *("-movflags", "+faststart"),  # a browser may start before it has the whole
)


class Offscreen:
    """Draws frames of one clip of an avatar on a device."""

    def __init__(self, device: Device, avatar: AvatarBuffers, clip: Clip, toggles: Toggles) -> None:
        """`clip` is at the rate of the avatar's encoding. Errors: InputError where the device has too little memory."""
        self._device, self._clip, self._toggles = device, clip, toggles
        self._frame = SplatFrame(device, [avatar])
        (self._avatar,) = self._frame.avatars
        self._scene = Scene(device, self._frame, color_format=image_format(device))
        self._ground = ground_height(avatar.avatar.rig, clip)

    def picture(
        self,
        index: int,  # frame of the clip
        cameras: Sequence[Camera],  # of one eye or two
    ) -> Array:
        """Premultiplied sRGB and alpha [H, E W, 4] of one frame, eyes side by side."""
        window = self._avatar.avatar.avatar.encoding.frames(index)
        rotations, translations = self._clip.rotations[window], self._clip.translations[window]
        commands = self._device.commands()
        self._avatar.decode(commands, rotations, translations)
        self._frame.sort(commands, cameras)
        commands.submit()
        self._scene.pose(rotations[0], translations[0], ground=self._ground)
        return draw_picture(self._device, self._scene, cameras, self._toggles)


def reference_picture(
    avatar: Avatar,
    clip: Clip,  # at the rate of the avatar's encoding
    index: int,
    cameras: Sequence[Camera],
) -> Array:
    """The splats of the same picture by the CPU reference; each eye sees its own colours."""
    frame = decode_clip_frame(avatar, clip, frame=index)
    return np.hstack([render_premultiplied(frame, camera) for camera in cameras])


def over(
    image: Array,  # [H, W, 4] premultiplied sRGB and alpha
    background: tuple[float, float, float],  # sRGB, 0..1
) -> Array:
    """The image over a plain background, [H, W, 3] uint8."""
    return to_bytes(image[..., :3] + (1 - image[..., 3:]) * np.array(background))


def write_video(
    path: Path,
    pictures: Iterator[Array],  # [H, W, 3] uint8, at least one; H and W even
    *,
    rate: float,  # pictures per second
) -> None:
    """Write an MP4 (H.264), all of it or none.

    Errors: InputError where the encoder stops, with what it said.
    """
    first = next(pictures)
    size = f"{first.shape[1]}x{first.shape[0]}"
    source = ("-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", str(rate), "-i", "-")
    with replacing(path) as temporary, TemporaryFile() as said:
        command = [imageio_ffmpeg.get_ffmpeg_exe(), "-y", "-v", "error", *source, *ENCODING, str(temporary)]
        encoder = Popen(command, stdin=PIPE, stdout=DEVNULL, stderr=said)
        with suppress(BrokenPipeError), encoder:  # it may stop, and has then said why
            assert encoder.stdin is not None  # as asked for
            for picture in chain([first], pictures):
                encoder.stdin.write(picture.tobytes())
        if encoder.returncode:
            said.seek(0)
            raise InputError(f"{path}: the encoder stopped: {' '.join(said.read().decode().split())}")
