"""Rotations against SciPy's."""

import numpy as np
from scipy.spatial.transform import Rotation

from mua import rotation

HALF_TURNS = np.array([[0.0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1], [0, 0.6, 0.8, 0]])
NEARLY = np.array([1e-9, 0, 0, 0])
BOUND = 32 * np.finfo(float).eps


def test_a_matrix_becomes_its_quaternion_of_positive_w() -> None:
    """Everywhere, also where it turns by half a turn or nearly so about any axis."""
    drawn = rotation.normalize(np.random.default_rng(0).normal(size=(500, 4)))
    near = rotation.normalize(np.concatenate([HALF_TURNS + NEARLY, HALF_TURNS - NEARLY]))
    for q in (drawn, near):
        found = rotation.from_matrix(Rotation.from_quat(q, scalar_first=True).as_matrix())
        np.testing.assert_allclose(found, np.where(q[:, :1] < 0, -q, q), rtol=0, atol=BOUND)
        assert (found[:, 0] >= 0).all()
