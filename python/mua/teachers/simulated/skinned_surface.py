"""A character's whole surface in motion, in the world, as its joints alone carry it."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.pose.clip import Clip, Stretches
from mua.rig.animated_scale import stretched
from mua.rig.character import Character
from mua.rig.skinning import Skinning


@dataclass(frozen=True, eq=False)
class MovedSurface:
    """One frame of the dense surface."""

    joints: Array  # [J, 8] dual quaternions, bind pose to world
    dual: Array  # [V, 8] those of the vertices
    places: Array  # [V, 3] world, metres


class SkinnedSurface:
    """The surface as the character's file means it: the linear blend of its joints."""

    def __init__(self, character: Character) -> None:
        self._character = character
        self._skinning = Skinning(character.skin_indices, character.skin_weights)

    def frames(self, clip: Clip) -> Iterator[MovedSurface]:
        """Every frame of `clip`."""
        for frame, joints in enumerate(self._character.skeleton.skinning(clip.rotations, clip.translations)):
            yield self.posed(joints, clip.stretches, frame)

    def posed(
        self,
        joints: Array,  # [J, 8] bind pose to world
        stretches: Stretches | None = None,
        frame: int = 0,  # of the stretches
    ) -> MovedSurface:
        """The surface in one pose."""
        bind = self._character.mesh.vertices
        shape = bind if stretches is None else stretched(self._character, stretches, frame, bind)
        return MovedSurface(joints, self._skinning(joints), self._skinning.linear(joints, shape))

    def carried(
        self,
        joints: Array,  # [J, 8] bind pose to world
        offsets: Array,  # [V, 3] of the vertices, bind pose
    ) -> Array:
        """Offsets [V, 3] in the world."""
        return self._skinning.linear(joints, offsets) - self._skinning.linear(joints, np.zeros_like(offsets))
