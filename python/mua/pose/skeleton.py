"""A skeleton of rigid joints and its forward kinematics."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mua import rotation
from mua.arrays import Array


@dataclass(frozen=True, eq=False)
class Pose:
    """One moment of a character: each joint relative to its parent, and the weights of its expressions."""

    rotations: Array  # [J, 4] local joint rotations, unit, wxyz
    translations: Array  # [J, 3] local joint translations, metres
    expressions: Array | None = None  # [E] weights, 0 to 1 (mua.rig.expressions); None: all 0


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Joints in parent-before-child order; metres, Y up, right-handed; column vectors.

    Every transform is rigid: scales of the source are folded into the mesh. Joint `root` (the hips of
    a person) is the one whose path through the world is the character's.
    """

    names: tuple[str, ...]
    parents: Array  # [J] int32, -1 for a joint without parent
    bind_rotations: Array  # [J, 4] local rotations of the bind pose, unit, wxyz
    bind_translations: Array  # [J, 3] local translations of the bind pose, metres
    root: int

    @property
    def bind_pose(self) -> Pose:
        return Pose(self.bind_rotations, self.bind_translations)

    @cached_property
    def bind_inverse(self) -> Array:
        """[J, 8] dual quaternions from the bind pose's world space to each joint's own."""
        return rotation.dual_inverse(rotation.dual_from_rigid(*self.world(self.bind_rotations, self.bind_translations)))

    @property
    def size(self) -> float:
        """The longest side of the box around the joints of the bind pose, metres; 1 where they are in one point."""
        _, places = self.world(self.bind_rotations, self.bind_translations)
        return float(np.ptp(places, axis=0).max()) or 1.0

    @cached_property
    def generations(self) -> list[tuple[Array, Array]]:
        """Joints with as many others above them, and the parents of these: [n] each, those without parent first."""
        depth = np.zeros(len(self.parents), int)
        for joint, parent in enumerate(self.parents):
            depth[joint] = depth[parent] + 1 if parent >= 0 else 0
        levels = [np.flatnonzero(depth == level) for level in range(depth.max(initial=-1) + 1)]
        return [(joints, self.parents[joints]) for joints in levels]

    def ancestors(self, joint: int) -> list[int]:
        """The joints above one, nearest first."""
        return list(self._ancestors[joint])

    @cached_property
    def _ancestors(self) -> list[list[int]]:
        found: list[list[int]] = []
        for parent in self.parents.tolist():  # parents come before children
            found.append([parent, *found[parent]] if parent >= 0 else [])
        return found

    def with_root(
        self,
        translation: Array,  # [..., 3] local translation of the root joint, metres
    ) -> Array:
        """Local translations [..., J, 3] of the bind pose but for the root joint's, metres."""
        translations = np.tile(self.bind_translations, (*translation.shape[:-1], 1, 1))
        translations[..., self.root, :] = translation
        return translations

    def world(
        self,
        rotations: Array,  # [..., J, 4] local
        translations: Array,  # [..., J, 3] local, metres
    ) -> tuple[Array, Array]:
        """Joint-to-world rotations [..., J, 4] and positions [..., J, 3] (forward kinematics)."""
        turned = np.empty(rotations.shape)
        placed = np.empty((*rotations.shape[:-1], 3))
        for joints, parents in self.generations:
            local, offset = rotations[..., joints, :], translations[..., joints, :]
            if (parents < 0).all():
                turned[..., joints, :], placed[..., joints, :] = local, offset
                continue
            above = turned[..., parents, :]
            turned[..., joints, :] = rotation.multiply(above, local)
            placed[..., joints, :] = placed[..., parents, :] + rotation.rotate(above, offset)
        return turned, placed

    def skinning(
        self,
        rotations: Array,  # [..., J, 4] local
        translations: Array,  # [..., J, 3] local, metres
    ) -> Array:
        """Dual quaternions [..., J, 8] that carry bind-pose points to the posed world."""
        return rotation.dual_multiply(rotation.dual_from_rigid(*self.world(rotations, translations)), self.bind_inverse)
