"""A given mesh and texture on a posed rig, without a student: how a teacher's frames are drawn."""

import numpy as np

from mua.arrays import Array
from mua.gpu import Commands, Device
from mua.kernels.inverse_dwt import pack_channels
from mua.player.buffers import upload_rig
from mua.player.channels import FLOAT, TEXEL_CHANNELS, groups
from mua.player.frame import SKINNED
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose
from mua.rig.bounds import frame_boxes
from mua.rig.rig import Rig


class TexturedRig:
    """A rig that SplatFrame draws; its vertices are posed by the last dispatch of `AvatarFrame.decode`."""

    def __init__(self, device: Device, rig: Rig) -> None:
        """Upload. Errors: InputError where a buffer is larger than the device can bind or hold."""
        self._rig, self.rig = rig, upload_rig(device, rig)
        self.splat_count, self._vertices = len(rig.texels.texels), len(rig.mesh.vertices)
        self.bounds = np.zeros((2, 3))  # world box of the last pose, metres
        self._blend_vertices = device.kernel("dq_skinning.compute", "BlendVertices")
        self.mesh = device.buffer(FLOAT * 3 * self._vertices, name="mesh")  # [V, 3] canonical vertices
        self.texel_channels = device.buffer(TEXEL_CHANNELS * self.splat_count, name="texel_channels")  # [6, N, 4]
        self._joints = device.buffer(FLOAT * 8 * len(rig.skeleton.names), name="joints")  # [J, 8]
        self.vertex_dq = device.buffer(FLOAT * 8 * self._vertices, name="vertex_dq")  # [V, 8]

    def pose(
        self,
        commands: Commands,
        mesh: Array,  # [V, 3] canonical vertices, metres
        texture: Array,  # [N, 23] raw channels
        pose: Pose,
    ) -> None:
        """Append the dispatch that poses the vertices.

        The numbers are written to the device at once: submit before the next pose.
        """
        joints = self._rig.skeleton.skinning(pose.rotations, pose.translations)
        self._joints.write(joints.astype(np.float32))
        self.mesh.write(np.ascontiguousarray(mesh, dtype=np.float32))
        self.texel_channels.write(pack_channels(texture))
        (self.bounds,) = frame_boxes(self._rig, Clip("", 1.0, pose.rotations[None], pose.translations[None]))
        commands.dispatch(
            self._blend_vertices,
            (groups(self._vertices, SKINNED), 1, 1),
            {
                "joints": self._joints,
                "indices": self.rig.skin_indices,
                "weights": self.rig.skin_weights,
                "vertex_dq": self.vertex_dq,
            },
            vertex_count=self._vertices,
        )
