"""The simulated character without simulation and light: what its splats show of the character's own surface."""

import numpy as np

from mua import rotation
from mua.pose.clip import Stretches
from mua.pose.skeleton import Pose
from mua.rig.build import build_rig
from mua.rig.character import Character
from mua.rig.stretched import stretched
from mua.teachers.bones import figure_scale
from mua.teachers.chords import straighten
from mua.teachers.light import Light
from mua.teachers.skinning import Skinning, transform
from mua.teachers.smoothing import TURN_WAVELENGTH, low_pass
from mua.teachers.teacher import TeacherFrame
from mua.teachers.texels import SurfaceTexels
from mua.texture.surfels import SurfaceFrames


class StillTeacher:
    """Splats of a character that skinning alone moves, in the colours of its textures."""

    def __init__(self, character: Character, *, texels: int, template_vertices: int = 5000) -> None:
        mesh = character.mesh
        self.rig, _ = build_rig(character, texels=texels, template_vertices=template_vertices)
        self._character = character
        self._skinning = Skinning(character.skin_indices, character.skin_weights)
        self._surface = SurfaceFrames(mesh.vertices, mesh.faces)
        self._smooth_turn = low_pass(mesh.vertices, mesh.faces, TURN_WAVELENGTH * figure_scale(mesh.vertices))
        self._texels = SurfaceTexels(character, self.rig)
        count = len(mesh.vertices)
        self._coarse = np.zeros((len(self.rig.mesh.vertices), 3))
        self._unlit = Light(gain=np.ones((count, 3)), sheen=np.zeros((count, 3)))

    def frame(
        self,
        pose: Pose,
        stretches: Stretches | None = None,  # of this frame alone
    ) -> TeacherFrame:
        """One pose; its splats turn and stretch with the surface as the simulated ones do."""
        character = self._character
        joints = character.skeleton.skinning(pose.rotations, pose.translations)
        dual = self._skinning(joints)
        bind = character.mesh.vertices
        shape = bind if stretches is None else stretched(character, stretches, 0, bind)
        moved = self._skinning.linear(joints, shape)
        canonical = transform(rotation.dual_inverse(dual), moved)
        turn, strain = self._surface(moved)
        turn = rotation.multiply(rotation.conjugate(dual[:, :4]), turn)
        turn = rotation.normalize(self._smooth_turn(np.where(turn[:, :1] < 0, -turn, turn)))
        texture = self._texels.texture(
            canonical - bind, self._coarse, turn=turn, moved=moved, strain=strain, light=self._unlit
        )
        mesh = self.rig.mesh.vertices.astype(np.float32)
        places = self._texels.places
        straighten(texture, self.rig, joints=joints, mesh=mesh, moved=moved, canonical=canonical, places=places)
        return TeacherFrame(pose=pose, mesh=mesh, texture=texture)
