"""A given mesh and texture on the posed rig, without a student: how a teacher's frames are drawn."""

import numpy as np

from mua.arrays import Array
from mua.gpu import Commands, Device
from mua.kernels.inverse_dwt import pack_channels
from mua.player.frame import FLOAT, SKINNED, TEXEL_CHANNELS, groups
from mua.player.splats import SplatFrame
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose
from mua.rig.bounds import frame_boxes
from mua.rig.rig import Rig


class TexturedFrame(SplatFrame):
    """The splats of one rig: posed by the dispatches that end `AvatarFrame.decode`, sorted by those of SplatFrame."""

    def __init__(self, device: Device, rig: Rig) -> None:
        """Errors: InputError where a buffer is more than the device can bind or hold."""
        self.rig = rig
        self.splat_count = len(rig.texels.texels)
        self.avatars = ()
        self._load_kernels(device)
        self._create_buffers(device)
        self._box = np.zeros((2, 3))
        self._blend_vertices = device.kernel("dq_skinning.compute", "BlendVertices")
        self._skin_splats = device.kernel("dq_skinning.compute", "SkinSplats")
        self._create_rig(device)

    def _create_rig(self, device: Device) -> None:
        rig, texels, buffer = self.rig, self.rig.texels, device.buffer
        self._skin_indices = buffer(rig.skin_indices.astype(np.uint32), name="template.skin_indices")
        self._skin_weights = buffer(rig.skin_weights.astype(np.float32), name="template.skin_weights")
        self._faces = buffer(rig.mesh.faces.astype(np.uint32), name="template.faces")
        self._triangles = buffer(texels.triangles.astype(np.uint32), name="texels.triangles")
        self._barycentrics = buffer(texels.barycentrics[:, :2].astype(np.float32), name="texels.barycentrics")
        self._vertices = len(rig.mesh.vertices)
        self._mesh = buffer(FLOAT * 3 * self._vertices, name="mesh")  # [V, 3] canonical vertices
        self._texel_channels = buffer(TEXEL_CHANNELS * self.splat_count, name="texel_channels")  # [6, N, 4]
        self._joints = buffer(FLOAT * 8 * len(rig.skeleton.names), name="joints")  # [J, 8]
        self._vertex_dq = buffer(FLOAT * 8 * self._vertices, name="vertex_dq")  # [V, 8]

    def box(self) -> Array:
        """[2, 3] world box of the last pose, metres."""
        return self._box

    def pose(
        self,
        commands: Commands,
        mesh: Array,  # [V, 3] canonical vertices, metres
        texture: Array,  # [N, 23] raw channels
        pose: Pose,
    ) -> None:
        """Append the dispatches from mesh and texture to posed splats.

        The numbers are written to the device at once: submit before the next pose.
        """
        joints = self.rig.skeleton.skinning(pose.rotations, pose.translations)
        self._joints.write(joints.astype(np.float32))
        self._mesh.write(np.ascontiguousarray(mesh, dtype=np.float32))
        self._texel_channels.write(pack_channels(texture))
        (self._box,) = frame_boxes(self.rig, Clip("", 1.0, pose.rotations[None], pose.translations[None]))
        commands.dispatch(
            self._blend_vertices,
            (groups(self._vertices, SKINNED), 1, 1),
            {
                "joints": self._joints,
                "indices": self._skin_indices,
                "weights": self._skin_weights,
                "vertex_dq": self._vertex_dq,
            },
            vertex_count=self._vertices,
        )
        commands.dispatch(
            self._skin_splats,
            (groups(self.splat_count, SKINNED), 1, 1),
            {
                "vertex_dq": self._vertex_dq,
                "mesh": self._mesh,
                "faces": self._faces,
                "triangles": self._triangles,
                "barycentrics": self._barycentrics,
                "texel_channels": self._texel_channels,
                "splats": self.splats,
            },
            texel_count=self.splat_count,
            first_splat=0,
        )
