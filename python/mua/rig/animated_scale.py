"""Animated scales and shears, which rigid joints do not carry: applied to the surface before joints move it."""

import numpy as np

from mua.arrays import Array
from mua.pose.clip import Stretches
from mua.rig.skinning import Skinned


def stretched(
    surface: Skinned,
    stretches: Stretches,
    frame: int,
    points: Array,  # [V, 3] the surface's vertices or near them, canonical
) -> Array:
    """Points [V, 3] stretched about their joints, blended by the skinning weights."""
    skeleton = surface.skeleton
    _, places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    change = np.zeros((len(places), 3, 3))
    change[stretches.joints] = stretches.matrices[frame] - np.eye(3)
    moved = points.copy()
    for joints, weights in zip(surface.skin_indices.T, surface.skin_weights.T, strict=True):
        about = points - places[joints]
        moved += weights[:, None] * np.einsum("vij,vj->vi", change[joints], about)
    return moved
