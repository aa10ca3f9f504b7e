"""How opaque the surfels of a sheet are to be, so that together they hide as much as the sheet does."""

import numpy as np

from mua.arrays import Array
from mua.texture.sharpness import SPREAD

LEVELS = 65  # opacities between which is interpolated
PLACES = 8  # along a texel, at which the surfels around are laid over each other
AROUND = 3  # texels beyond which a surfel is not felt


def surfel_opacities(
    alpha: Array,  # [N] 0..1, of the sheet
) -> Array:
    """Opacities [N] of surfels on a regular grid: neighbours overlap, so that each is clearer than all together."""
    place = (np.arange(PLACES) + 0.5) / PLACES - 0.5
    apart = place[:, None] - np.arange(-AROUND, AROUND + 1)
    felt = np.exp(-(apart**2) / (2 * SPREAD**2))  # [PLACES, 2 AROUND + 1]
    weight = np.einsum("xi,yj->xyij", felt, felt).reshape(PLACES**2, -1)
    levels = np.linspace(0, 1, LEVELS)
    hidden = [1 - np.prod(1 - level * weight, axis=1).mean() for level in levels]
    return np.interp(alpha, hidden, levels)
