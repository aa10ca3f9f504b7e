"""Windows of poses at the time step of a descriptor, whatever rate their clip has."""

import numpy as np

from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.encoding import PoseEncoding
from mua.pose.resample import sample


def window_of(clip: Clip, frame: int, encoding: PoseEncoding) -> Clip:
    """The window of poses that ends at a frame of a clip, newest first, at the encoding's rate."""
    return sample(clip, moments(clip, np.array([frame]), encoding, encoding.window)[0], rate=encoding.rate)


def moments(
    clip: Clip,
    frames: Array,  # [F] int, of the clip
    encoding: PoseEncoding,
    poses: int,
) -> Array:
    """Times of the poses up to each frame, newest first: [F, poses] in frames at the encoding's rate.

    Before its first frame, a clip is held still.
    """
    newest = frames if clip.rate == encoding.rate else frames * (encoding.rate / clip.rate)
    return np.maximum(newest[:, None] - np.arange(poses), 0)
