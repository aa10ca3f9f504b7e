"""Motion as a file holds it: a clip on the file's own skeleton, not yet on the character's."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton


@dataclass(frozen=True)
class SourceMotion:
    """A clip and the skeleton that it was recorded on; the skeleton's bind pose is the rest pose of the file."""

    skeleton: Skeleton
    clip: Clip
    notes: tuple[str, ...] = ()  # decisions of the reader that the user should know, a sentence each
    stated: Mapping[str, str] = field(default_factory=dict)  # joint to role, where the file itself says it
    expressions: tuple[str, ...] = ()  # names of those that the clip holds weights of

    def places(self, poses: int) -> Array:
        """Where the joints are [P, J, 3] in at most `poses` frames, spread over the clip."""
        frames = np.unique(np.linspace(0, len(self.clip) - 1, poses).astype(int))
        return self.skeleton.world(self.clip.rotations[frames], self.clip.translations[frames])[1]
