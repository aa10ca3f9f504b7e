"""Finds likely mistakes in units or conventions in a rig and its frames.

A check is quiet on everything that may be meant: it compares with the rig, and speaks where half of all numbers are far
off and, for what is refused, where one known mistake explains them.
"""

from collections.abc import Iterator

import numpy as np

from mua.arrays import Array
from mua.pose.skeleton import Pose
from mua.recording.plausible.finding import Finding, LikelyMistake
from mua.recording.plausible.mesh import Meshes
from mua.recording.plausible.orientation import Orientations
from mua.recording.plausible.pose import Poses
from mua.recording.plausible.rig import rig_findings
from mua.recording.plausible.texture import Textures
from mua.rig.rig import Rig

__all__ = ["Finding", "LikelyMistake", "Plausible", "rig_findings"]


class Plausible:
    """The frames of one rig."""

    def __init__(self, rig: Rig) -> None:
        size = float(np.ptp(rig.mesh.vertices, axis=0).max())
        self._poses, self._meshes, self._textures = Poses(rig.skeleton, size), Meshes(rig, size), Textures(rig, size)
        self._orientations = Orientations(rig)

    def pose(self, pose: Pose) -> Iterator[Finding]:
        """Likely mistakes in a pose of the right shapes."""
        return self._poses(pose)

    def mesh(
        self,
        pose: Pose,
        mesh: Array,  # [V, 3]
    ) -> Iterator[Finding]:
        """Likely mistakes in a mesh of the right shape."""
        return self._meshes(mesh, pose)

    def frame(
        self,
        pose: Pose,
        mesh: Array,  # [V, 3]
        texture: Array,  # [N, 23] at the valid texels
        image: Array | None = None,  # [H, W, 23] that it was taken from
    ) -> Iterator[Finding]:
        """Likely mistakes in a mesh and texture of the right shapes."""
        yield from self.mesh(pose, mesh)
        yield from self._textures(texture, mesh)
        yield from self._orientations(texture, mesh, pose, image)
