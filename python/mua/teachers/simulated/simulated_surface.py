"""A character's whole surface in motion, in the world: what is loose hangs and swings."""

from collections.abc import Iterator

import numpy as np

from mua import rotation
from mua.pose.clip import Clip
from mua.rig.bones import fit_bones
from mua.rig.character import Character
from mua.rig.skinning import Skinning, transform
from mua.rig.stretched import stretched
from mua.teachers.simulated.folds import Folds
from mua.teachers.simulated.looseness import estimate_looseness
from mua.teachers.simulated.simulation import Simulation
from mua.teachers.simulated.surface import MovedSurface


class SimulatedSurface:
    """The surface whose loose parts hang and swing; `bones` are the solid volumes within it."""

    def __init__(self, character: Character, *, seed: int = 0) -> None:
        """The seed chooses where the character's cloth folds."""
        mesh = character.mesh
        looseness = estimate_looseness(character) if character.looseness is None else character.looseness
        self.bones = fit_bones(character, looseness)
        self._character = character
        self._skinning = Skinning(character.skin_indices, character.skin_weights)
        self._simulation = Simulation(mesh.vertices, mesh.faces, looseness=looseness, bones=self.bones)
        rng = np.random.default_rng(seed)
        self._folds = Folds(mesh.vertices, mesh.faces, looseness=looseness, rng=rng)

    def frames(self, clip: Clip) -> Iterator[MovedSurface]:
        """Simulate `clip` from rest in its first pose."""
        character = self._character
        for frame, joints in enumerate(character.skeleton.skinning(clip.rotations, clip.translations)):
            dual = self._skinning(joints)
            turn, ends = dual[:, :4], self.bones.posed(joints)
            target = self._folds(self._skinning.linear(joints, character.mesh.vertices), turn)
            if frame == 0:
                self._simulation.settle(target, turn, ends)
            moved = self._simulation.advance(target, turn, ends, seconds=1 / clip.rate)
            if clip.stretches is not None:
                canonical = transform(rotation.dual_inverse(dual), moved)
                moved = transform(dual, stretched(character, clip.stretches, frame, canonical))
            yield MovedSurface(joints, dual, moved)
