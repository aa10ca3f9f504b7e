"""Where texels are straightened: about the vertices of bent triangles, so that no gap opens beside them."""

import numpy as np

from mua import rotation
from mua.teachers.simulated.chords import bent

STRIP = np.array([[0.0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [2, 0, 0], [2, 1, 0]])
FACES = np.array([[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]])


def test_a_flat_triangle_beside_a_bent_one_is_straightened_as_far_along_their_common_edge() -> None:
    turns = np.tile([1.0, 0, 0, 0], (6, 1))
    turns[:2] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.array([1.5]))  # the left end is twisted
    shares = bent(rotation.dual_from_rigid(turns, np.zeros((6, 3))), STRIP, FACES, size=2.0)
    np.testing.assert_array_equal(shares[:4], 1)  # of both bent triangles, and so of the next one's near edge
    np.testing.assert_array_equal(shares[4:], 0)


def test_nothing_is_straightened_at_rest() -> None:
    still = rotation.dual_from_rigid(np.tile([1.0, 0, 0, 0], (6, 1)), np.zeros((6, 3)))
    np.testing.assert_array_equal(bent(still, STRIP, FACES, size=2.0), 0)
