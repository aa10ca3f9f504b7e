"""A capture without cameras or Blender: an avatar's clips, drawn from a ring of cameras by the reference renderer."""

from pathlib import Path

import numpy as np
from PIL import Image
from virtual_studio import ring

import mua
from mua.arrays import Array
from mua.avatar.decode import Splats
from mua.avatar.rendering import render_premultiplied, to_bytes
from mua.capture import Capture, CaptureCamera, CaptureClip, write_capture
from mua.export.bvh import bvh_text

CAMERAS, HELD_OUT_CAMERAS = 4, 1
STRIDE = 6  # frames of the avatar's clip from one filmed frame to the next
IMAGES = "images/{clip}/{camera}/{frame:06d}.png"


def film(
    avatar_path: Path,
    template: Path,  # the avatar's mesh as .glb
    folder: Path,
    *,
    clips: dict[str, bool],  # by name, whether it is held out
    frames: int,  # of each
    side: int,  # of the square images, pixels
) -> None:
    """Write a capture to an empty folder; alpha is the mask."""
    avatar = mua.load(avatar_path)
    motions = {clip.name: clip.cut(np.arange(frames) * STRIDE) for clip in avatar.clips if clip.name in clips}
    shown = {name: [avatar.decode(name, STRIDE * i) for i in range(frames)] for name in motions}
    points = np.concatenate([splats.centres for filmed in shown.values() for splats in filmed])
    cameras = ring(points, cameras=CAMERAS, held_out=HELD_OUT_CAMERAS, size=side, rng=np.random.default_rng(0))
    capture = Capture(
        folder=folder,
        name=avatar.name,
        rate=next(iter(motions.values())).rate,
        template=template,
        cameras=cameras,
        clips=tuple(
            CaptureClip(name, folder / f"{name}.bvh", 0, frames, held_out=held) for name, held in clips.items()
        ),
        images=IMAGES,
    )
    for name, motion in motions.items():
        (folder / f"{name}.bvh").write_text(bvh_text(avatar.rig.skeleton, motion))
        for camera in cameras:
            for frame, splats in enumerate(shown[name]):
                place = capture.place(IMAGES, clip=name, camera=camera.name, frame=frame)
                place.parent.mkdir(parents=True, exist_ok=True)
                Image.fromarray(drawn(splats, camera)).save(place)
    write_capture(capture)


def drawn(splats: Splats, camera: CaptureCamera) -> Array:
    """An image [H, W, 4] uint8, its colours not premultiplied."""
    image = render_premultiplied(splats, camera.camera())
    color = image[..., :3] / np.maximum(image[..., 3:], 1 / 255)
    return to_bytes(np.concatenate([color, image[..., 3:]], axis=-1))
