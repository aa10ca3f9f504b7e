"""Surfels along the borders of charts: each lies in the middle of the surface that is its own, and is as wide as that.

A border cuts through the squares of texels. Surfels as wide as whole squares would reach beyond it: into the air, or
over another colour. The surface of a texel is what lies nearer to it than to others of its chart.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from mua.arrays import Array
from mua.texture.footprints import Samples, TexelPoints, neighbours

SIDES = 4  # neighbours of a texel that does not lie at a border
SHARE = 0.87  # of the width of a texel's surface, that counts as the step to a neighbour: an outline is sharp
EVEN = 0.985  # cosine between normals from which a surface goes on evenly: at a seam there, all of the width counts
NEAR = 0.75  # of the way to where the next texel would lie: half of a square's diagonal, and a little more
NARROWEST, WIDEST = 0.6, 1.3  # of a surfel that does not lie at a border
FARTHEST = 0.5  # steps to a neighbouring texel, by which a surfel is moved
FEW = 4  # samples: fewer say too little


@dataclass(frozen=True, eq=False)
class Rims:
    """The texels along the borders of charts, and what becomes of their surfels."""

    at_border: Array  # [N] bool, of all texels
    texels: Array  # [n] those of them with enough surface to be fitted to, as rows of the texel map
    aside: Array  # [n, 3] from a texel's point to the middle of its surface, metres
    steps: Array  # [n, 2] along x and y that stand for those to neighbouring texels, metres


def fit_rims(
    points: TexelPoints,
    samples: Samples,
    frames: Array,  # [N, 3, 3] columns x, y, z
    *,
    steps: Array,  # [N, 2] to neighbouring texels along x and y, metres
) -> Rims:
    """Find the texels at borders, and fit their surfels to the samples that are theirs."""
    at_border = _sides(points) < SIDES
    seen = ~samples.bare & at_border[samples.texels]
    texel = samples.texels[seen]
    count = np.bincount(texel, minlength=len(frames))
    rims = np.flatnonzero(count >= FEW)
    away = np.einsum("sc,sck->sk", samples.places[seen] - points.places[texel], frames[texel][:, :, :2])
    mean, square = (
        np.stack([np.bincount(texel, column, len(frames))[rims] / count[rims] for column in values.T], axis=1)
        for values in (away, away**2)
    )
    widths = np.sqrt(12 * np.maximum(square - mean**2, 0))  # of an even square: its sides
    far = np.linalg.norm(mean, axis=1) / np.maximum(FARTHEST * steps[rims].max(axis=1), np.finfo(float).tiny)
    aside = np.einsum("nck,nk->nc", frames[rims][:, :, :2], mean / np.maximum(far, 1)[:, None])
    goes_on = _goes_on(points, frames, rims, centres=points.places[rims] + aside, reach=(widths + steps[rims]) / 2)
    return Rims(
        at_border=at_border,
        texels=rims,
        aside=aside,
        steps=np.clip(np.where(goes_on, 1, SHARE) * widths, NARROWEST * steps[rims], WIDEST * steps[rims]),
    )


def _goes_on(
    points: TexelPoints,
    frames: Array,  # [N, 3, 3] columns x, y, z
    rims: Array,  # [n] rows of the texel map
    *,
    centres: Array,  # [n, 3] of their surfels
    reach: Array,  # [n, 2] from there to the next texels along x and y
) -> Array:
    """Whether an even surface with texels goes on to both sides of each axis [n, 2]."""
    tree = cKDTree(points.places)
    goes_on = np.ones(reach.shape, bool)
    for axis, sign in np.ndindex(2, 2):
        step = reach[:, axis]
        beyond = centres + ((2 * sign - 1) * step)[:, None] * frames[rims, :, axis]
        away, near = tree.query(beyond, workers=-1)
        even = np.einsum("nc,nc->n", frames[rims, :, 2], frames[near, :, 2]) > EVEN
        goes_on[:, axis] &= even & (near != rims) & (away < NEAR * step)
    return goes_on


def _sides(points: TexelPoints) -> Array:
    """How many of its four neighbours each texel [N] has in its own chart."""
    chart = points.charts[points.triangles]
    found = np.zeros(len(chart), np.int64)
    for a, b in neighbours(points.texels, points.size):
        together = chart[a] == chart[b]
        found += np.bincount(a[together], minlength=len(chart)) + np.bincount(b[together], minlength=len(chart))
    return found
