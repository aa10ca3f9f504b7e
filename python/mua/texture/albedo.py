"""The base colour and the opacity of each texel, from a character's atlas."""

import numpy as np

from mua.arrays import Array
from mua.atlas.filtering import bilinear, bled, reduced

FINER = 2  # points along a texel, at which images are looked at that are finer than texels


def sample_albedo(
    base_color: Array,  # [S, S, 4] uint8 sRGB, alpha is opacity
    uv: Array,  # [N, 2] v down
    size: int,
) -> Array:
    """Colours and opacities [N, 4] float32 in 0..1, sRGB, at points of the atlas, for `size` x `size` texels.

    Bilinear in an atlas that is first averaged down to no more than twice the texture's own resolution; a colour that
    is clear mixes into none.
    """
    factor = max(base_color.shape[0] // size, 1)
    atlas = bled(reduced(base_color, factor))
    height, width = atlas.shape[:2]
    place = np.clip(uv * (width, height) - 0.5, 0, (width - 1, height - 1))
    low = np.floor(place).astype(np.int64)
    column, row = low.T
    rows, columns = (row, np.minimum(row + 1, height - 1)), (column, np.minimum(column + 1, width - 1))
    return (bilinear(atlas, rows, columns, place - low) / 255).astype(np.float32)


def finer_picture(
    base_color: Array,  # [S, S, 4] uint8 sRGB, alpha is opacity
    size: int,
) -> Array:
    """Colours and opacities at FINER x FINER points of each of `size` x `size` texels: [FINER size, FINER size, 4]."""
    points = (np.arange(size * FINER) + 0.5) / (size * FINER)
    uv = np.stack(np.meshgrid(points, points), axis=-1).reshape(-1, 2)
    return sample_albedo(base_color, uv, size * FINER).reshape(size * FINER, size * FINER, 4)
