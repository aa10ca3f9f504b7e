"""How a pose window becomes the motion descriptor that the coefficient MLPs read (paper, Sec. Data Assumption)."""

from dataclasses import dataclass
from typing import NamedTuple

from mua.arrays import Array


class Part(NamedTuple):
    """Numbers of a descriptor that belong together."""

    joint: int | None  # None: the root
    width: int
    lengths: bool  # metres, not entries of a rotation


@dataclass(frozen=True)
class PoseEncoding:
    """The declared form of the motion descriptor, stored in every recording and asset.

    Per frame of the window, newest first (f, f-1, f-2): the root joint's world position relative to frame f (3), the
    world rotations of the root joint and of `joints` relative to the bind pose (6D each), and the local translations of
    `translated` relative to the bind pose (3 each), metres. Rotations are those of the world because light and gravity
    act there. With `heading`, root positions and rotations are turned back by the yaw of frame f.
    """

    joints: tuple[int, ...]  # joints encoded beside the root, ascending, root excluded
    rate: float  # frames per second between the frames of a window
    window: int = 3  # k
    heading: bool = True
    translated: tuple[int, ...] = ()  # joints whose translation is encoded, ascending, root excluded

    @property
    def parts(self) -> tuple[Part, ...]:
        """What stands for one frame, in order."""
        turns = (Part(joint, 6, lengths=False) for joint in (None, *self.joints))
        moves = (Part(joint, 3, lengths=True) for joint in self.translated)
        return Part(None, 3, lengths=True), *turns, *moves

    @property
    def width(self) -> int:
        """k x D, the length of a descriptor."""
        return self.window * sum(part.width for part in self.parts)

    def frames(self, index: int) -> list[int]:
        """The frames of the window that ends at `index`, newest first; before its first frame, a clip is held still."""
        return [max(index - age, 0) for age in range(self.window)]


@dataclass(frozen=True, eq=False)
class Normalization:
    """Mean and scale of a descriptor: (d - mean) / scale."""

    mean: Array  # [k D]
    scale: Array  # [k D], > 0


@dataclass(frozen=True, eq=False)
class Components:
    """Principal components of the normalised descriptor, and how far each may go: what the networks read.

    Within `ranges`, where training was, a component is as it is; beyond, it approaches `margins` past the range and
    never exceeds it. So a network is never asked far from where it was trained, whatever the pose.
    """

    normalization: Normalization
    directions: Array  # [K, k D]
    ranges: Array  # [2, K] lowest and highest value in training
    margins: Array  # [K], 0 or more
