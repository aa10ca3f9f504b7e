"""The camera of every image that the bake makes: three quarters of the figure's own front."""

import numpy as np

from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import Splats
from mua.avatar.rendering import frame_bounds
from mua.motion.facing import front_of
from mua.pose.skeleton import Pose, Skeleton

THREE_QUARTER = np.radians(25)  # from the front
ABOVE = np.radians(8)


def portrait(
    frame: Splats,
    skeleton: Skeleton,
    *,
    pose: Pose,
    screen: tuple[int, int],  # width, height, pixels
) -> Camera:
    """A camera that frames all of the figure."""
    front = front_of(skeleton, pose.rotations, pose.translations)
    return orbit(frame_bounds(frame), screen=screen, azimuth=float(front + THREE_QUARTER), elevation=float(ABOVE))
