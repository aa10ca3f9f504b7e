"""Images beside each other in strips under captions, and sheets of such strips."""

from collections.abc import Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from mua.arrays import Array

CAPTION = 22  # pixels
GAIN = 4  # factor by which differences are amplified


def caption(titles: Sequence[str], width: int) -> Array:
    """A white bar [CAPTION, n width, 3] uint8 with a title over each of n images of this width."""
    bar = Image.new("RGB", (len(titles) * width, CAPTION), "white")
    draw = ImageDraw.Draw(bar)
    for i, title in enumerate(titles):
        draw.text((i * width + 6, 4), title, fill="black", font=ImageFont.load_default(12))
    return np.asarray(bar)


def difference(one: Array, other: Array) -> Array:
    """The difference of two images, dark on white; at most 1, may be negative."""
    return np.asarray(1 - GAIN * np.abs(one - other))


def sheet(
    strips: Sequence[Array],  # [h, w, 3] uint8, all of one size
    columns: int,  # strips in a row
) -> Image.Image:
    """All strips, row after row; what is left of the last row is white."""
    height, width = strips[0].shape[:2]
    picture = Image.new("RGB", (columns * width, -(-len(strips) // columns) * height), "white")
    for i, strip in enumerate(strips):
        picture.paste(Image.fromarray(strip), (i % columns * width, i // columns * height))
    return picture
