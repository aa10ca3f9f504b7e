"""The simulated character without simulation and light: what its splats show of the character's own surface."""

from copy import copy
from typing import Self

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Stretches
from mua.pose.skeleton import Pose
from mua.rig.bones import figure_scale
from mua.rig.build import build_rig
from mua.rig.character import Character
from mua.rig.skinning import transform
from mua.teacher import Light, TeacherFrame
from mua.teachers.simulated.chords import straighten
from mua.teachers.simulated.skinned_surface import MovedSurface, SkinnedSurface
from mua.teachers.simulated.smoothing import TURN_WAVELENGTH, low_pass
from mua.teachers.simulated.texels import SurfaceTexels
from mua.texture.surfels import SurfaceFrames


class StillTeacher:
    """Splats of a character that skinning alone moves, in the colours of its textures.

    `rig` is what they stand on, `laid` where and how they lie on it; that pickles, for teachers of other processes.
    """

    def __init__(
        self,
        character: Character,
        *,
        texels: int,
        template_vertices: int = 5000,
        laid: SurfaceTexels | None = None,  # as `laid` of another teacher of the same character and sizes
    ) -> None:
        """Prepare a texture of `texels` x `texels`; seconds of work, fewer with splats that are `laid`."""
        mesh = character.mesh
        self.rig, self._template = build_rig(character, texels=texels, template_vertices=template_vertices)
        self._character = character
        self._skinned = SkinnedSurface(character)
        self._surface = SurfaceFrames(mesh.vertices, mesh.faces)
        self._smooth_turn = low_pass(mesh.vertices, mesh.faces, TURN_WAVELENGTH * figure_scale(mesh.vertices))
        self.laid = SurfaceTexels(character, self.rig) if laid is None else laid

    def corrected(
        self,
        by: Array,  # [N, 9] beside offsets, log scales and albedo (mua.fidelity.fitting)
    ) -> Self:
        """The same teacher with corrections of its splats; this one stays as it is."""
        other = copy(self)
        other.laid = self.laid.corrected(by)
        return other

    def frame(
        self,
        pose: Pose,
        stretches: Stretches | None = None,  # of this frame alone
    ) -> TeacherFrame:
        """One pose; its splats turn and stretch with the surface as the simulated ones do."""
        joints = self._character.skeleton.skinning(pose.rotations, pose.translations)
        return self.frame_on(pose, self._skinned.posed(joints, stretches))

    def frame_on(self, pose: Pose, surface: MovedSurface) -> TeacherFrame:
        """One pose whose joints, and perhaps its cloth, moved the whole surface so."""
        joints, dual, moved = surface.joints, surface.dual, surface.places
        bind = self._character.mesh.vertices
        canonical = transform(rotation.dual_inverse(dual), moved)
        coarse = self._coarse(canonical - bind)
        turn, strain = self._surface(moved)
        turn = rotation.multiply(rotation.conjugate(dual[:, :4]), turn)
        turn = rotation.normalize(self._smooth_turn(_upside(turn)))
        face = self._face(pose)
        if face is not None:  # which moves the surface before joints do, and turns it as sharply as it does
            coarse = coarse + face[self._template]
            moved = moved + self._skinned.carried(joints, face)
            canonical = transform(rotation.dual_inverse(dual), moved)
            face_turn = self._surface(bind + face)[0]
            turn = _upside(rotation.multiply(turn, face_turn))
            strain = self._surface(moved)[1]
        light = self._light(joints, dual, moved, turn)
        texture = self.laid.texture(
            canonical - bind, coarse, turn=turn, moved=moved, dual=dual, strain=strain, light=light
        )
        if face is not None:
            texture[:, :3] += self.laid.leaning(face_turn)
        mesh = (self.rig.mesh.vertices + coarse).astype(np.float32)
        places = self.laid.places
        straighten(texture, self.rig, joints=joints, mesh=mesh, moved=moved, canonical=canonical, places=places)
        return TeacherFrame(pose=pose, mesh=mesh, texture=texture)

    def _face(self, pose: Pose) -> Array | None:
        """How far [V, 3] the pose's expressions move the surface in the bind pose; None where they do not."""
        expressions, weights = self._character.expressions, pose.expressions
        if expressions is None or weights is None or not weights.any():
            return None
        return expressions.displacement(weights, vertices=len(self._character.mesh.vertices))

    def _coarse(self, displacement: Array) -> Array:
        """The part [T, 3] of a displacement [V, 3] that moves the canonical mesh; the texels' offsets take the rest."""
        return np.zeros_like(displacement[self._template])

    def _light(self, joints: Array, dual: Array, moved: Array, turn: Array) -> Light:
        """Light on the surface at `moved` [V, 3], in canonical space."""
        return Light(gain=np.ones_like(moved), sheen=np.zeros_like(moved))


def _upside(q: Array) -> Array:
    """The same rotations [V, 4] with w >= 0."""
    return np.where(q[:, :1] < 0, -q, q)
