"""Points spread over triangles, and what a texture loses at them where texels are wide."""

from dataclasses import dataclass

import numpy as np
from PIL import Image

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.rig.charts import areas
from mua.scene import Material, wrapped

POINTS = 1 << 17  # over the whole surface, and LEAST on each triangle besides
LEAST = 3
LARGEST = 2048  # texels along a side of an image; those of larger ones are averaged first
LEVELS = 8  # halvings of an image at which its loss is measured


@dataclass(frozen=True, eq=False)
class SurfaceSamples:
    """Points on triangles, at least a few on each."""

    triangles: Array  # [n] ascending
    barycentrics: Array  # [n, 3]
    share: Array  # [n] of the triangle

    def at(self, values: Array) -> Array:
        """Values [n, c] between those of the corners [F, 3, c]."""
        return np.asarray(np.einsum("nk,nkc->nc", self.barycentrics, values[self.triangles]))

    def means(self, values: Array, count: int) -> Array:
        """Means [count] over each triangle of values [n]."""
        return np.bincount(self.triangles, self.share * values, minlength=count)


def spread_samples(
    positions: Array,  # [F, 3, 3]
) -> SurfaceSamples:
    """Spread points over triangles by their area."""
    surface = areas(positions)
    count = LEAST + np.floor(POINTS * surface / max(surface.sum(), np.finfo(float).tiny)).astype(np.int64)
    triangles = np.repeat(np.arange(len(count)), count)
    number = np.arange(len(triangles)) - np.repeat(np.cumsum(count) - count, count) + 0.5
    # The two-dimensional golden ratio (Roberts 2018, https://extremelearning.com.au) spreads points in the triangles.
    a, b = (number[:, None] * [0.7548776662466927, 0.5698402909980532] % 1).T
    folded = a + b > 1
    a, b = np.where(folded, 1 - a, a), np.where(folded, 1 - b, b)
    return SurfaceSamples(triangles, np.stack([1 - a - b, a, b], axis=1), 1 / count[triangles])


def texture_losses(
    surfaces: Surfaces,
    samples: SurfaceSamples,
    corners: Array,  # [F, 3, 2] UV of the file
    *,
    widths: Array,  # [w] metres
) -> tuple[Array, Array]:
    """How far textures are from their means over texels of these widths, [F, w], and the samples' opacities [n].

    Mean squared differences of sRGB colours and opacity in 0..1, summed over the channels, the colours premultiplied.
    """
    surface = areas(surfaces.vertices[surfaces.faces])
    finer = np.sqrt(areas(corners) / np.maximum(surface, np.finfo(float).tiny))  # UV for each metre
    losses, opacity = np.zeros((len(corners), len(widths))), np.ones(len(samples.triangles))
    points, owner = samples.at(corners), surfaces.face_material[samples.triangles]
    for index, material in enumerate(surfaces.materials):
        rows, faces = np.flatnonzero(owner == index), np.flatnonzero(surfaces.face_material == index)
        if not len(rows):
            continue
        image = _premultiplied(material.image)
        by_level, opacity[rows] = _by_level(image, points[rows], material)
        sums = [np.bincount(samples.triangles[rows], samples.share[rows] * level) for level in by_level]
        texels = np.sqrt(image.shape[0] * image.shape[1]) * finer[faces, None] * widths
        losses[faces] = _between(np.stack(sums, axis=1)[faces], np.log2(np.maximum(texels, np.finfo(float).tiny)))
    return losses, opacity


def _by_level(image: Array, points: Array, material: Material) -> tuple[list[Array], Array]:
    """Squared differences [n] of an image at points from its means over 1, 2, 4, ... texels, and opacities [n]."""
    own, found = _picked(image, points, material), []
    for _ in range(LEVELS + 1):
        found.append(np.sum((_picked(image, points, material) - own) ** 2, axis=1))
        image = np.asarray(Image.fromarray(image).reduce(2)) if min(image.shape[:2]) > 1 else image
    return found, own[:, 3]


def _premultiplied(image: Array) -> Array:
    """The image no larger than LARGEST, its colours times its opacity: [h, w, 4] uint8."""
    factor = -(-max(image.shape[:2]) // LARGEST)
    if factor > 1:
        image = np.asarray(Image.fromarray(image).reduce(factor))
    if image[..., 3].min() == 255:
        return image
    opacity = image[..., 3:].astype(np.uint16)
    return np.dstack([(image[..., :3] * opacity // 255).astype(np.uint8), image[..., 3]])


def _picked(image: Array, points: Array, material: Material) -> Array:
    """The image's own values [n, 4] in 0..1 at points [n, 2] in UV."""
    height, width = image.shape[:2]
    column, row = np.floor(points * (width, height)).astype(np.int64).T
    return image[wrapped(row, height, material.wrap_v), wrapped(column, width, material.wrap_u)] / 255


def _between(
    by_level: Array,  # [F, LEVELS + 1]
    level: Array,  # [F, w] of any size
) -> Array:
    """Losses [F, w] between whole levels; inside a texel of the image they fall with the square of the width."""
    low = np.clip(np.floor(level), 1, LEVELS - 1).astype(np.int64)
    rows, part = np.arange(len(level))[:, None], np.clip(level - low, 0, 1)
    between = (1 - part) * by_level[rows, low] + part * by_level[rows, low + 1]
    return np.where(level < 1, by_level[:, 1:2] * 4.0 ** np.minimum(level - 1, 0), between)
