"""A clip of motion on one skeleton."""

from dataclasses import dataclass, replace
from typing import Self

from mua.arrays import Array
from mua.rig.skeleton import Pose


@dataclass(frozen=True)
class Clip:
    """Poses at a steady rate; local rotations and translations of every joint."""

    name: str
    rate: float  # frames per second
    rotations: Array  # [F, J, 4] local joint rotations, unit, wxyz
    translations: Array  # [F, J, 3] local joint translations, metres

    def __len__(self) -> int:
        return len(self.rotations)

    def pose(self, index: int) -> Pose:
        return Pose(self.rotations[index], self.translations[index])

    def cut(self, frames: slice | Array) -> Self:
        """The same clip with these frames alone."""
        return replace(self, rotations=self.rotations[frames], translations=self.translations[frames])
