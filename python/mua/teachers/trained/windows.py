"""A teacher's input for a frame: a window of poses, as joints and as motion descriptors."""

from dataclasses import dataclass

import numpy as np
import torch
from numpy.lib.stride_tricks import sliding_window_view
from torch import Tensor

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.descriptor import describe, heading_of
from mua.pose.encoding import PoseEncoding
from mua.pose.resample import sample
from mua.pose.skeleton import Skeleton
from mua.pose.windows import moments


@dataclass(frozen=True, eq=False)
class Window:
    """k poses, newest first."""

    joints: Tensor  # [k, J, 8] bind pose to world
    descriptors: Tensor  # [k, D] of mua.pose.descriptor
    root: Tensor  # [3] of the newest, world, metres
    back: Tensor  # [4] the rotation that removes the newest pose's heading

    def to(self, device: torch.device) -> "Window":
        """On a device."""
        return Window(*(getattr(self, name).to(device) for name in ("joints", "descriptors", "root", "back")))


def windows(
    skeleton: Skeleton,
    encoding: PoseEncoding,
    clip: Clip,
    *,
    every: int = 1,
) -> list[Window]:
    """The window of every frame, or of every so many; poses are the encoding's time step apart at any rate of the clip.

    Before its first frame, a clip is held still.
    """
    size, frames = encoding.window, np.arange(0, len(clip), every)
    wanted = moments(clip, frames, encoding, 2 * size - 1)  # the oldest pose of a window has a descriptor as well
    times, place = np.unique(wanted, return_inverse=True)
    place, poses = place.reshape(wanted.shape), sample(clip, times, rate=encoding.rate)
    joints = skeleton.skinning(poses.rotations, poses.translations)
    of_windows = sliding_window_view(place, size, axis=1).reshape(-1, size)
    described = describe(skeleton, encoding, poses.rotations, poses.translations, windows=of_windows)
    _, placed = skeleton.world(poses.rotations, poses.translations)
    back = rotation.conjugate(heading_of(joints[:, skeleton.root, :4]))  # the turn from bind to now
    descriptors = described.reshape(len(frames), size, -1)
    rows, newest = place[:, :size], place[:, 0]
    columns = (joints[rows], descriptors, placed[newest, skeleton.root], back[newest])
    return [Window(*of_frame) for of_frame in zip(*map(_tensor, columns), strict=True)]


def _tensor(values: Array) -> Tensor:
    return torch.from_numpy(np.ascontiguousarray(values)).float()
