"""Averages of images in which what is clear has no colour: weighted by opacity, and carried on past edges."""

import numpy as np
from PIL import Image
from scipy.ndimage import distance_transform_edt

from mua.arrays import Array
from mua.scene import CLEAR

TRACE = 1e-3  # of 255: the weight of clear texels, which decides only where there are no others


def reduced(
    image: Array,  # [h, w, 4] uint8
    factor: int,
) -> Array:
    """The image averaged over squares of `factor` texels, weighted by opacity: [ceil(h / factor), .., 4] uint8."""
    if factor <= 1:
        return image
    if image[..., 3].min() == 255:
        return np.asarray(Image.fromarray(image).reduce(factor))
    opacity = image[..., 3].astype(np.float32)
    weight = _averaged(opacity + TRACE, factor)
    colors = [_averaged(image[..., k] * (opacity + TRACE), factor) / weight for k in range(3)]
    return np.rint(np.dstack([*colors, _averaged(opacity, factor)])).astype(np.uint8)


def bled(
    image: Array,  # [h, w, 4] uint8
) -> Array:
    """The image with each clear texel in the colour of the nearest that is not, and as clear as before."""
    return np.dstack([filled(image[..., :3], image[..., 3] < CLEAR), image[..., 3]])


def filled(
    picture: Array,  # [h, w, c]
    empty: Array,  # [h, w] bool
) -> Array:
    """The image with every empty texel replaced by the nearest that is not."""
    if empty.all() or not empty.any():
        return picture
    rows, columns = distance_transform_edt(empty, return_distances=False, return_indices=True)
    return np.asarray(picture[rows, columns])


def bilinear(
    image: Array,  # [h, w, 4], alpha in 0..255
    rows: tuple[Array, Array],  # [n] above and below
    columns: tuple[Array, Array],  # [n] left and right
    place: Array,  # [n, 2] from the left column (x) and the upper row (y), 0..1
) -> Array:
    """Values [n, 4] float64 between four texels; colours are weighted by opacity."""
    right, down = place.T
    total, colors, opacity = 0.0, 0.0, 0.0
    for row, y in zip(rows, (1 - down, down), strict=True):
        for column, x in zip(columns, (1 - right, right), strict=True):
            texel = image[row, column].astype(np.float64)
            share = (x * y)[:, None]
            weight = share * (texel[:, 3:] + TRACE)
            total, colors, opacity = total + weight, colors + weight * texel[:, :3], opacity + share * texel[:, 3:]
    return np.concatenate([colors / total, np.asarray(opacity)], axis=1)


def _averaged(plane: Array, factor: int) -> Array:
    return np.asarray(Image.fromarray(plane.astype(np.float32)).reduce(factor))
