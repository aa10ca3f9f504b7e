"""Draw sorted splats: a quad each, the Gaussian integrated over every pixel, degree-1 SH colour, blended by depth.

The integral over the pixel's unit square is taken to be the Gaussian with its sum and its variance: the square has 1/12
along any line through its middle, so that the ellipse keeps its axes. Sums over pixels are exact; one is off by at
most 1/480 / minor^4, the square's fourth cumulant.

Colours are display-referred, as in 3D Gaussian Splatting: sRGB values are blended, and no transfer function is applied.
"""

from collections.abc import Iterator

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.channels import SH_C0, SH_C1
from mua.kernels.splat_project import half_extents, half_lengths, wide_deviations

MOST_ALPHA = 0.99  # of one splat at one pixel, as in 3D Gaussian Splatting
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


def pixel_integral(
    along: Array,  # [...] pixel centre minus ellipse centre, along the major axis, pixels
    across: Array,  # [...] across it
    major: Array,  # [...] standard deviation, pixels
    minor: Array,  # [...]
) -> Array:
    """Integral [...] of exp(-along^2 / 2 major^2 - across^2 / 2 minor^2) over the unit square about the pixel."""
    wide_major, wide_minor = wide_deviations(major), wide_deviations(minor)
    share = major / wide_major * (minor / wide_minor)
    return np.asarray(share * np.exp(-((along / wide_major) ** 2 + (across / wide_minor) ** 2) / 2))


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
    low, high = _pixel_boxes(ellipses, opacities, screen)
    quads = np.concatenate([ellipses, half_lengths(ellipses, opacities), opacities[:, None]], axis=1)
    rows = BAND_PIXELS // width
    for top in range(0, height, rows):
        bottom = min(top + rows, height)
        band = image[top * width : bottom * width]
        for splats, column, row in _pairs(low, high, top, bottom):
            alphas = _alphas(quads[splats], column.astype(quads.dtype), row.astype(quads.dtype))
            drawn = np.flatnonzero(alphas)
            pixels = (row[drawn] - top) * width + column[drawn]
            _blend(band, colors, splats[drawn], pixels, alphas[drawn])
    return image.reshape(height, width, 4)


def _pixel_boxes(
    ellipses: Array,  # [M, 6]
    opacities: Array,  # [M]
    screen: tuple[int, int],
) -> tuple[Array, Array]:
    """First and one-past-last (column, row) [M, 2] int64 of the pixels whose centre the box of each quad holds."""
    extent = half_extents(ellipses, opacities)
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


def _alphas(
    quads: Array,  # [P, 9] ellipse, half lengths, opacity
    column: Array,  # [P]
    row: Array,  # [P]
) -> Array:
    """Opacity [P] of each pair, 0 where the pixel centre is outside the quad."""
    middle_x, middle_y, cosine, sine, major, minor, half_along, half_across, opacity = quads.T
    x, y = column + 0.5 - middle_x, row + 0.5 - middle_y
    along, across = cosine * x + sine * y, cosine * y - sine * x
    inside = (np.abs(along) <= half_along) & (np.abs(across) <= half_across)
    alphas = opacity * pixel_integral(along, across, major, minor)
    return np.where(inside, np.minimum(alphas, MOST_ALPHA), 0)


def _blend(
    band: Array,  # [pixels, 4] premultiplied RGBA so far, blended under in place
    colors: Array,  # [M, 3]
    splats: Array,  # [P] front to back
    pixels: Array,  # [P] into the band
    alphas: Array,  # [P]
) -> None:
    """Blend pairs behind what the band holds: a pixel's pairs side by side, transmittance by one running sum.

    The sum stays below 5 CHUNK_PAIRS, so that doubles leave transmittances an error of about 1e-9.
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
