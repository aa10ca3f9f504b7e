"""What clips of one skeleton move."""

from dataclasses import replace

import numpy as np
import pytest
from people import chain, still

from mua import rotation
from mua.pose.clip import Clip, Stretches, moved_by, show_one_pose


def turned(degrees: float, *, frames: int = 1) -> Clip:
    """Three joints of which the middle one is turned."""
    clip = still(chain("hips", "spine", "head"), frames)
    clip.rotations[:, 1] = rotation.from_axis_angle(np.array([0, 0, 1.0]), np.radians(degrees))
    return clip


def test_a_joint_that_turns_within_or_between_clips_is_moved() -> None:
    assert moved_by([turned(0), turned(5)], range(3)) == [1]
    assert moved_by([turned(0).then(turned(5))], [0, 2]) == []
    assert moved_by([], range(3)) == []


def test_a_pose_that_is_held_is_one_pose() -> None:
    """A quaternion and its negative are one rotation, and files round."""
    held = turned(40, frames=4)
    held.rotations[2:] *= -1
    assert show_one_pose([held, turned(40.5)])
    assert not show_one_pose([held, turned(43)])


@pytest.mark.parametrize(("led", "one"), [(0.0005, True), (0.01, False)])
def test_a_path_is_no_pose_that_is_held(led: float, one: bool) -> None:
    clip = turned(0, frames=2)
    clip.translations[1, 0] += led
    assert show_one_pose([clip]) is one


def test_scales_and_expressions_that_change_are_motion() -> None:
    clip = turned(0, frames=2)
    assert show_one_pose([replace(clip, expressions=np.full((2, 3), 0.5))])
    assert not show_one_pose([replace(clip, expressions=np.array([[0.0], [0.1]]))])
    scales = np.array([1.0, 1.2])[:, None, None, None] * np.eye(3)
    assert not show_one_pose([replace(clip, stretches=Stretches(np.array([1]), scales))])
    assert show_one_pose([replace(clip, stretches=Stretches(np.array([1]), scales[[1, 1]]))])
