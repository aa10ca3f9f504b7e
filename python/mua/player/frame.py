"""One frame of an avatar: the dispatches from a window of poses to channels and posed vertices.

A decode is made at once, or part by part in several displayed frames beside the channels that are shown meanwhile.
Kept a plain list in the order of the kernels, so that unity-package/Runtime/AvatarFrame.cs reads line for line like it.
"""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.avatar.decode_turns import PARTS
from mua.gpu import Buffer, Commands, Device
from mua.player.buffers import AvatarBuffers, LevelBuffers, RigPlaces
from mua.player.channels import FLOAT, TEXEL_CHANNELS, ChannelDecoder, ChannelSet, groups
from mua.pose.components import read_components
from mua.pose.descriptor import describe_window

SKINNED = 64  # vertices of a group of BlendVertices
IN_PLACE = rotation.dual_from_rigid(np.array([1.0, 0, 0, 0]), np.zeros(3))  # at the clip's own place


class AvatarFrame:
    """The channels that are shown and, where a decode is spread, the ones being decoded meanwhile."""

    def __init__(self, device: Device, avatar: AvatarBuffers) -> None:
        """Allocate. Errors: InputError where an intermediate buffer is larger than the device can bind or hold."""
        rig = avatar.avatar.rig
        self.avatar = avatar
        self.vertex_count = len(rig.mesh.vertices)
        self.bounds = avatar.avatar.bounds  # [2, 3] world box of the last pose, metres
        self.joints = device.buffer(FLOAT * 8 * len(rig.skeleton.names), name="joints")  # [J, 8]
        self.vertex_dq = device.buffer(FLOAT * 8 * self.vertex_count, name="vertex_dq")  # [V, 8]
        self._device, self._decoder = device, ChannelDecoder(device, avatar)
        self._blend_vertices = device.kernel("dq_skinning.compute", "BlendVertices")
        self._shown = self._create_channels()
        self._hidden: ChannelSet | None = None  # made when a decode is first begun
        self._decoded = PARTS  # parts of the decode into `_hidden`

    @property
    def level(self) -> LevelBuffers:
        """Level of detail of the decode that is shown."""
        return self._shown.level

    @property
    def rig(self) -> RigPlaces:
        """The places on the mesh of the texels that are shown."""
        return self.level.places

    @property
    def splat_count(self) -> int:
        """Splats of the decode that is shown; the buffers hold the finest level."""
        return self.level.splat_count

    @property
    def mesh(self) -> Buffer:
        """[V, 3] canonical vertices of the decode that is shown, metres."""
        return self._shown.mesh

    @property
    def texel_channels(self) -> Buffer:
        """[6, N, 4] half floats of the decode that is shown."""
        return self._shown.texel_channels

    @property
    def outside(self) -> float:
        """How far the shown pose is outside of training, 0 to 1 (mua.pose.components)."""
        return self._shown.outside

    @property
    def parts_left(self) -> int:
        """How many parts remain of the decode that was begun and is not shown."""
        return PARTS - self._decoded

    def _create_channels(self) -> ChannelSet:
        buffer = self._device.buffer
        return ChannelSet(
            level=self.avatar.level(0),
            components=buffer(FLOAT * len(self.avatar.avatar.components.margins), name="components"),
            mesh=buffer(FLOAT * 3 * self.vertex_count, name="mesh"),
            texel_channels=buffer(TEXEL_CHANNELS * self.avatar.level(0).splat_count, name="texel_channels"),
            weights=buffer(FLOAT * len(self.avatar.avatar.expressions), name="weights"),
        )

    def decode(
        self,
        commands: Commands,
        rotations: Array,  # [k, J, 4] local joint rotations, newest first
        translations: Array,  # [k, J, 3] local joint translations, metres
        place: Array = IN_PLACE,  # [8] rigid dual quaternion from the avatar's space to the world, metres
        level: int = 0,  # level of detail, 0 being the finest
        expressions: Array | None = None,  # [E] weights, 0 to 1; None: all 0
    ) -> None:
        """Append the dispatches from a window of poses to channels and posed vertices, which are shown from then on.

        What depends on the pose alone is written to the device at once: submit before the next decode.
        """
        self.decode_channels(commands, rotations, translations, expressions, level=level)
        self.repose(commands, rotations[0], translations[0], place)

    def decode_channels(
        self,
        commands: Commands,
        rotations: Array,
        translations: Array,
        expressions: Array | None = None,
        *,
        level: int = 0,
    ) -> None:
        """Append all parts of a decode, without posing; one that was begun is given up."""
        self._decoded = PARTS
        self._begin(self._shown, rotations, translations, expressions, level)
        for part in range(PARTS):
            self._decoder.part(commands, self._shown, part)

    def begin(self, rotations: Array, translations: Array, expressions: Array | None = None, *, level: int = 0) -> None:
        """Take the window of a decode that is made part by part beside what is shown, in place of one begun before.

        Errors: InputError where the device cannot hold a second set of channels.
        """
        self._hidden = self._hidden or self._create_channels()
        self._begin(self._hidden, rotations, translations, expressions, level)
        self._decoded = 0

    def advance(self, commands: Commands) -> None:
        """Append the next part of the decode that was begun."""
        assert self._hidden is not None
        self._decoder.part(commands, self._hidden, self._decoded)
        self._decoded += 1

    def show(self) -> None:
        """Show the decode that was begun, all of whose parts have been appended."""
        assert self._hidden is not None
        self._shown, self._hidden = self._hidden, self._shown

    def repose(
        self,
        commands: Commands,
        rotations: Array,  # [J, 4]
        translations: Array,  # [J, 3] metres
        place: Array = IN_PLACE,  # [8]
    ) -> None:
        """Append the dispatches that move the decoded avatar into another pose."""
        self._write_pose(rotations, translations, place)
        self._pose(commands)

    def _begin(
        self, channels: ChannelSet, rotations: Array, translations: Array, expressions: Array | None, level: int
    ) -> None:
        channels.level = self.avatar.level(level)
        avatar = self.avatar.avatar
        descriptor = describe_window(avatar.rig.skeleton, avatar.encoding, rotations, translations)
        read, outside = read_components(avatar.components, descriptor)
        channels.outside = float(outside)
        channels.components.write(read.astype(np.float32))
        held = avatar.rig.expressions
        shown = None if expressions is None or held is None else held.shown(expressions)
        channels.expressive = shown is not None and bool(shown.any())
        if shown is not None:
            channels.weights.write(shown.astype(np.float32))

    def _write_pose(self, rotations: Array, translations: Array, place: Array) -> None:
        avatar, skeleton = self.avatar.avatar, self.avatar.avatar.rig.skeleton
        joints = rotation.dual_multiply(place, skeleton.skinning(rotations, translations))
        self.joints.write(joints.astype(np.float32))
        root = skeleton.world(rotations, translations)[1][skeleton.root]
        corners = rotation.dual_transform(place, np.stack(np.meshgrid(*(avatar.bounds + root).T), axis=-1))
        self.bounds = np.stack([corners.min(axis=(0, 1, 2)), corners.max(axis=(0, 1, 2))])

    def _pose(self, commands: Commands) -> None:
        commands.dispatch(
            self._blend_vertices,
            (groups(self.vertex_count, SKINNED), 1, 1),
            {
                "joints": self.joints,
                "indices": self.avatar.rig.skin_indices,
                "weights": self.avatar.rig.skin_weights,
                "vertex_dq": self.vertex_dq,
            },
            vertex_count=self.vertex_count,
        )
