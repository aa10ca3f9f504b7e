"""The teacher protocol: anything that yields pose, canonical mesh and Gaussian texture, frame by frame; its light."""

from collections.abc import Container, Iterator
from dataclasses import dataclass
from typing import Protocol

from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose
from mua.rig.rig import Rig


@dataclass(frozen=True, eq=False)
class Light:
    """Light that a surface sends out, by vertex, in world space."""

    gain: Array  # [V, 3 rgb] display value over albedo
    sheen: Array  # [V, 3 xyz] gradient of the display value over the unit direction from camera to surface


@dataclass(frozen=True, eq=False)
class TeacherFrame:
    """One frame of a teacher."""

    pose: Pose
    mesh: Array  # [V, 3] float32 canonical template vertices, metres
    texture: Array  # [N, 23] float32 raw channels (mua.channels) at the valid texels of the map


class Teacher(Protocol):
    """A source of frames; `rig` says what they are frames of."""

    @property
    def rig(self) -> Rig: ...

    def frames(self, clip: Clip, wanted: Container[int]) -> Iterator[TeacherFrame | Pose]:
        """Yield, for each frame of `clip` in order, a whole frame where `wanted` holds its index, else the pose."""
        ...
