"""A posed avatar to an image, by the reference kernels on the CPU.

Colours are display-referred, as in 3D Gaussian Splatting: sRGB values are blended, so an image needs no transfer
function before it is written as 8 bits.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.camera import Camera
from mua.decode import Frame, box_of
from mua.kernels.dq_skinning import covariances
from mua.kernels.splat_draw import splat_colors, splat_draw
from mua.kernels.splat_project import splat_project
from mua.kernels.splat_sort import splat_sort

WHITE = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Projected:
    """M splats on the screen of one camera."""

    ellipses: Array  # [M, 6] (mua.kernels.splat_project)
    colors: Array  # [M, 3] sRGB
    opacities: Array  # [M]
    order: Array  # [M] back to front


def render(
    frame: Frame,
    camera: Camera,
    *,
    background: tuple[float, float, float] = WHITE,  # sRGB, 0..1
) -> Array:
    """The image [H, W, 3] over a plain background, sRGB, float64, not below 0; above 1 where the SH says so."""
    image = render_premultiplied(frame, camera)
    return np.asarray(image[..., :3] + (1 - image[..., 3:]) * np.array(background))


def render_premultiplied(
    frame: Frame,
    camera: Camera,
    *,
    encode: Callable[[Array], Array] = np.asarray,  # of the splats' sRGB [M, 3] to what is blended
) -> Array:
    """Premultiplied sRGB, or what `encode` makes of it, and alpha [H, W, 4], float64."""
    splats = projected(frame, camera)
    return splat_draw(splats.ellipses, encode(splats.colors), splats.opacities, splats.order, screen=camera.screen)


def projected(frame: Frame, camera: Camera) -> Projected:
    """The splats that a camera sees, ready to be drawn."""
    splats, keys, ellipses = splat_project(
        frame.centres,
        covariances(frame.rotations, frame.scales),
        frame.opacities,
        camera.view[None],
        camera.projection[None],
        screen=camera.screen,
        near=camera.near,
        bounds=frame.bounds,
    )
    colors = splat_colors(frame.centres[splats], frame.texel_dq[splats], frame.sh[splats], camera.position)
    return Projected(ellipses[0], colors, frame.opacities[splats], splat_sort(keys))


def frame_bounds(frame: Frame) -> Array:
    """Lowest and highest corner [2, 3] of the splat centres, metres; zeros where there are none."""
    return box_of(frame.centres)


def to_bytes(image: Array) -> Array:
    """sRGB in 0..1 to 8 bits."""
    return (np.clip(image, 0, 1) * 255 + 0.5).astype(np.uint8)
