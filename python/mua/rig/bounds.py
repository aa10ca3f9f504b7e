"""Boxes around posed avatars, from the skinned template: no texel needs to be decoded for them."""

from collections.abc import Callable, Iterable
from functools import partial

import numpy as np

from mua.arrays import Array
from mua.kernels.dq_skinning import blend_vertices
from mua.pose.clip import Clip
from mua.rig.animated_scale import stretched
from mua.rig.rig import Rig
from mua.rig.skinning import Skinning, transform

MARGIN = 0.06  # share of the figure's size by which cloth may leave the skinned template


def playback_bounds(rig: Rig, clips: Iterable[Clip]) -> Array:
    """Lowest and highest corner [2, 3] float32 of all frames of all clips about the root joint's position, metres."""
    skinning = Skinning(rig.skin_indices, rig.skin_weights)
    boxes = [frame_boxes(rig, clip, blend=skinning) - root_positions(rig, clip)[:, None] for clip in clips]
    return union(np.concatenate(boxes)).astype(np.float32)


def frame_boxes(
    rig: Rig,
    clip: Clip,
    *,
    blend: Callable[[Array], Array] | None = None,  # from joints [J, 8] to vertices [V, 8]; None: as the kernel does
) -> Array:
    """Lowest and highest corner [F, 2, 3] of every frame of a clip in the world, metres."""
    blend = blend or partial(blend_vertices, indices=rig.skin_indices, weights=rig.skin_weights)
    boxes, around = [], margin(rig)
    for frame, joints in enumerate(rig.skeleton.skinning(clip.rotations, clip.translations)):
        dual = blend(joints)
        shape = rig.mesh.vertices
        if clip.stretches is not None:
            shape = stretched(rig, clip.stretches, frame, shape)
        posed = transform(dual, shape)
        boxes.append([posed.min(axis=0) - around, posed.max(axis=0) + around])
    return np.array(boxes)


def margin(rig: Rig) -> float:
    """How far the boxes reach beyond the skinned template, metres."""
    return MARGIN * float(np.ptp(rig.mesh.vertices, axis=0).max())


def root_positions(rig: Rig, clip: Clip) -> Array:
    """World positions [F, 3] of the root joint, metres."""
    _, placed = rig.skeleton.world(clip.rotations, clip.translations)
    return np.asarray(placed[:, rig.skeleton.root])


def way_out(
    boxes: Array,  # [..., 2, 3]
    points: Array,  # [..., 3]
    directions: Array,  # [..., 3]
) -> Array:
    """How far along a direction a ray leaves a box, [...]; 0 where it does not meet the box."""
    with np.errstate(divide="ignore", invalid="ignore"):
        sides = (boxes - points[..., None, :]) / directions[..., None, :]  # NaN where a ray runs along a side
    entry, leave = np.nanmax(sides.min(axis=-2), axis=-1), np.nanmin(sides.max(axis=-2), axis=-1)
    return np.where(entry <= leave, np.maximum(leave, 0.0), 0.0)


def union(
    boxes: Array,  # [B, 2, 3]
) -> Array:
    """The box [2, 3] around all boxes."""
    return np.stack([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])
