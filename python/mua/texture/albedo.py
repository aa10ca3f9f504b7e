"""The base colour and the opacity of each texel, from a character's atlas."""

import numpy as np
from PIL import Image

from mua.arrays import Array


def sample_albedo(
    base_color: Array,  # [S, S, 4] uint8 sRGB, alpha is opacity
    uv: Array,  # [N, 2] v down
    size: int,
) -> Array:
    """Colours and opacities [N, 4] float32 in 0..1, sRGB, at points of the atlas, for `size` x `size` texels.

    Bilinear in an atlas that is first averaged down to no more than twice the texture's own resolution.
    """
    factor = max(base_color.shape[0] // size, 1)
    atlas = np.asarray(Image.fromarray(base_color).reduce(factor), dtype=np.float32) / 255
    height, width = atlas.shape[:2]
    place = np.clip(uv * (width, height) - 0.5, 0, (width - 1, height - 1))
    low = np.floor(place).astype(np.int64)
    column, row = low.T
    right, below = np.minimum(column + 1, width - 1), np.minimum(row + 1, height - 1)
    x, y = (place - low).astype(np.float32).T[..., None]
    top = atlas[row, column] * (1 - x) + atlas[row, right] * x
    bottom = atlas[below, column] * (1 - x) + atlas[below, right] * x
    return np.asarray(top * (1 - y) + bottom * y)
