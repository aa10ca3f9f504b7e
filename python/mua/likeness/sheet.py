"""The pictures of a likeness in one: source, splats and their difference side by side."""

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from mua.arrays import Array
from mua.likeness.compare import Likeness, PoseLikeness, Shot
from mua.render import to_bytes

GAIN = 4  # the difference is shown this many times as strong
CAPTION = 22  # pixels
COLUMNS = 2  # views beside each other
MARK = 14  # pixels from the middle of the worst place to the frame around it


def likeness_sheet(likeness: Likeness) -> Image.Image:
    """Three cells for every view of every pose; a frame marks the worst place of each view."""
    rows = strips(likeness)
    rows += [np.full_like(rows[0], 255)] * (-len(rows) % COLUMNS)
    return Image.fromarray(np.vstack([np.hstack(rows[i : i + COLUMNS]) for i in range(0, len(rows), COLUMNS)]))


def strips(likeness: Likeness) -> list[Array]:
    """For each view, source, splats and difference [h, 3 w, 3] uint8 under a caption."""
    return [_strip(pose, shot) for pose in likeness.poses for shot in pose.shots]


def _strip(pose: PoseLikeness, shot: Shot) -> Array:
    shown = [image[..., :3] + 1 - image[..., 3:] for image in (shot.source, shot.splats)]
    difference = 1 - GAIN * np.abs(np.clip(shown[0], 0, 1) - np.clip(shown[1], 0, 1))
    picture = Image.fromarray(np.hstack([to_bytes(image) for image in (*shown, difference)]))
    width = shot.source.shape[1]
    draw = ImageDraw.Draw(picture)
    column, row = shot.place
    for cell in range(3):
        middle = column + cell * width
        draw.rectangle((middle - MARK, row - MARK, middle + MARK, row + MARK), outline="red")
    found = shot.agreement
    titles = (
        f"source: {pose.pose}, {shot.view}",
        f"splats: overlap {100 * found.iou:.1f} %, {found.psnr:.1f} dB",
        f"difference x{GAIN}; frame: worst, at {shot.joint}",
    )
    return np.vstack([_caption(titles, width), np.asarray(picture)])


def _caption(titles: tuple[str, ...], width: int) -> Array:
    bar = Image.new("RGB", (len(titles) * width, CAPTION), "white")
    draw = ImageDraw.Draw(bar)
    font = ImageFont.load_default(12)
    for i, title in enumerate(titles):
        draw.text((i * width + 6, 4), title, fill="black", font=font)
    return np.asarray(bar)
