"""What a fragment that computes in half floats, as on mobile devices, does to an image.

Devices at hand compute it in float32 whatever the shader says. So the reference's steps are rounded here one by one, as
splatFragment of ComputeShaders/splat_draw.hlsl makes them.
"""

from collections.abc import Callable

import numpy as np
import pytest
from drawn_scenes import places_in_quad, random_scene

from mua.arrays import Array
from mua.kernels.splat_draw import WEIGHT
from mua.kernels.splat_project import wide_deviations

SCREEN = (48, 40)
COUNT = 1200  # splats: tens lie over each pixel
LARGEST_ERROR = 1 / 255  # in any channel of the image; at most a step of 8 bits


def to_nearest(values: Array) -> Array:
    return np.asarray(values, np.float16).astype(float)


def towards_zero(values: Array) -> Array:
    nearest = np.asarray(values, np.float16)
    over = np.abs(nearest.astype(float)) > np.abs(values)
    return np.where(over, np.nextafter(nearest, np.float16(0)), nearest).astype(float)


def picture(scene: tuple[Array, Array, Array, Array], rounded: Callable[[Array], Array]) -> Array:
    """Premultiplied [H, W, 4], blended in float64."""
    row, column = np.mgrid[: SCREEN[1], : SCREEN[0]] + 0.5
    image = np.zeros((*row.shape, 4))
    for splat in scene[3]:
        ellipse, color = scene[0][splat], scene[1][splat]
        offset = rounded(places_in_quad(ellipse, np.stack([column, row], axis=-1) - ellipse[:2]))
        peak = rounded(scene[2][splat] * WEIGHT * np.prod(ellipse[4:] / wide_deviations(ellipse[4:])))
        window = np.maximum(rounded(1 - rounded(offset * offset)), 0)
        alpha = rounded(rounded(peak * window[..., 0]) * window[..., 1])[..., None]
        shade = np.concatenate([rounded(rounded(color) * alpha), alpha], axis=-1)
        image = image * (1 - alpha) + shade
    return image


@pytest.mark.parametrize("rounded", [to_nearest, towards_zero])
def test_halves_change_a_picture_by_a_step_of_8_bits_at_most(rounded: Callable[[Array], Array]) -> None:
    scene = random_scene(COUNT, SCREEN)
    exact = picture(scene, lambda values: values)
    assert exact[..., 3].mean() > 0.9
    error = np.abs(picture(scene, rounded) - exact).max()
    assert 0 < error <= LARGEST_ERROR, error
