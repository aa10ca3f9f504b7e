"""Joints and their motion in the conventions of other programs."""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton


def bind_matrices(skeleton: Skeleton) -> Array:
    """Joint-to-world matrices [J, 4, 4] of the bind pose."""
    return matrices(*skeleton.world(skeleton.bind_rotations, skeleton.bind_translations))


def matrices(
    rotations: Array,  # [..., 4] unit, wxyz
    translations: Array,  # [..., 3]
) -> Array:
    """Rigid matrices [..., 4, 4] that act on column vectors."""
    found = np.zeros((*rotations.shape[:-1], 4, 4))
    found[..., :3, :3] = rotation.to_matrix(rotations)
    found[..., :3, 3] = translations
    found[..., 3, 3] = 1
    return found


def steady(
    rotations: Array,  # [F, ..., 4]
) -> Array:
    """Rotations with the signs that bring each nearest to the one before it, because players blend components."""
    turns = np.sum(rotations[1:] * rotations[:-1], axis=-1) < 0
    flipped = np.cumsum(turns, axis=0) % 2 == 1
    signs = np.concatenate([np.zeros((1, *flipped.shape[1:]), bool), flipped])
    return np.where(signs[..., None], -rotations, rotations)


def translated(skeleton: Skeleton, clip: Clip) -> Array:
    """Which joints [J] move in their parents in a clip."""
    away = np.abs(clip.translations - skeleton.bind_translations)
    return np.asarray((away > 0).any(axis=(0, 2)))
