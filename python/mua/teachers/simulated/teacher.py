"""The simulated character: a teacher made of a rigged, textured character, motion and position-based dynamics.

It stands in for a captured teacher. Its surface follows the linear blend of joints that the character's file means, and
is defined in canonical space: the simulated vertices are brought back to the bind pose by the dual quaternions that
carry the avatar's texels, and a texel lies at a fixed point of that surface. What of the deformation is longer than
about 20 cm goes into the canonical mesh, the rest into the texels' offsets; posed by T_tex, both together are the
teacher's surface. Scales that a clip animates, which rigid joints do not carry, are put on in canonical space, after
the dynamics.
"""

from collections.abc import Container, Iterator, Sequence
from dataclasses import replace

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Clip, is_range
from mua.pose.descriptor import heading_of
from mua.pose.skeleton import Pose
from mua.rig.bones import figure_scale
from mua.rig.character import Character
from mua.rig.expressions import Expressions
from mua.teacher import Light, TeacherFrame
from mua.teachers.simulated.shading import shade, visibility
from mua.teachers.simulated.simulated_surface import SimulatedSurface
from mua.teachers.simulated.skinned_surface import MovedSurface
from mua.teachers.simulated.smoothing import low_pass
from mua.teachers.simulated.still import StillTeacher
from mua.teachers.simulated.texels import SurfaceTexels
from mua.texture.surfels import vertex_normals

DARKEST = 3 / 255  # light on a vertex, below which no share of it is taken
COARSE_WAVELENGTH = 0.2  # metres on a person: longer deformation moves the canonical mesh, shorter the offsets


class SimulatedTeacher(StillTeacher):
    """Teacher frames of a character (mua.teacher) that hangs loose and stands in a light."""

    def __init__(
        self,
        character: Character,
        *,
        texels: int,
        template_vertices: int = 5000,
        laid: SurfaceTexels | None = None,  # as StillTeacher takes them
        lit_in: Sequence[Pose] = (),  # in which expressions change the light; none: in the bind pose
        seed: int = 0,
    ) -> None:
        """Prepare a texture of `texels` x `texels`; the seed chooses where the character's cloth folds."""
        super().__init__(character, texels=texels, template_vertices=template_vertices, laid=laid)
        mesh = character.mesh
        self._moving = SimulatedSurface(character, seed=seed)
        self._normals = vertex_normals(mesh.vertices, mesh.faces)
        self._longer = low_pass(mesh.vertices, mesh.faces, COARSE_WAVELENGTH * figure_scale(mesh.vertices))
        if self.rig.expressions is not None:
            self.rig = replace(
                self.rig, expressions=self._lit(self.rig.expressions, lit_in or [character.skeleton.bind_pose])
            )

    def frames(self, clip: Clip, wanted: Container[int]) -> Iterator[TeacherFrame | Pose]:
        """Simulate `clip` from rest in its first pose; yield whole frames where wanted, else poses.

        Of the built-in range of motion nothing is simulated: its frames show what follows from the pose alone.
        """
        if is_range(clip.name):
            poses = map(clip.pose, range(len(clip)))
            yield from (self.frame(pose) if frame in wanted else pose for frame, pose in enumerate(poses))
            return
        for frame, surface in enumerate(self._moving.played(clip)):
            yield self.frame_on(clip.pose(frame), surface()) if frame in wanted else clip.pose(frame)

    def _lit(self, expressions: Expressions, poses: Sequence[Pose]) -> Expressions:
        """The template's expressions with their gains: how each at 1 changes the light, by least squares over poses."""
        skeleton = self._character.skeleton
        surfaces = [self._skinned.posed(skeleton.skinning(pose.rotations, pose.translations)) for pose in poses]
        rest = self._brightness(surfaces, np.zeros(len(expressions)), np.arange(len(self._template)))
        squares = np.maximum(np.sum(rest**2, axis=0), len(poses) * DARKEST**2)
        gains = np.zeros(len(expressions.vertices))
        for e, weights in enumerate(np.eye(len(expressions))):
            entries = slice(*expressions.starts[e : e + 2])
            reached = expressions.vertices[entries]
            change = self._brightness(surfaces, weights, reached) - rest[:, reached]
            gains[entries] = np.sum(rest[:, reached] * change, axis=0) / squares[reached]
        return replace(expressions, gains=gains.astype(np.float32))

    def _brightness(
        self,
        surfaces: Sequence[MovedSurface],
        weights: Array,  # [E]
        vertices: Array,  # [n] int
    ) -> Array:
        """The light [S, n] on some of the template's vertices, all colours together."""
        expressions, bind = self._character.expressions, self._character.mesh.vertices
        assert expressions is not None
        face = expressions.displacement(weights, vertices=len(bind))
        turn = self._surface(bind + face)[0]
        found = []
        for surface in surfaces:
            moved = surface.places + self._skinned.carried(surface.joints, face)
            light = self._light(surface.joints, surface.dual, moved, turn, self._template[vertices])
            found.append(light.gain.sum(axis=1))
        return np.stack(found)

    def _coarse(self, displacement: Array) -> Array:
        """The long waves [T, 3] of a displacement [V, 3], which the canonical mesh takes on."""
        return np.asarray(self._longer(displacement)[self._template])

    def _light(
        self, joints: Array, dual: Array, moved: Array, turn: Array, vertices: Array | slice = slice(None)
    ) -> Light:
        """Light on some vertices of the surface at `moved` [V, 3], brought to canonical space."""
        bones, dual, moved = self._moving.bones, dual[vertices], moved[vertices]
        normals = rotation.rotate(rotation.multiply(dual[:, :4], turn[vertices]), self._normals[vertices])
        visible = visibility(moved, normals, bones.posed(joints), bones.radii)
        heading = heading_of(joints[self._character.skeleton.root, :4])
        light = shade(normals, visible, heading=heading)
        return Light(gain=light.gain, sheen=rotation.rotate(rotation.conjugate(dual[:, :4]), light.sheen))
