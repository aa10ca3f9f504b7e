"""What a teacher reads of a frame: a window of poses, as joints and as motion descriptors."""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mua import rotation
from mua.pose.clip import Clip
from mua.pose.descriptor import describe, heading_of
from mua.pose.encoding import PoseEncoding
from mua.pose.skeleton import Skeleton


@dataclass(frozen=True, eq=False)
class Window:
    """k poses, newest first."""

    joints: Tensor  # [k, J, 8] bind pose to world
    descriptors: Tensor  # [k, D] of mua.pose.descriptor
    root: Tensor  # [3] of the newest, world, metres
    back: Tensor  # [4] the turn that takes the heading of the newest back

    def to(self, device: torch.device) -> "Window":
        """On a device."""
        return Window(*(getattr(self, name).to(device) for name in ("joints", "descriptors", "root", "back")))


def windows(skeleton: Skeleton, encoding: PoseEncoding, clip: Clip) -> list[Window]:
    """The window of every frame; before its first frame, a clip is held still."""
    joints = skeleton.skinning(clip.rotations, clip.translations)
    descriptors = describe(skeleton, encoding, clip.rotations, clip.translations)
    _, placed = skeleton.world(clip.rotations, clip.translations)
    back = rotation.conjugate(heading_of(joints[:, skeleton.root, :4]))  # the turn from bind to now
    columns = [torch.from_numpy(np.ascontiguousarray(values)).float() for values in (joints, descriptors)]
    newest = [torch.from_numpy(values).float() for values in (placed[:, skeleton.root].copy(), back)]
    rows = [encoding.frames(frame) for frame in range(len(clip))]
    return [
        Window(*(column[row] for column in columns), *(column[frame] for column in newest))
        for frame, row in enumerate(rows)
    ]
