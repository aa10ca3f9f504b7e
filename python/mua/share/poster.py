"""An avatar's first view: which side is its front, and the image shown until a browser has drawn it."""

from contextlib import closing
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.avatar.camera import FILL, Camera, orbit
from mua.motion.facing import front_of
from mua.player.cpu_image import Reference, over
from mua.player.motion import named_clip, player_clips
from mua.player.toggles import Toggles
from mua.pose.clip import Clip
from mua.rig.bounds import root_positions

HEIGHT, WIDEST = 960, 1920  # pixels


def opening(file: Path, name: str | None) -> tuple[Avatar, Clip]:
    """An avatar and the clip that it begins with: the first if no name is given.

    Errors: InputError where the file is damaged or holds no such clip.
    """
    avatar = read(file)
    clips, _ = player_clips(avatar, file, motion=None, mapping=None)
    return avatar, named_clip(clips, name, source=file)


def front(avatar: Avatar, clip: Clip) -> float:
    """Azimuth of the figure's front in the first frame of a clip, degrees."""
    return float(np.degrees(front_of(avatar.rig.skeleton, clip.rotations[0], clip.translations[0])))


def poster(
    file: Path,
    avatar: Avatar,
    clip: Clip,
    *,
    reference: bool,  # computed on the CPU with numpy
) -> bytes:
    """The first frame of a clip as a PNG with a transparent background, drawn by the desktop player.

    Errors: InputError where there is no graphics device, or it has too little memory.
    """
    camera = view(avatar, clip)
    pixels = Reference(avatar, clip).picture(0, [camera]) if reference else _drawn(file, clip, camera)
    out = BytesIO()
    Image.fromarray(over(pixels, None)).save(out, "PNG", optimize=True)
    return out.getvalue()


def view(avatar: Avatar, clip: Clip) -> Camera:
    """The camera of the page's first frame, on a screen that the figure's box fills in width and height.

    Fitted into a page of any shape, the image shows the figure as large as the page does.
    """
    first = clip.cut(np.array([0]))
    box = avatar.bounds + root_positions(avatar.rig, first)[0]
    azimuth = front_of(avatar.rig.skeleton, clip.rotations[0], clip.translations[0])
    wide = orbit(box, screen=(WIDEST, HEIGHT), azimuth=azimuth)
    corners = np.array(np.meshgrid(*np.transpose(box), [1.0])).reshape(4, -1)
    x, _, _, w = wide.projection @ wide.view @ corners
    width = max(round(WIDEST * float(np.abs(x / w).max()) / FILL), 1)
    return orbit(box, screen=(width, HEIGHT), azimuth=azimuth)


def _drawn(file: Path, clip: Clip, camera: Camera) -> Array:
    from mua.gpu import open_device  # imported here, because the CPU needs no device
    from mua.player.buffers import AvatarBuffers
    from mua.player.offscreen import Offscreen

    with closing(open_device(None)) as device:
        return Offscreen(device, AvatarBuffers(device, file), clip, Toggles()).picture(0, [camera])
