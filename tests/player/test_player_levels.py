"""A player shows the requested level of detail, and says once where it does not exist."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar

from mua.avatar.camera import Camera, perspective
from mua.avatar.coarser import texel_length
from mua.avatar.level_choice import LARGEST_TEXEL
from mua.player.cpu_image import Reference
from mua.player.levels import AUTO, FULL, Levels

SCREEN = (64, 64)


def seen_from(texel: float) -> list[Camera]:
    """A camera before the synthetic avatar's box, at which a texel of its finest level takes this many pixels."""
    avatar, projection = synthetic_avatar(), perspective(0.5, aspect=1.0)
    away = texel_length(avatar) * projection[1, 1] * SCREEN[1] / 2 / texel
    root = avatar.rig.skeleton.world(*_pose())[1][avatar.rig.skeleton.root]
    view = np.eye(4)
    view[:3, 3] = -root - [0, 0, avatar.bounds[1, 2] + away]
    return [Camera(view, projection, SCREEN)]


def _pose() -> tuple[np.ndarray, np.ndarray]:
    clip = synthetic_avatar().clips[0]
    return clip.rotations[0], clip.translations[0]


@pytest.mark.parametrize(("wanted", "level"), [(FULL, 0), (32, 0), (16, 1), (8, 2)])
def test_the_level_that_is_asked_for_is_shown_from_anywhere(wanted: str | int, level: int) -> None:
    levels = Levels(synthetic_avatar(), wanted)
    assert levels.note == ""
    assert [levels.choose(*_pose(), seen_from(texel)) for texel in (0.01, 10)] == [level, level]


def test_the_distance_chooses_and_near_a_switch_keeps_what_is_shown() -> None:
    levels = Levels(synthetic_avatar(), AUTO)
    assert levels.note == ""
    walk = [LARGEST_TEXEL * share for share in (0.51, 0.49, 0.51, 0.6, 0.24, 0.26, 0.3)]
    assert [levels.choose(*_pose(), seen_from(texel)) for texel in walk] == [0, 1, 1, 0, 2, 2, 1]


def test_a_size_that_the_avatar_lacks_is_a_note_and_full_size() -> None:
    levels = Levels(synthetic_avatar(), 384)
    assert levels.note == "the avatar has no level of 384 texels but 32, 16, 8; it is shown at full size."
    assert levels.choose(*_pose(), seen_from(0.01)) == 0


def test_an_avatar_without_levels_is_a_note_and_full_size() -> None:
    avatar = synthetic_avatar()
    levels = Levels(replace(avatar, wavelet=replace(avatar.wavelet, levels=2)), AUTO)
    assert "the avatar has no coarser level of detail; it is shown at its 32 texels" in levels.note
    assert levels.choose(*_pose(), seen_from(0.01)) == 0


def test_pictures_by_the_cpu_are_of_the_level() -> None:
    avatar = synthetic_avatar()
    (clip,) = avatar.clips
    cameras = seen_from(5)
    found = Reference(avatar, clip, levels=Levels(avatar, 16)).picture(0, cameras)
    np.testing.assert_array_equal(found, Reference(avatar.at_level(1), clip).picture(0, cameras))
    assert not np.array_equal(found, Reference(avatar, clip).picture(0, cameras))
