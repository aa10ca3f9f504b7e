"""Compares two images of one pose: overlap of the silhouettes, PSNR of the colours, and the worst place."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter

from mua.arrays import Array

COVERED = 0.5  # opacity from which a pixel belongs to the silhouette
MOST_DECIBELS = 99.0  # the value for equal images
WINDOW = 24  # a worst place is the worst mean over a square of this part of the image's height


@dataclass(frozen=True)
class Agreement:
    """The agreement of two images of one pose, as sums that can be added over views."""

    common: int  # pixels that both silhouettes hold
    missing: int  # pixels that only the source's holds
    beyond: int  # pixels that only the splats' holds
    squares: float  # summed over the common pixels and the three channels: squared differences of sRGB in 0..1

    def changed(self, before: "Agreement", after: "Agreement") -> "Agreement":
        """The agreement once that of a part of the images has become another."""
        return Agreement(
            common=self.common - before.common + after.common,
            missing=self.missing - before.missing + after.missing,
            beyond=self.beyond - before.beyond + after.beyond,
            squares=self.squares - before.squares + after.squares,
        )

    @property
    def iou(self) -> float:
        """Overlap of the silhouettes: common pixels over all pixels of either; 0 where both images are empty."""
        either = self.common + self.missing + self.beyond
        return self.common / either if either else 0.0

    @property
    def psnr(self) -> float:
        """Decibels over the common pixels, at most MOST_DECIBELS; 0 where there are none."""
        if not self.common:
            return 0.0
        return float(-10 * np.log10(max(self.squares / (3 * self.common), 10 ** (-MOST_DECIBELS / 10))))


@dataclass(frozen=True, eq=False)
class Pair:
    """The source and its splats, drawn alike."""

    source: Array  # [H, W, 4] premultiplied sRGB and alpha
    splats: Array  # [H, W, 4]
    agreement: Agreement


def agreement(
    source: Array,  # [H, W, 4] premultiplied sRGB and alpha
    splats: Array,  # [H, W, 4]
) -> Agreement:
    """Compare silhouettes at half coverage, and colours without their background where both silhouettes are."""
    one, other = source[..., 3] >= COVERED, splats[..., 3] >= COVERED
    both = one & other
    apart = straight(source[both]) - straight(splats[both])
    common, missing, beyond = (int(np.count_nonzero(held)) for held in (both, one & ~other, other & ~one))
    return Agreement(common, missing, beyond, float(np.sum(apart**2)))


def together(agreements: Sequence[Agreement]) -> Agreement:
    """The agreement of all views of one pose."""
    return Agreement(
        common=sum(a.common for a in agreements),
        missing=sum(a.missing for a in agreements),
        beyond=sum(a.beyond for a in agreements),
        squares=sum(a.squares for a in agreements),
    )


def straight(
    image: Array,  # [..., 4] premultiplied sRGB and alpha
) -> Array:
    """Colours [..., 3] as if opaque, in 0..1; black where nothing is."""
    alpha = image[..., 3:]
    return np.clip(image[..., :3] / np.where(alpha > 0, alpha, 1), 0, 1)


def worst_place(
    source: Array,  # [H, W, 4] premultiplied sRGB and alpha
    splats: Array,  # [H, W, 4]
) -> tuple[int, int, float]:
    """Column and row about which the images differ most, and the mean difference there in 0..1.

    A pixel that only one silhouette holds differs by 1.
    """
    difference = np.abs(straight(source) - straight(splats)).max(axis=-1)
    one, other = source[..., 3] >= COVERED, splats[..., 3] >= COVERED
    difference = np.where(one & other, difference, one ^ other)
    mean = uniform_filter(difference.astype(float), max(len(difference) // WINDOW, 1), mode="constant")
    row, column = np.unravel_index(int(np.argmax(mean)), mean.shape)
    return int(column), int(row), float(mean[row, column])
