"""When points of feet stand, at any size and rate."""

import numpy as np
import pytest

from mua.arrays import Array
from mua.motion.contacts import floor_of, planted

FRAMES = 30


def foot(low: slice, *, size: float = 1.0, pace: float = 0.0, rate: float = 30.0) -> Array:
    """Places [F, 1, 3] of a foot that is on the floor in some frames, and moves along it there at so many m/s."""
    places = np.zeros((FRAMES, 1, 3))
    places[:, 0, 1] = 0.3
    places[low, 0, 1] = 0
    places[:, 0, 0] = pace / rate * np.arange(FRAMES)
    return size * places


@pytest.mark.parametrize(("rate", "frames", "stands"), [(30.0, 2, False), (30.0, 4, True), (120.0, 9, False)])
def test_a_foot_that_is_down_for_a_moment_passes(rate: float, frames: int, stands: bool) -> None:
    """A foot stands where it is down for at least a tenth of a second."""
    found = planted(foot(slice(10, 10 + frames), rate=rate), rate, 0.9)[:, 0]
    assert found[10 : 10 + frames].tolist() == [stands] * frames
    assert found.sum() == stands * frames


@pytest.mark.parametrize("size", [0.1, 1.0, 10.0])
@pytest.mark.parametrize(("pace", "stands"), [(0.2, True), (0.5, False)])
def test_a_foot_slides_by_legs_a_second(size: float, pace: float, stands: bool) -> None:
    found = planted(foot(slice(5, 25), size=size, pace=pace), 30.0, 0.9 * size)[:, 0]
    assert found[5:25].all() == found.any() == stands


@pytest.mark.parametrize("size", [0.1, 1.0, 10.0])
def test_a_rest_pose_near_the_floor_stands_on_it(size: float) -> None:
    heights = np.linspace(0, 1.7, 5)[:, None] * [0, 1, 0]
    assert floor_of(size * np.add(heights, (0, 0.1, 0))) == 0
    assert floor_of(size * np.add(heights, (0, 0.3, 0))) == pytest.approx(0.3 * size)
