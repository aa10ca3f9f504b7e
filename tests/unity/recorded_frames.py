"""Frames that the C# records, replayed and unpacked."""

from collections.abc import Sequence

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.avatar.camera import NEAR, Camera

MIRROR = np.diag([-1.0, 1, 1, 1])  # Unity's left-handed world to the kernels'


def eye_lines(cameras: Sequence[Camera], *, instances: int = 1) -> list[str]:
    """The lines of a scenario that set the eyes: Unity's matrices; an indirect draw is of so many instances."""
    lines = ["screen {} {} {} {}".format(*cameras[0].screen, NEAR, instances)]
    for camera in cameras:
        numbers = np.concatenate([(camera.view @ MIRROR).ravel(), camera.projection.ravel()])
        lines.append("eye " + " ".join(repr(float(number)) for number in numbers))
    return lines


def place_of(numbers: tuple[float, ...]) -> Array:
    """The rigid dual quaternion of a Unity position and rotation, in the kernels' world; the size comes before it."""
    x, y, z, *turn, _ = np.asarray(numbers, np.float32).astype(float)
    i, j, k, w = turn
    return rotation.dual_from_rigid(rotation.normalize(np.array([w, i, -j, -k])), np.array([-x, y, z]))
