"""The body's path: its lowest point is on the floor, and stays where it stands while the body moves over it."""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.range.angles import INDEX
from mua.motion.range.body import BODY, JOINT
from mua.pose.joint_names import SIDES

# joint, a point in its axes, and how far the skin is from it; metres
_CENTRAL = (
    *(("hips", (0, -0.02, -0.05), 0.09), ("spine 3", (0, 0, -0.04), 0.1), ("spine 3", (0, 0.05, 0.04), 0.09)),
    *(("head", (0, 0.1, 0), 0.1), ("hips", (0, 0, 0.04), 0.09)),
)
_SIDED = (
    *(("upper_arm", (0, 0, 0), 0.06), ("forearm", (0, 0, 0), 0.04), ("hand", (0, -0.08, 0), 0.03)),
    *(("hand", (0, 0, 0), 0.03), ("thigh", (0, 0, -0.03), 0.09), ("shin", (0, 0, 0), 0.055)),
    *(("foot", (0, -0.04, -0.05), 0.04), ("toe", (0, 0, 0), 0.02), ("toe", (0, 0, 0.07), 0.015)),
)
TOUCHING = [*_CENTRAL, *((f"{side} {joint}", at, skin) for side in SIDES for joint, at, skin in _SIDED)]


def path(local: Array, angles: Array) -> Array:
    """Positions of the hips [F, 3], metres, while the body's joints are turned by `local` [F, J, 4]."""
    turned, at = BODY.world(local, BODY.with_root(np.zeros((len(local), 3))))
    joints = [JOINT[joint] for joint, *_ in TOUCHING]
    points = at[:, joints] + rotation.rotate(turned[:, joints], np.array([point for _, point, _ in TOUCHING]))
    heights = points[..., 1] - [skin for *_, skin in TOUCHING]
    hips = np.zeros((len(local), 3))
    hips[:, 1] = angles[:, INDEX["hop"]] - heights.min(axis=1)
    lowest = np.argmin(heights[1:] + heights[:-1], axis=1)
    frames = np.arange(len(lowest))
    moved = points[frames, lowest] - points[frames + 1, lowest]
    hips[1:, [0, 2]] = np.cumsum(moved, axis=0)[:, [0, 2]]
    return hips
