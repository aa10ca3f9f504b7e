"""How narrow the surfels of texels are to be to show an image, and along which of its lines they are to lie.

Narrow surfels show a fine image sharply, but let more of what is behind shine through. That is seen where an image
is even, and there wide surfels lose nothing.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter

from mua.arrays import Array
from mua.texture.albedo import FINER

SPREAD = 0.62  # standard deviation over the distance of neighbouring texels: between four, 95 % is covered
WIDE, NARROW = 0.66, 0.5  # of an even image and of a busy one: 98 and 86 % are covered at the least
EVEN, BUSY = 5e-4, 1e-2  # mean squared difference of a texel's colour to those of its neighbours, sum of the channels
LONGER = 0.35  # logarithm of a surfel's length on a line over that of a round one, which it is narrower by as well
LEAST_LONGER = 0.05  # what is less is no line
SMOOTHING = 0.6, 0.7  # texels, standard deviations: of the image, and of the surroundings over which a line is sought
SOLID = 254 / 255  # opacity of a texel with nothing clear about it


@dataclass(frozen=True, eq=False)
class Sharpness:
    """The width and direction that an image asks of each texel's surfel."""

    spreads: Array  # [N] standard deviation over the distance of neighbouring texels
    across: Array  # [N, 2] unit, along u and v: across the line on which the texel lies
    longer: Array  # [N] logarithm of the length along the line over that of a round surfel, 0 where there is no line

    def at(self, texels: Array) -> "Sharpness":
        """The values of some of the texels."""
        return Sharpness(self.spreads[texels], self.across[texels], self.longer[texels])


def sharpness(
    picture: Array,  # [FINER S, FINER S, 4] colours and opacities in 0..1, sRGB
) -> Sharpness:
    """The surfels that the image asks for, at all S x S texels row by row; all alike and round where it is clear."""
    size = len(picture) // FINER
    colors = by_texel(picture[..., :3])
    apart = [np.roll(colors, (y, x), (0, 1)) - colors for y in (-1, 0, 1) for x in (-1, 0, 1) if (y, x) != (0, 0)]
    contrast = np.mean([np.sum(difference**2, axis=2) for difference in apart], axis=0)
    busy = np.log(np.maximum(contrast, EVEN) / EVEN) / np.log(BUSY / EVEN)
    busy = np.where(by_texel(picture[..., 3:])[..., 0] < SOLID, np.nan, np.clip(busy, 0, 1))
    across, straight = _lines(picture[..., :3])
    longer = np.nan_to_num(LONGER * busy * straight)
    return Sharpness(
        spreads=np.where(np.isnan(busy), SPREAD, WIDE + (NARROW - WIDE) * busy).ravel(),
        across=across.reshape(size * size, 2),
        longer=np.where(longer < LEAST_LONGER, 0, longer).ravel(),
    )


def by_texel(
    picture: Array,  # [FINER S, FINER S, c]
) -> Array:
    """The mean over each texel [S, S, c]."""
    size = len(picture) // FINER
    return np.asarray(picture.reshape(size, FINER, size, FINER, -1).mean(axis=(1, 3)))


def _lines(
    colors: Array,  # [FINER S, FINER S, 3]
) -> tuple[Array, Array]:
    """Unit directions [S, S, 2] in which the colours change most, and how much more so than across them [S, S], 0..1.

    By the structure tensor (Foerstner and Guelch 1987).
    """
    smooth = gaussian_filter(colors, (SMOOTHING[0] * FINER, SMOOTHING[0] * FINER, 0), mode="wrap")
    down, right = np.gradient(smooth, axis=(0, 1))
    products = np.stack([np.sum(p * q, axis=2) for p, q in ((right, right), (right, down), (down, down))], axis=2)
    products = gaussian_filter(products, (SMOOTHING[1] * FINER, SMOOTHING[1] * FINER, 0), mode="wrap")
    uu, uv, vv = np.moveaxis(by_texel(products), 2, 0)
    angle = np.arctan2(2 * uv, uu - vv) / 2
    straight = np.hypot(uu - vv, 2 * uv) / np.maximum(uu + vv, np.finfo(np.float32).eps)
    return np.stack([np.cos(angle), np.sin(angle)], axis=2), straight


def along_lines(
    frames: Array,  # [N, 3, 3] columns x, y, z
    extents: Array,  # [N, 2] standard deviations along x and y, metres
    *,
    steps: Array,  # [N, 2, 3] that lead from texel to texel along u and v, metres
    wanted: Sharpness | None,  # of the N; None: no image has lines
) -> tuple[Array, Array]:
    """Turns [N] about z, radians, and extents [N, 2] of surfels that are longer along lines, and narrower across.

    Each axis stays the one that is nearest to its former direction: it turns by 45 degrees at most.
    """
    turns, extents = np.zeros(len(frames)), extents.copy()
    lines = np.flatnonzero(wanted.longer) if wanted else np.empty(0, np.int64)
    if wanted is None or not len(lines):
        return turns, extents
    across = np.einsum("nij,nj->ni", np.linalg.pinv(steps[lines] @ frames[lines][:, :, :2]), wanted.across[lines])
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), np.finfo(float).tiny)
    outer = across[:, :, None] * across[:, None]
    longer = wanted.longer[lines, None, None]
    stretch = np.exp(longer) * (np.eye(2) - outer) + np.exp(-longer) * outer
    squares = stretch @ (extents[lines, :, None] ** 2 * stretch)
    turn = np.arctan2(2 * squares[:, 0, 1], squares[:, 0, 0] - squares[:, 1, 1]) / 2
    turn = (turn + np.pi / 4) % (np.pi / 2) - np.pi / 4
    axes = np.stack([np.cos(turn), np.sin(turn), -np.sin(turn), np.cos(turn)], axis=1).reshape(-1, 2, 2)  # as rows
    turns[lines], extents[lines] = turn, np.sqrt(np.einsum("nik,nkl,nil->ni", axes, squares, axes))
    return turns, extents
