"""The simulated character: a teacher made of a rigged, textured character, motion and position-based dynamics.

It stands in for a captured teacher. Its surface is defined in canonical space: the simulated vertices are brought
back to the bind pose by the dual quaternions that skinned them, and a texel lies at a fixed point of that surface.
What of the deformation is longer than about 12 cm goes into the canonical mesh, the rest into the texels' offsets;
posed by T_tex, both together are the teacher's surface.
"""

from collections.abc import Callable, Container, Iterator

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from mua import rotation
from mua.arrays import Array
from mua.kernels.dq_skinning import blend_vertices
from mua.motion.clip import Clip
from mua.motion.descriptor import heading_of
from mua.rig.character import Character
from mua.rig.rig import Rig
from mua.rig.skeleton import Pose
from mua.rig.template import make_template
from mua.rig.texel_map import build_texel_map
from mua.teachers.bones import figure_scale, fit_bones
from mua.teachers.looseness import estimate_looseness
from mua.teachers.shading import Light, shade, visibility
from mua.teachers.simulation import Simulation
from mua.teachers.teacher import TeacherFrame
from mua.teachers.texels import SurfaceTexels
from mua.texture.surfels import SurfaceFrames, vertex_normals

COARSE_WAVELENGTH = 0.12  # metres on a person: longer deformation moves the canonical mesh, shorter the offsets


class SimulatedTeacher:
    """Teacher frames of a character (mua.teachers.teacher); `rig` is the template that they stand on."""

    def __init__(self, character: Character, *, texels: int, template_vertices: int = 5000) -> None:
        mesh = character.mesh
        template = make_template(character, vertices=template_vertices)
        self.rig = Rig(
            skeleton=character.skeleton,
            mesh=template.mesh,
            skin_indices=template.skin_indices,
            skin_weights=template.skin_weights,
            texels=build_texel_map(template.mesh, texels),
        )
        self._character = character
        self._template = template.source_vertices
        looseness = estimate_looseness(character) if character.looseness is None else character.looseness
        self._bones = fit_bones(character, looseness)
        self._simulation = Simulation(mesh.vertices, mesh.faces, looseness=looseness, bones=self._bones)
        self._surface = SurfaceFrames(mesh.vertices, mesh.faces)
        self._normals = vertex_normals(mesh.vertices, mesh.faces)
        self._low_pass = low_pass(mesh.vertices, mesh.faces, COARSE_WAVELENGTH * figure_scale(mesh.vertices))
        self._texels = SurfaceTexels(character, self.rig)

    def frames(self, clip: Clip, wanted: Container[int]) -> Iterator[TeacherFrame | Pose]:
        """Simulate `clip` from rest in its first pose; yield whole frames where wanted, else poses."""
        character, bones = self._character, self._bones
        skinning = character.skeleton.skinning(clip.rotations, clip.translation)
        for frame, joints in enumerate(skinning):
            dual = blend_vertices(joints, character.skin_indices, character.skin_weights)
            target, ends = rotation.dual_transform(dual, character.mesh.vertices), bones.posed(joints)
            if frame == 0:
                self._simulation.settle(target, dual[:, :4], ends)
            moved = self._simulation.advance(target, dual[:, :4], ends, seconds=1 / clip.rate)
            pose = Pose(clip.rotations[frame], clip.translation[frame])
            yield self._whole(pose, joints, dual, moved) if frame in wanted else pose

    def _whole(self, pose: Pose, joints: Array, dual: Array, moved: Array) -> TeacherFrame:
        """The frame whose dense surface, posed by `dual` [V, 8], lies at `moved` [V, 3]."""
        bind = self._character.mesh.vertices
        displacement = rotation.dual_transform(rotation.dual_inverse(dual), moved) - bind
        coarse = self._low_pass(displacement)[self._template]
        back = rotation.conjugate(dual[:, :4])
        turn, log_stretch = self._surface(moved)
        turn = rotation.multiply(back, turn)
        turn = np.where(turn[:, :1] < 0, -turn, turn)
        texture = self._texels.texture(
            displacement,
            coarse,
            turn=turn,
            log_stretch=log_stretch,
            light=self._light(joints, dual, moved, turn),
        )
        mesh = (self.rig.mesh.vertices + coarse).astype(np.float32)
        return TeacherFrame(pose=pose, mesh=mesh, texture=texture)

    def _light(self, joints: Array, dual: Array, moved: Array, turn: Array) -> Light:
        """Light on the surface at `moved` [V, 3], brought to canonical space."""
        normals = rotation.rotate(rotation.multiply(dual[:, :4], turn), self._normals)
        visible = visibility(moved, normals, self._bones.posed(joints), self._bones.radii)
        heading = heading_of(joints[self._character.skeleton.root, :4])
        light = shade(normals, visible, heading=heading)
        return Light(gain=light.gain, sheen=rotation.rotate(rotation.conjugate(dual[:, :4]), light.sheen))


def low_pass(vertices: Array, faces: Array, wavelength: float) -> Callable[[Array], Array]:
    """A filter for fields [V, c] on a surface that halves waves of this length and keeps longer ones: (M + t L)^-1 M.

    L is the cotangent Laplacian without its negative weights, M the area about each vertex.
    """
    a, b, c = vertices[faces].swapaxes(0, 1)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    count = len(vertices)
    mass = np.bincount(faces.ravel(), np.repeat(area / 3, 3), count)
    mass = sparse.diags(np.maximum(mass, 1e-6 * mass.mean()))
    links = sparse.csr_matrix((count, count))
    for corner, (p, q, r) in enumerate(((a, b, c), (b, c, a), (c, a, b))):
        cotangent = np.sum((q - p) * (r - p), axis=1) / np.maximum(4 * area, 1e-12)
        ends = faces[:, (corner + 1) % 3], faces[:, (corner + 2) % 3]
        links = links + sparse.csr_matrix((cotangent, ends), shape=(count, count))
    links = (links + links.T).maximum(0)
    stiffness = sparse.diags(np.asarray(links.sum(axis=1)).ravel()) - links
    t = (wavelength / (2 * np.pi)) ** 2
    factors = linalg.splu((mass + t * stiffness).tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    return lambda field: np.asarray(factors.solve(np.asarray(mass @ field)))
