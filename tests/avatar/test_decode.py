"""Decoding of windows, of float32 and of nothing; tests/oracle holds all numbers against a decoder of its own."""

import dataclasses

import numpy as np
from synthetic_avatar import empty_avatar, synthetic_avatar, with_one_sided

from mua.avatar.decode import PoseWindow, Splats, decode, decode_clip_frame

# Sums on the way of one value: four layers of at most 63 terms, 4 basis maps, 4 levels of 2 x 10 taps, 20 in posing.
OPERATIONS = 4 * 63 + 4 + 80 + 20


def test_float32_stays_near_float64() -> None:
    avatar = synthetic_avatar()
    avatar = with_one_sided(avatar, np.arange(len(avatar.rig.texels.texels)) % 2 == 0)
    single = decode_clip_frame(avatar, avatar.clips[0], frame=3)
    double = decode_clip_frame(avatar, avatar.clips[0], frame=3, dtype=np.float64)
    arrays = [field.name for field in dataclasses.fields(Splats) if field.name != "outside"]
    assert single.outside == double.outside
    for name in arrays:
        found, expected = getattr(single, name), getattr(double, name)
        assert (found.dtype, expected.dtype) == (np.float32, np.float64)
        bound = OPERATIONS * np.finfo(np.float32).eps * max(np.abs(double.texture).max(), 1)
        np.testing.assert_allclose(found, expected, rtol=0, atol=bound, err_msg=name)


def test_a_frame_of_a_clip_is_its_window_newest_first() -> None:
    avatar = synthetic_avatar()
    clip = avatar.clips[0]
    for frame, window in ((3, [3, 2, 1]), (1, [1, 0, 0]), (0, [0, 0, 0])):
        expected = decode(avatar, PoseWindow(clip.rotations[window], clip.translations[window]))
        np.testing.assert_array_equal(decode_clip_frame(avatar, clip, frame=frame).centres, expected.centres)


def test_depth_is_keyed_over_the_files_box_about_the_root() -> None:
    """Players key depth this way too, because they know no box of the splats."""
    avatar = synthetic_avatar()
    clip = avatar.clips[0]
    posed = decode_clip_frame(avatar, clip, frame=3, dtype=np.float64)
    root = avatar.rig.skeleton.world(clip.rotations[3], clip.translations[3])[1][avatar.rig.skeleton.root]
    np.testing.assert_array_equal(posed.bounds, avatar.bounds + root)


def test_an_avatar_without_texels_decodes_to_no_splats() -> None:
    empty = empty_avatar()
    posed = decode_clip_frame(empty, empty.clips[0], frame=0)
    assert posed.centres.shape == (0, 3)
    assert posed.texture.shape == (0, 23)
