"""A rest pose that is some moment of a clip gives way to the start of a clip."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import BIND, PARENTS, at, moving, scene
from scipy.spatial.transform import Rotation

from mua.characters.rest_pose import plausible_rest
from mua.scene import Motion, Scene


def begun(*degrees: float) -> Scene:
    """The scene with clips whose heads begin turned by so many degrees from the rest pose."""
    return replace(scene(), motions=tuple(turned_from(angle) for angle in degrees))


def turned_from(degrees: float) -> Motion:
    motion = moving(BIND, PARENTS)
    worlds = motion.worlds.copy()
    worlds[:, 2] = worlds[:, 2] @ at(0, 0, 0, Rotation.from_euler("y", degrees, degrees=True))
    return replace(motion, worlds=worlds)


@pytest.mark.parametrize("degrees", [(), (0,), (100,), (-110,), (170, 100, 90)])
def test_a_rest_pose_near_which_most_clips_begin_is_kept(degrees: tuple[float, ...]) -> None:
    whole = begun(*degrees)
    assert plausible_rest(whole, np.arange(5)) is whole.rest


def test_else_the_start_most_like_the_others_takes_its_place() -> None:
    whole = begun(90, 150, 160, 170, 230)
    np.testing.assert_array_equal(plausible_rest(whole, np.arange(5)), whole.motions[2].worlds[0])
