"""The frames of one clip of an avatar that are exported."""

from dataclasses import dataclass

import numpy as np

from mua.asset.avatar import Avatar
from mua.avatar.decode import Splats, decode_clip_frame
from mua.pose.clip import Clip


@dataclass(frozen=True, eq=False)
class ExportFrames:
    """Frames of a clip, at a steady step, in the order in which they are written."""

    avatar: Avatar
    clip: Clip  # at the rate of the avatar's encoding
    numbers: range  # exported frames; not empty

    @property
    def rate(self) -> float:
        """Exported frames per second."""
        return self.clip.rate / self.numbers.step

    @property
    def poses(self) -> Clip:
        """The poses of the exported frames alone."""
        shown = self.clip.cut(np.array(self.numbers))
        return Clip(self.clip.name, self.rate, shown.rotations, shown.translations)

    def splats(self, number: int) -> Splats:
        """The posed avatar of a frame, in world space."""
        return decode_clip_frame(self.avatar, self.clip, frame=number)
