"""The simulated character: a teacher made of a rigged, textured character, motion and position-based dynamics.

It stands in for a captured teacher. Its surface follows the linear blend of joints that the character's file means, and
is defined in canonical space: the simulated vertices are brought back to the bind pose by the dual quaternions that
carry the avatar's texels, and a texel lies at a fixed point of that surface. What of the deformation is longer than
about 20 cm goes into the canonical mesh, the rest into the texels' offsets; posed by T_tex, both together are the
teacher's surface. Scales that a clip animates, which rigid joints do not carry, are put on in canonical space, after
the dynamics.
"""

from collections.abc import Container, Iterator

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Clip
from mua.pose.descriptor import heading_of
from mua.pose.skeleton import Pose
from mua.rig.carriers import carry_texels
from mua.rig.character import Character
from mua.rig.rig import Rig
from mua.rig.stretched import stretched
from mua.rig.template import make_template
from mua.teachers.bones import figure_scale, fit_bones
from mua.teachers.chords import straighten
from mua.teachers.folds import Folds
from mua.teachers.light import Light
from mua.teachers.looseness import estimate_looseness
from mua.teachers.shading import shade, visibility
from mua.teachers.simulation import Simulation
from mua.teachers.skinning import Skinning, transform
from mua.teachers.smoothing import TURN_WAVELENGTH, low_pass
from mua.teachers.teacher import TeacherFrame
from mua.teachers.texels import SurfaceTexels
from mua.texture.surfels import SurfaceFrames, vertex_normals

COARSE_WAVELENGTH = 0.2  # metres on a person: longer deformation moves the canonical mesh, shorter the offsets


class SimulatedTeacher:
    """Teacher frames of a character (mua.teachers.teacher); `rig` is the template that they stand on."""

    def __init__(self, character: Character, *, texels: int, template_vertices: int = 5000, seed: int = 0) -> None:
        """Prepare a texture of `texels` x `texels`; the seed chooses where the character's cloth folds."""
        mesh = character.mesh
        template = make_template(character, vertices=template_vertices)
        carried = carry_texels(character, template, size=texels)
        self.notes = carried.notes  # what is left out, a sentence each
        self.rig = Rig(
            skeleton=character.skeleton,
            mesh=template.mesh,
            skin_indices=template.skin_indices,
            skin_weights=template.skin_weights,
            texels=carried.kept,
        )
        self._character = character
        self._template = template.source_vertices
        looseness = estimate_looseness(character) if character.looseness is None else character.looseness
        self._bones = fit_bones(character, looseness)
        self._skinning = Skinning(character.skin_indices, character.skin_weights)
        self._simulation = Simulation(mesh.vertices, mesh.faces, looseness=looseness, bones=self._bones)
        rng = np.random.default_rng(seed)
        self._folds = Folds(mesh.vertices, mesh.faces, looseness=looseness, rng=rng)
        self._surface = SurfaceFrames(mesh.vertices, mesh.faces)
        self._normals = vertex_normals(mesh.vertices, mesh.faces)
        scale = figure_scale(mesh.vertices)
        self._coarse = low_pass(mesh.vertices, mesh.faces, COARSE_WAVELENGTH * scale)
        self._smooth_turn = low_pass(mesh.vertices, mesh.faces, TURN_WAVELENGTH * scale)
        self._texels = SurfaceTexels(character, self.rig)

    def frames(self, clip: Clip, wanted: Container[int]) -> Iterator[TeacherFrame | Pose]:
        """Simulate `clip` from rest in its first pose; yield whole frames where wanted, else poses."""
        character, bones = self._character, self._bones
        skinning = character.skeleton.skinning(clip.rotations, clip.translations)
        for frame, joints in enumerate(skinning):
            dual = self._skinning(joints)
            turn, ends = dual[:, :4], bones.posed(joints)
            target = self._folds(self._skinning.linear(joints, character.mesh.vertices), turn)
            if frame == 0:
                self._simulation.settle(target, turn, ends)
            moved = self._simulation.advance(target, turn, ends, seconds=1 / clip.rate)
            if clip.stretches is not None:
                canonical = transform(rotation.dual_inverse(dual), moved)
                moved = transform(dual, stretched(character, clip.stretches, frame, canonical))
            pose = Pose(clip.rotations[frame], clip.translations[frame])
            yield self._whole(pose, joints, dual, moved) if frame in wanted else pose

    def _whole(self, pose: Pose, joints: Array, dual: Array, moved: Array) -> TeacherFrame:
        """The frame whose dense surface, posed by `dual` [V, 8], lies at `moved` [V, 3]."""
        bind = self._character.mesh.vertices
        displacement = transform(rotation.dual_inverse(dual), moved) - bind
        coarse = self._coarse(displacement)[self._template]
        back = rotation.conjugate(dual[:, :4])
        turn, strain = self._surface(moved)
        turn = rotation.multiply(back, turn)
        turn = rotation.normalize(self._smooth_turn(np.where(turn[:, :1] < 0, -turn, turn)))
        texture = self._texels.texture(
            displacement,
            coarse,
            turn=turn,
            moved=moved,
            strain=strain,
            light=self._light(joints, dual, moved, turn),
        )
        mesh = (self.rig.mesh.vertices + coarse).astype(np.float32)
        canonical, places = bind + displacement, self._texels.places
        straighten(texture, self.rig, joints=joints, mesh=mesh, moved=moved, canonical=canonical, places=places)
        return TeacherFrame(pose=pose, mesh=mesh, texture=texture)

    def _light(self, joints: Array, dual: Array, moved: Array, turn: Array) -> Light:
        """Light on the surface at `moved` [V, 3], brought to canonical space."""
        normals = rotation.rotate(rotation.multiply(dual[:, :4], turn), self._normals)
        visible = visibility(moved, normals, self._bones.posed(joints), self._bones.radii)
        heading = heading_of(joints[self._character.skeleton.root, :4])
        light = shade(normals, visible, heading=heading)
        return Light(gain=light.gain, sheen=rotation.rotate(rotation.conjugate(dual[:, :4]), light.sheen))
