"""How a pose window becomes the motion descriptor that the coefficient MLPs read (paper, Sec. Data Assumption)."""

from dataclasses import dataclass
from typing import NamedTuple

from mua.arrays import Array

RATE = 30.0  # frames per second between the poses of a window: in every teacher, recording, file and player


class Part(NamedTuple):
    """Consecutive numbers of a descriptor that describe one thing."""

    joint: int | None  # None: the root
    width: int
    lengths: bool = False  # metres, not entries of a rotation
    world: bool = False  # a joint's rotation in the world, not in its parent


@dataclass(frozen=True)
class PoseEncoding:
    """The declared form of the motion descriptor, stored in every recording and asset.

    First, how `joints` are turned in the world in frame f, relative to the bind pose (6D each): light follows it. Then
    per frame of the window, newest first (f, f-1, f-2): the root joint's world position relative to frame f (3), the
    root joint's world rotation relative to its bind rotation (6D), the local rotations of `joints` (6D each) and the
    local translations of `translated` relative to those of the bind pose (3 each), metres. With
    `remove_heading`, positions and rotations in the world are turned back by the yaw of frame f.
    """

    joints: tuple[int, ...]  # joints encoded beside the root, ascending, root excluded
    rate: float  # frames per second between the frames of a window
    window: int = 3  # k
    remove_heading: bool = True
    translated: tuple[int, ...] = ()  # joints whose translation is encoded, ascending, root excluded

    @property
    def parts(self) -> tuple[Part, ...]:
        """All parts in order."""
        turned = (Part(joint, 6, world=True) for joint in self.joints)
        local = (Part(joint, 6) for joint in (None, *self.joints))
        moved = (Part(joint, 3, lengths=True) for joint in self.translated)
        frame = (Part(None, 3, lengths=True), *local, *moved)
        return *turned, *(frame * self.window)

    @property
    def width(self) -> int:
        """D, the length of a descriptor."""
        return sum(part.width for part in self.parts)

    def frames(self, index: int) -> list[int]:
        """The frames of the window that ends at `index`, newest first; before its first frame, a clip is held still."""
        return [max(index - age, 0) for age in range(self.window)]


@dataclass(frozen=True, eq=False)
class Normalization:
    """Mean and scale of a descriptor: (d - mean) / scale."""

    mean: Array  # [D]
    scale: Array  # [D], > 0


@dataclass(frozen=True, eq=False)
class Components:
    """Principal components of the normalised descriptor, and how far each may go: what the networks read.

    Within `ranges`, where training was, a component is as it is; beyond, it approaches `margins` past the range and
    never exceeds it. So a network is never asked far from where it was trained, whatever the pose.
    """

    normalization: Normalization
    directions: Array  # [K, D]
    ranges: Array  # [2, K] lowest and highest value in training
    margins: Array  # [K], 0 or more
