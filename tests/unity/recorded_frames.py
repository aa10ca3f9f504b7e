"""Frames that the C# records, replayed and unpacked."""

from pathlib import Path

import numpy as np

from mua import rotation
from mua.arrays import Array

MIRROR = np.diag([-1.0, 1, 1, 1])  # Unity's left-handed world to the kernels'

STAND_INS = Path(__file__).parent / "stand_ins"


def place_of(numbers: tuple[float, ...]) -> Array:
    """The rigid dual quaternion of a Unity position and rotation, in the kernels' world; the size comes before it."""
    x, y, z, *turn, _ = np.asarray(numbers, np.float32).astype(float)
    i, j, k, w = turn
    return rotation.dual_from_rigid(rotation.normalize(np.array([w, i, -j, -k])), np.array([-x, y, z]))
