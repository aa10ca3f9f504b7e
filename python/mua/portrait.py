"""The camera of every picture that the bake makes: three quarters of the figure's own front."""

import numpy as np

from mua import rotation
from mua.camera import Camera, orbit
from mua.decode import Splats
from mua.motion.descriptor import heading_of
from mua.rendering import frame_bounds
from mua.rig.skeleton import Pose, Skeleton

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
    posed, _ = skeleton.world(pose.rotations, pose.translations)
    bind, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    twist = heading_of(rotation.multiply(posed[skeleton.root], rotation.conjugate(bind[skeleton.root])))
    yaw = 2 * np.arctan2(twist[2], twist[0])
    return orbit(frame_bounds(frame), screen=screen, azimuth=float(yaw + THREE_QUARTER), elevation=float(ABOVE))
