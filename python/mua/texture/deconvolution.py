"""Colours of texels whose surfels, laid over each other, look most like an image that is finer than they are."""

import numpy as np
from scipy import fft

from mua.arrays import Array
from mua.texture.albedo import FINER

DIRECTIONS = 8  # from which a surface is seen: the nearer of two surfels lies over the other
AROUND = 2  # texels beyond which a surfel is not felt
DAMPING = 0.1  # weight of the image's own colour at the texel, so that what no surfel can show is not amplified
LEVELS = 3  # of width, for which the colours of all surfels are sought: between them they are interpolated


def deconvolved(
    picture: Array,  # [FINER S, FINER S, 3] in 0..1, sRGB
    opacity: float,  # of a surfel, at its centre
    spreads: Array,  # [S, S] standard deviation over the distance of neighbouring texels
) -> Array:
    """Colours [S, S, 3] in 0..1, sRGB, of the texels of an opaque texture.

    The least-squares solution of "what the surfels of a regular grid show is the image", over points between the
    texels and over directions of view. Grid and widths are the same everywhere, so that a Fourier transform solves it,
    once for each of a few widths.
    """
    narrowest, widest = float(spreads.min()), float(spreads.max())
    size = len(picture) // FINER
    points = picture.reshape(size, FINER, size, FINER, 3)
    shown = {at: fft.rfft2(points[:, at[0], :, at[1]], axes=(0, 1)) for at in np.ndindex(FINER, FINER)}
    if narrowest == widest:
        return _solved(shown, opacity, narrowest, size)
    widths = np.linspace(narrowest, widest, LEVELS)
    place = (spreads - narrowest) * ((LEVELS - 1) / (widest - narrowest))
    shares = (np.maximum(1 - np.abs(place - level), 0)[..., None] for level in range(LEVELS))
    solved = (_solved(shown, opacity, width, size) for width in widths)
    return np.asarray(sum(share * colors for share, colors in zip(shares, solved, strict=True)))


def _solved(
    shown: dict[tuple[int, ...], Array],  # by row and column of a point in its texel: transforms of the image there
    opacity: float,
    spread: float,
    size: int,
) -> Array:
    """The colours [size, size, 3] where all surfels are equally wide."""
    total, products = np.zeros_like(shown[0, 0]), np.zeros((4 * AROUND + 1,) * 2)
    for (y, x), colors in shown.items():
        weights = blending((np.array([x, y]) + 0.5) / FINER - 0.5, opacity, spread)
        response = np.conj(_response(weights.sum(axis=0), size)) + DAMPING**2 * DIRECTIONS
        total += response[..., None] * colors
        products += _own_products(weights)
    power = _response(products, size).real + DAMPING**2 * FINER**2 * DIRECTIONS
    return np.clip(fft.irfft2(total / power[..., None], s=(size, size), axes=(0, 1)), 0, 1)


def _own_products(weights: Array) -> Array:
    """Sums [2 n - 1, 2 n - 1] of the products of weights [k, n, n] with themselves moved by up to n - 1 to each side.

    Their Fourier transform is the sum of the squares of the weights' own.
    """
    wide = (2 * weights.shape[1] - 1,) * 2
    squares = np.abs(fft.fft2(weights, s=wide)) ** 2
    return np.asarray(fft.fftshift(fft.ifft2(squares.sum(axis=0)).real))


def blending(
    place: Array,  # [2] along u and v from the centre of a texel, texels
    opacity: float,
    spread: float,  # standard deviation of all surfels over the distance of neighbouring texels
) -> Array:
    """What each surfel of a regular grid adds to a place seen from each direction: [DIRECTIONS, n, n], sum 1.

    Rows and columns run from AROUND texels before the place's own texel to AROUND after it.
    """
    apart = np.arange(-AROUND, AROUND + 1)
    v, u = (grid.ravel() for grid in np.meshgrid(apart, apart, indexing="ij"))
    hides = opacity * np.exp(-((u - place[0]) ** 2 + (v - place[1]) ** 2) / (2 * spread**2))
    weights = np.empty((DIRECTIONS, len(hides)))
    for row, angle in zip(weights, (np.arange(DIRECTIONS) + 0.5) * (2 * np.pi / DIRECTIONS), strict=True):
        nearest_first = np.argsort(-(u * np.cos(angle) + v * np.sin(angle)), kind="stable")
        passed = np.cumprod(1 - hides[nearest_first])
        row[nearest_first] = hides[nearest_first] * np.concatenate([[1], passed[:-1]])
    weights /= weights.sum(axis=1, keepdims=True)
    return weights.reshape(DIRECTIONS, len(apart), len(apart))


def _response(weights: Array, size: int) -> Array:
    """The Fourier transform of weighted sums over a texel's surroundings [n, n] in a periodic texture."""
    kernel = np.zeros((size, size))
    back = (len(weights) // 2 - np.arange(len(weights))) % size
    np.add.at(kernel, (back[:, None], back[None, :]), weights)
    return np.asarray(fft.rfft2(kernel))
