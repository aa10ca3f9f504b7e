"""The background of a figure's images: white, or grey for a figure that is itself white."""

from collections.abc import Iterable

import numpy as np

from mua.arrays import Array

WHITE, GREY = 1.0, 0.55
NEAR_WHITE = 0.85  # in each channel; paler colours hardly show on white
MOSTLY = 0.5  # share of the figure's pixels


def background_for(
    images: Iterable[Array],  # [H, W, 4] premultiplied sRGB and alpha
) -> float:
    """The grey in 0..1 on which a figure stands out in all of its images."""
    covered = pale = 0
    for image in images:
        figure = image[image[..., 3] > 0.5]
        covered += len(figure)
        pale += int(np.count_nonzero(figure[:, :3].min(axis=1) > NEAR_WHITE * figure[:, 3]))
    return GREY if pale > MOSTLY * max(covered, 1) else WHITE


def over(
    image: Array,  # [..., 4] premultiplied sRGB and alpha
    background: float,
) -> Array:
    """The image [..., 3] in 0..1 over a plain background."""
    return np.asarray(np.clip(image[..., :3] + background * (1 - image[..., 3:]), 0, 1))
