"""Draw sorted splats: a quad each, a window for the Gaussian over every pixel, degree-1 SH colour, blended by depth.

The window (1 - u^2) (1 - v^2) has the Gaussian's integral and ends at REACH deviations: its quad has a third of the
area on which the Gaussian is above LEAST_OPACITY. (u, v) is the pixel's offset turned back by the symmetric root of the
covariance, which changes little where the covariance does, also of round ellipses, whose axes may lie anywhere. To its
variance that of the pixel's unit square is added, 1/12 along any line. One splat is off by up to 0.14 of its opacity;
where splats lie over one another, what one lacks its neighbours have.

Colours are display-referred, as in 3D Gaussian Splatting: sRGB values are blended, and no transfer function is applied.
"""

from collections.abc import Iterator

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.channels import SH_C0, SH_C1
from mua.kernels.splat_project import REACH, half_extents, wide_deviations

WEIGHT = 9 * np.pi / 8 / REACH**2  # the window's middle: the Gaussian's integral, 2 pi, over (4 / 3 REACH)^2
BAND_PIXELS = 1 << 16  # pixels drawn together, so that their indices sort as 16-bit numbers
CHUNK_PAIRS = 1 << 20  # (splat, pixel) pairs held at once


def splat_colors(
    centres: Array,  # [N, 3] world, metres
    texel_dq: Array,  # [N, 8]; its real part is R_tex
    sh: Array,  # [N, 12] coefficient-major (coefficient, rgb), canonical space
    camera: Array,  # [3] world position, metres
) -> Array:
    """Colours [N, 3] >= 0 towards the camera: SH in the view direction, rotated back by R_tex."""
    direction = centres - camera.astype(centres.dtype)
    direction = direction / np.maximum(np.linalg.norm(direction, axis=1, keepdims=True), np.finfo(centres.dtype).tiny)
    x, y, z = rotation.rotate(rotation.conjugate(texel_dq[:, :4]), direction).T[:, :, None]
    c0, c1, c2, c3 = sh.reshape(-1, 4, 3).swapaxes(0, 1)
    return np.asarray(np.maximum(0.5 + SH_C0 * c0 + SH_C1 * (-y * c1 + z * c2 - x * c3), 0))


def pixel_share(
    offsets: Array,  # [..., 2] pixel centre minus ellipse centre (columns, rows), pixels
    ellipses: Array,  # [..., 6] (mua.kernels.splat_project)
) -> Array:
    """Share [...] of its opacity that a splat has at a pixel, 0 outside its quad.

    It stands for the integral over the pixel's square of the Gaussian that is 1 in the ellipse's middle.
    """
    axis, deviations = ellipses[..., 2:4], ellipses[..., 4:6]
    wide = wide_deviations(deviations)
    major, minor = wide[..., :1], wide[..., 1:]
    along = np.sum(axis * offsets, axis=-1, keepdims=True)
    place = (offsets / minor + (1 / major - 1 / minor) * along * axis) / REACH  # (u, v)
    window = np.prod(1 - np.minimum(place * place, 1), axis=-1)
    return np.asarray(ellipses.dtype.type(WEIGHT) * np.prod(deviations / wide, axis=-1) * window)


def splat_draw(
    ellipses: Array,  # [M, 6] of one eye (splat_project)
    colors: Array,  # [M, 3]
    opacities: Array,  # [M]
    order: Array,  # [M] back to front
    *,
    screen: tuple[int, int],  # width, height, pixels; width at most BAND_PIXELS
) -> Array:
    """Premultiplied RGBA [height, width, 4] float64, blended front to back: the same image as back to front."""
    width, height = screen
    image = np.zeros((height * width, 4))
    front_to_back = order[::-1][ellipses[order[::-1], 4] > 0]
    ellipses, colors, opacities = ellipses[front_to_back], colors[front_to_back], opacities[front_to_back]
    low, high = _pixel_boxes(ellipses, screen)
    rows = BAND_PIXELS // width
    for top in range(0, height, rows):
        bottom = min(top + rows, height)
        band = image[top * width : bottom * width]
        for splats, column, row in _pairs(low, high, top, bottom):
            pixel = column.astype(ellipses.dtype), row.astype(ellipses.dtype)
            alphas = opacities[splats] * _shares(ellipses[splats], *pixel)
            drawn = np.flatnonzero(alphas)
            pixels = (row[drawn] - top) * width + column[drawn]
            _blend(band, colors, splats[drawn], pixels, alphas[drawn])
    return image.reshape(height, width, 4)


def _pixel_boxes(
    ellipses: Array,  # [M, 6]
    screen: tuple[int, int],
) -> tuple[Array, Array]:
    """First and one-past-last (column, row) [M, 2] int64 of the pixels whose centre the box of each quad holds."""
    extent = half_extents(ellipses)
    limit = np.array(screen)
    low = np.clip(np.ceil(ellipses[:, 0:2] - extent - 0.5), 0, limit).astype(np.int64)
    high = np.clip(np.floor(ellipses[:, 0:2] + extent - 0.5) + 1, 0, limit).astype(np.int64)
    return low, np.maximum(high, low)


def _pairs(
    low: Array,  # [M, 2]
    high: Array,  # [M, 2]
    top: int,
    bottom: int,
) -> Iterator[tuple[Array, Array, Array]]:
    """Splat, column and row [P] of every pixel of every box in a band, splats in order, about CHUNK_PAIRS at a time."""
    first = np.maximum(low[:, 1], top)
    columns = high[:, 0] - low[:, 0]
    counts = columns * np.maximum(np.minimum(high[:, 1], bottom) - first, 0)
    touching = np.flatnonzero(counts)
    chunk = np.cumsum(counts[touching]) // CHUNK_PAIRS
    for splats in np.split(touching, np.flatnonzero(np.diff(chunk)) + 1):
        count = counts[splats]
        owner = np.repeat(splats, count)
        within = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
        row, column = np.divmod(within, columns[owner])
        yield owner, low[owner, 0] + column, first[owner] + row


def _shares(
    ellipses: Array,  # [P, 6]
    column: Array,  # [P]
    row: Array,  # [P]
) -> Array:
    """Share [P] of its opacity that each pair's splat has, 0 where the pixel centre is outside the quad."""
    return pixel_share(np.stack([column, row], axis=-1) + ellipses.dtype.type(0.5) - ellipses[:, :2], ellipses)


def _blend(
    band: Array,  # [pixels, 4] premultiplied RGBA so far, blended under in place
    colors: Array,  # [M, 3]
    splats: Array,  # [P] front to back
    pixels: Array,  # [P] into the band
    alphas: Array,  # [P]
) -> None:
    """Blend pairs behind what the band holds: a pixel's pairs side by side, transmittance by one running sum.

    The sum stays below 3 CHUNK_PAIRS, so that doubles leave transmittances an error of about 1e-9.
    """
    by_pixel = np.argsort(pixels.astype(np.uint16), kind="stable")
    splats, pixels, alphas = splats[by_pixel], pixels[by_pixel], alphas[by_pixel].astype(float)
    starts = np.flatnonzero(np.diff(pixels, prepend=-1))
    passed = np.log1p(-alphas)
    before = np.cumsum(passed) - passed
    before -= np.repeat(before[starts], np.diff(starts, append=len(pixels)))
    weights = np.exp(before) * alphas * (1 - band[pixels, 3])
    premultiplied = weights[:, None] * np.concatenate([colors[splats], np.ones((len(splats), 1))], axis=1)
    if len(starts):
        band[pixels[starts]] += np.add.reduceat(premultiplied, starts)
