"""Windows of poses: newest first, at the descriptor's rate, held at a clip's first pose."""

import numpy as np

from mua.pose.clip import Clip
from mua.pose.encoding import PoseEncoding
from mua.pose.windows import window_of

FRAMES = 9
ENCODING = PoseEncoding(joints=(), rate=30.0, window=3)


def moving(rate: float) -> Clip:
    """A joint whose place along x is the number of the frame."""
    rotations = np.tile([1.0, 0, 0, 0], (FRAMES, 1, 1))
    return Clip("walk", rate, rotations, np.arange(FRAMES)[:, None, None] * np.array([1.0, 0, 0]))


def shown(rate: float, frame: int) -> list[float]:
    return [float(place) for place in window_of(moving(rate), frame, ENCODING).translations[:, 0, 0]]


def test_the_newest_pose_comes_first_and_all_are_a_step_apart() -> None:
    assert shown(30.0, 5) == [5, 4, 3]
    assert shown(60.0, 8) == [8, 6, 4]
    assert shown(15.0, 4) == [4, 3.5, 3]


def test_a_clip_is_still_before_its_first_pose() -> None:
    assert shown(30.0, 1) == [1, 0, 0]
    assert shown(60.0, 1) == [1, 0, 0]
