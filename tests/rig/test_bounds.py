"""Boxes contain the avatar's motion."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar

from mua.avatar.decode import decode_clip_frame
from mua.pose.clip import Stretches
from mua.rig.bounds import frame_boxes, margin, playback_bounds, root_positions, union

AVATAR = synthetic_avatar()
RIG, CLIP = AVATAR.rig, AVATAR.clips[0]


def test_a_frames_box_is_the_skinned_template_and_a_margin() -> None:
    around = margin(RIG)
    for index in (0, 6):
        skinned = frame_boxes(RIG, CLIP)[index] + [[around] * 3, [-around] * 3]
        mesh = decode_clip_frame(AVATAR, CLIP, frame=index, dtype=np.float64).mesh
        moved = np.abs(np.stack([mesh.min(axis=0), mesh.max(axis=0)]) - skinned)
        assert moved.max() < around  # the student's own shape differs from the template by less


def test_the_margin_follows_the_figures_size() -> None:
    tiny = replace(RIG, mesh=replace(RIG.mesh, vertices=RIG.mesh.vertices / 1000))
    assert margin(tiny) == pytest.approx(margin(RIG) / 1000)


def test_playback_bounds_hold_every_frame_about_its_root() -> None:
    bounds = playback_bounds(RIG, (CLIP, CLIP))
    about = frame_boxes(RIG, CLIP) - root_positions(RIG, CLIP)[:, None]
    np.testing.assert_allclose(bounds, union(about), rtol=1e-6)
    assert bounds.dtype == np.float32


def test_a_union_reaches_to_the_outermost_corners() -> None:
    boxes = np.array([[[0, 0, 0], [1, 1, 1]], [[-1, 0.5, 0], [0, 2, 0.5]]])
    np.testing.assert_array_equal(union(boxes), [[-1, 0, 0], [1, 2, 1]])


def test_stretched_limbs_are_within_the_bounds() -> None:
    """A joint that a clip scales takes the surface beyond where rigid joints alone would."""
    frames = len(CLIP)
    matrices = np.tile(np.eye(3), (frames, len(RIG.skeleton.names), 1, 1))
    matrices[frames // 2] *= 3
    swollen = replace(CLIP, stretches=Stretches(np.arange(len(RIG.skeleton.names)), matrices))
    plain, boxes = frame_boxes(RIG, CLIP), frame_boxes(RIG, swollen)
    np.testing.assert_array_equal(boxes[0], plain[0])
    assert (np.ptp(boxes[frames // 2], axis=0) > 1.5 * np.ptp(plain[frames // 2], axis=0)).all()
