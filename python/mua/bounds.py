"""Boxes around posed avatars, from the skinned template: no texel needs to be decoded for them."""

from collections.abc import Iterable, Iterator

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.kernels.dq_skinning import blend_vertices
from mua.motion.clip import Clip
from mua.rig.rig import Rig

MARGIN = 0.1  # metres that cloth may leave the skinned template


def playback_bounds(rig: Rig, clips: Iterable[Clip]) -> Array:
    """Lowest and highest corner [2, 3] float32 of all frames of all clips about the root joint's position, metres."""
    boxes = []
    for clip in clips:
        _, placed = rig.skeleton.world(clip.rotations, clip.translation)
        roots = placed[:, rig.skeleton.root]
        boxes += [box - root for box, root in zip(_boxes(rig, clip), roots, strict=True)]
    return _padded(boxes).astype(np.float32)


def world_bounds(rig: Rig, clip: Clip) -> Array:
    """Lowest and highest corner [2, 3] of all frames of a clip in the world, metres."""
    return _padded(list(_boxes(rig, clip)))


def _boxes(rig: Rig, clip: Clip) -> Iterator[Array]:
    """The box [2, 3] of every frame's skinned template."""
    for joints in rig.skeleton.skinning(clip.rotations, clip.translation):
        dual = blend_vertices(joints, rig.skin_indices, rig.skin_weights)
        posed = rotation.dual_transform(dual, rig.mesh.vertices)
        yield np.stack([posed.min(axis=0), posed.max(axis=0)])


def _padded(boxes: list[Array]) -> Array:
    stacked = np.stack(boxes)
    return np.stack([stacked[:, 0].min(axis=0) - MARGIN, stacked[:, 1].max(axis=0) + MARGIN])
