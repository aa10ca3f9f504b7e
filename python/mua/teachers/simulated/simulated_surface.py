"""A character's whole surface in motion, in the world: what is loose hangs and swings."""

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Clip
from mua.rig.animated_scale import stretched
from mua.rig.bones import figure_scale, fit_bones
from mua.rig.character import Character
from mua.rig.skinning import Skinning, transform
from mua.teachers.simulated.folds import Folds
from mua.teachers.simulated.looseness import estimate_looseness
from mua.teachers.simulated.simulation import Simulation, hangs
from mua.teachers.simulated.skinned_surface import MovedSurface


class SimulatedSurface:
    """The surface whose loose parts hang and swing; `bones` are the solid volumes within it."""

    def __init__(self, character: Character, *, seed: int = 0) -> None:
        """The seed chooses where the character's cloth folds."""
        mesh = character.mesh
        looseness = estimate_looseness(character) if character.looseness is None else character.looseness
        self.bones = fit_bones(character, looseness)
        self._character = character
        self._skinning = Skinning(character.skin_indices, character.skin_weights)
        loose = mesh.faces[hangs(looseness)[mesh.faces].any(axis=1)]  # all else is rigid, mostly two thirds of a figure
        self._hanging, corners = np.unique(loose, return_inverse=True)
        if not len(loose):
            return
        places, faces = mesh.vertices[self._hanging], corners.reshape(loose.shape)
        own, scale = looseness[self._hanging], figure_scale(mesh.vertices)
        self._carried = Skinning(character.skin_indices[self._hanging], character.skin_weights[self._hanging])
        self._simulation = Simulation(places, faces, looseness=own, bones=self.bones, scale=scale)
        self._folds = Folds(places, faces, looseness=own, rng=np.random.default_rng(seed), scale=scale)

    def frames(self, clip: Clip) -> Iterator[MovedSurface]:
        """Simulate `clip` from rest in its first pose."""
        return (complete() for complete in self.played(clip))

    def played(self, clip: Clip) -> Iterator[Callable[[], MovedSurface]]:
        """The same frames; what does not hang is computed only of those that are called."""
        for frame, joints in enumerate(self._character.skeleton.skinning(clip.rotations, clip.translations)):
            hanging = self._advance(joints, 1 / clip.rate, first=frame == 0) if len(self._hanging) else np.empty((0, 3))
            yield partial(self._complete, clip, frame, joints, hanging)

    def _advance(self, joints: Array, seconds: float, *, first: bool) -> Array:
        """Where [K, 3] what hangs is `seconds` later, when joints [J, 8] are there."""
        turn, ends = self._carried(joints)[:, :4], self.bones.posed(joints)
        target = self._folds(self._carried.linear(joints, self._character.mesh.vertices[self._hanging]), turn)
        if first:
            self._simulation.settle(target, turn, ends)
        return self._simulation.advance(target, turn, ends, seconds=seconds)

    def _complete(
        self,
        clip: Clip,
        frame: int,
        joints: Array,  # [J, 8] bind pose to world
        hanging: Array,  # [K, 3] where what hangs is
    ) -> MovedSurface:
        """The whole surface of one frame."""
        dual = self._skinning(joints)
        moved = self._skinning.linear(joints, self._character.mesh.vertices)
        moved[self._hanging] = hanging
        if clip.stretches is not None:
            canonical = transform(rotation.dual_inverse(dual), moved)
            moved = transform(dual, stretched(self._character, clip.stretches, frame, canonical))
        return MovedSurface(joints, dual, moved)
