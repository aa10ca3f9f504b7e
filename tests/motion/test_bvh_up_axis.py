"""BVH files do not state what is up: it is read from where heads are above feet."""

from pathlib import Path

import numpy as np
from bvh_files import with_x_up
from motion.test_bvh import BOUND, PERSON, world_positions, write

from mua.motion.bvh import read_bvh


def test_turns_z_up_to_y_up(tmp_path: Path) -> None:
    z_up = PERSON.replace("OFFSET 1 -9 0", "OFFSET 1 0 -9").replace("OFFSET 0 7 0.5", "OFFSET 0 -0.5 7")
    z_up = z_up.replace("0 9 0 0 0 0 0 0 0 0", "0 0 9 0 0 0 0 0 0 0").replace(
        "1 9.5 -2 10 -20 30 5 6 -7 45", "1 2 9.5 0 0 0 0 0 0 0"
    )
    y_up = PERSON.replace("1 9.5 -2 10 -20 30 5 6 -7 45", "1 9.5 -2 0 0 0 0 0 0 0")
    found, expected = read_bvh(write(tmp_path, z_up), scale=1.0), read_bvh(write(tmp_path, y_up), scale=1.0)
    assert "Y up" in found.notes[0]
    joints = [0, 1, 3]
    np.testing.assert_allclose(world_positions(found)[:, joints], world_positions(expected)[:, joints], atol=BOUND)


def test_turns_x_up_to_y_up(tmp_path: Path) -> None:
    found, as_it_was = read_bvh(write(tmp_path, with_x_up(PERSON))), read_bvh(write(tmp_path, PERSON))
    assert found.notes == ("motion.bvh: X is up; turned to Y up.",)
    x, y, z = np.moveaxis(world_positions(as_it_was), -1, 0)
    np.testing.assert_allclose(world_positions(found), np.stack([-z, y, x], axis=-1), atol=BOUND)


def test_leaves_a_sleeper_on_the_side(tmp_path: Path) -> None:
    lying = PERSON.replace("1 9.5 -2 10 -20 30 5 6 -7 45", "9 1 -2 -90 0 0 0 0 0 0")
    lying = lying.replace("0 9 0 0 0 0 0 0 0 0", "9 1 0 -90 0 0 0 0 0 0")
    motion = read_bvh(write(tmp_path, lying))
    assert motion.notes == ()
    at = world_positions(motion)
    assert (at[:, 3, 0] > at[:, 1, 0]).all()  # the head lies along X


def test_turns_the_place_of_the_root_at_rest_with_the_world(tmp_path: Path) -> None:
    z_up = PERSON.replace("OFFSET 0 0 0", "OFFSET 1 -3 9").replace("OFFSET 1 -9 0", "OFFSET 1 0 -9")
    z_up = z_up.replace("OFFSET 0 7 0.5", "OFFSET 0 -0.5 7").replace("10 -20 30 5 6 -7 45", "0 0 0 0 0 0 0")
    rest = read_bvh(write(tmp_path, z_up), scale=1.0).skeleton
    np.testing.assert_allclose(rest.bind_translations[0], [1, 9, 3], atol=BOUND)


def test_turns_a_camera_s_y_down_to_y_up(tmp_path: Path) -> None:
    y_up = PERSON.replace("1 9.5 -2 10 -20 30 5 6 -7 45", "1 9.5 -2 0 0 0 0 0 0 0")
    y_down = y_up.replace("0 9 0 0 0 0 0 0 0 0", "0 -9 0 0 180 0 0 0 0 0")
    y_down = y_down.replace("1 9.5 -2 0 0 0 0 0 0 0", "1 -9.5 2 0 180 0 0 0 0 0")
    found, expected = read_bvh(write(tmp_path, y_down), scale=1.0), read_bvh(write(tmp_path, y_up), scale=1.0)
    assert found.notes == ("motion.bvh: Y is down; turned to Y up.",)
    np.testing.assert_allclose(world_positions(found), world_positions(expected), atol=BOUND)


def test_leaves_a_handstand_on_its_hands(tmp_path: Path) -> None:
    handstand = PERSON.replace("1 9.5 -2 10 -20 30 5 6 -7 45", "1 9.5 -2 0 180 0 0 0 0 0")
    assert read_bvh(write(tmp_path, handstand)).notes == ()
