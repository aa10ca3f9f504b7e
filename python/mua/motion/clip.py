"""A clip of motion on one skeleton."""

from dataclasses import dataclass

from mua.arrays import Array
from mua.rig.skeleton import Pose


@dataclass(frozen=True)
class Clip:
    """Poses at a steady rate; local rotations of every joint and the local translation of the root joint."""

    name: str
    rate: float  # frames per second
    rotations: Array  # [F, J, 4] local joint rotations, unit, wxyz
    translation: Array  # [F, 3] local translation of the skeleton's root joint, metres

    def __len__(self) -> int:
        return len(self.rotations)

    def pose(self, index: int) -> Pose:
        return Pose(self.rotations[index], self.translation[index])
