"""The joints that move a surface."""

import numpy as np

from mua.arrays import Array
from mua.rig.stretched import Skinned


def moving_joints(surface: Skinned) -> Array:
    """Whether each joint [J] moves the surface itself or through a descendant."""
    skeleton = surface.skeleton
    moving = np.zeros(len(skeleton.names), dtype=bool)
    moving[np.unique(surface.skin_indices[surface.skin_weights > 0])] = True
    for joint in range(len(moving) - 1, -1, -1):  # parents come before children
        if moving[joint] and skeleton.parents[joint] >= 0:
            moving[skeleton.parents[joint]] = True
    return moving
