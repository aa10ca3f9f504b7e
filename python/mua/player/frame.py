"""One frame of an avatar: the dispatches from a window of poses to channels and posed vertices.

Kept a plain list in the order of the kernels, so that unity-package/Runtime/AvatarFrame.cs reads line for line like it.
"""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.gpu import Buffer, Commands, Device
from mua.kernels.inverse_dwt import BATCH, ROWS
from mua.player.buffers import AvatarBuffers, BandBuffers, BranchBuffers, BranchLevel, LayerBuffers, RigPlaces
from mua.pose.descriptor import describe_window

FLOAT = 4  # bytes
LAYER_ROWS, MESH_COLUMNS = 8, 64  # outputs of a group of MlpMatmul and of MlpMatmulTransposed
LL_TEXELS = 64  # of a group of BlendLl
DETAIL_TILE = 24  # texels along a side of a group of BlendDetail
COARSE_TILE = 16  # samples along a side that a group of InverseDwt doubles
TEXEL_CHANNELS = 2 * ROWS * BATCH  # bytes
SKINNED = 64  # vertices of a group of BlendVertices
IN_PLACE = rotation.dual_from_rigid(np.array([1.0, 0, 0, 0]), np.zeros(3))  # where the clip puts it


class AvatarFrame:
    """The buffers between the kernels, sized once and reused by every frame."""

    def __init__(self, device: Device, avatar: AvatarBuffers) -> None:
        """Errors: InputError where an intermediate buffer is more than the device can bind or hold."""
        self.avatar, self.level = avatar, avatar.level(0)  # of the last decode
        self.vertex_count = len(avatar.avatar.rig.mesh.vertices)
        self.bounds = avatar.avatar.bounds  # [2, 3] world box of the last decode, metres
        self._load_kernels(device)
        self._create_buffers(device)

    @property
    def rig(self) -> RigPlaces:
        """Where the texels of the last decode lie on the mesh."""
        return self.level.places

    @property
    def splat_count(self) -> int:
        """Of the last decode; the buffers hold the finest level."""
        return self.level.splat_count

    def _load_kernels(self, device: Device) -> None:
        self._mlp_matmul = device.kernel("mlp_matmul.compute", "MlpMatmul")
        self._mlp_matmul_transposed = device.kernel("mlp_matmul.compute", "MlpMatmulTransposed")
        self._blend_ll = device.kernel("blend_subbands.compute", "BlendLl")
        self._blend_detail = device.kernel("blend_subbands.compute", "BlendDetail")
        self._inverse_dwt = device.kernel("inverse_dwt.compute", "InverseDwt")
        self._upsample_texels = device.kernel("inverse_dwt.compute", "UpsampleTexels")
        self._blend_vertices = device.kernel("dq_skinning.compute", "BlendVertices")

    def _create_buffers(self, device: Device) -> None:
        avatar, buffer = self.avatar.avatar, device.buffer
        splats, vertices, joints = self.splat_count, self.vertex_count, len(avatar.rig.skeleton.names)
        branches = (self.avatar.geometry, self.avatar.appearance)
        layers = [*self.avatar.coarse_mlp, *(layer for branch in branches for layer in branch.mlp)]
        activations = FLOAT * max(layer.outputs for layer in layers)
        low = avatar.rig.texels.size >> avatar.wavelet.levels
        texture = FLOAT * max(b.channels * (low << len(b.details)) ** 2 for b in branches)
        details = [3 * b.channels * d.size**2 for b in branches for d in b.details]
        self.descriptor = buffer(FLOAT * avatar.encoding.width, name="descriptor")
        self.activations = tuple(buffer(activations, name=f"activations {i}") for i in range(2))
        self.mesh = buffer(FLOAT * 3 * vertices, name="mesh")  # [V, 3] canonical vertices
        self.details = buffer(FLOAT * max(details, default=0), name="details")
        self.textures = tuple(
            buffer(texture >> 2 * i, name=f"texture {i}") for i in range(2)
        )  # finest with details, its ll
        self.texel_channels = buffer(TEXEL_CHANNELS * splats, name="texel_channels")  # [6, N, 4] halves
        self.joints = buffer(FLOAT * 8 * joints, name="joints")  # [J, 8]
        self.vertex_dq = buffer(FLOAT * 8 * vertices, name="vertex_dq")  # [V, 8]

    def decode(
        self,
        commands: Commands,
        rotations: Array,  # [k, J, 4] local joint rotations, newest first
        translations: Array,  # [k, J, 3] local joint translations, metres
        place: Array = IN_PLACE,  # [8] rigid dual quaternion from the avatar's space to the world, metres
        level: int = 0,  # of detail, 0 being the finest
    ) -> None:
        """Append the dispatches from a window of poses to channels and posed vertices.

        What depends on the pose alone is written to the device at once: submit before the next decode.
        """
        self.level = self.avatar.level(level)
        self._write_pose(rotations, translations, place)
        self._coarse(commands)
        self._branch(commands, self.avatar.geometry, self.level.geometry, first_row=0)
        self._branch(commands, self.avatar.appearance, self.level.appearance, first_row=ROWS // 2)
        self._pose(commands)

    def _write_pose(self, rotations: Array, translations: Array, place: Array) -> None:
        avatar = self.avatar.avatar
        skeleton, normalization = avatar.rig.skeleton, avatar.normalization
        descriptor = describe_window(skeleton, avatar.encoding, rotations, translations)
        self.descriptor.write(((descriptor - normalization.mean) / normalization.scale).astype(np.float32))
        joints = rotation.dual_multiply(place, skeleton.skinning(rotations[0], translations[0]))
        self.joints.write(joints.astype(np.float32))
        root = skeleton.world(rotations[0], translations[0])[1][skeleton.root]
        corners = rotation.dual_transform(place, np.stack(np.meshgrid(*(avatar.bounds + root).T), axis=-1))
        self.bounds = np.stack([corners.min(axis=(0, 1, 2)), corners.max(axis=(0, 1, 2))])

    def _mlp(self, commands: Commands, mlp: tuple[LayerBuffers, ...]) -> Buffer:
        """What the MLP makes of the descriptor; good until the next MLP."""
        x = self.descriptor
        for i, layer in enumerate(mlp):
            y = self.activations[i % 2]
            commands.dispatch(
                self._mlp_matmul,
                (groups(layer.outputs, LAYER_ROWS), 1, 1),
                {"weight": layer.weight.words, "bias": layer.bias.words, "x": x, "y": y},
                weight_layout=layer.weight.layout,
                bias_layout=layer.bias.layout,
                inputs=layer.inputs,
                outputs=layer.outputs,
                relu=int(layer is not mlp[-1]),
            )
            x = y
        return x

    def _coarse(self, commands: Commands) -> None:
        basis = self.avatar.mesh
        coefficients = self._mlp(commands, self.avatar.coarse_mlp)
        commands.dispatch(
            self._mlp_matmul_transposed,
            (groups(basis.outputs, MESH_COLUMNS), 1, 1),
            {"weight": basis.weight.words, "bias": basis.bias.words, "x": coefficients, "y": self.mesh},
            weight_layout=basis.weight.layout,
            bias_layout=basis.bias.layout,
            inputs=basis.inputs,
            outputs=basis.outputs,
            relu=0,
        )

    def _branch(self, commands: Commands, branch: BranchBuffers, shown: BranchLevel, *, first_row: int) -> None:
        """Coefficients, LL, level by level as long as there are details; then the valid texels to `texel_channels`."""
        alpha = self._mlp(commands, branch.mlp)
        levels = len(branch.details)
        size = self.avatar.avatar.rig.texels.size >> self.avatar.avatar.wavelet.levels
        self._blend_low(commands, branch, alpha, size, self.textures[levels % 2])
        offset = branch.channels * branch.rank
        for level, band in enumerate(branch.details):
            ll, fine = self.textures[(levels - level) % 2], self.textures[(levels - level - 1) % 2]
            self._blend_band(commands, branch, band, alpha, offset, size)
            self._synthesise(commands, branch, ll, fine, size)
            offset += branch.channels * band.rank
            size *= 2
        self._upsample(commands, branch, shown, size, first_row)

    def _blend_low(self, commands: Commands, branch: BranchBuffers, alpha: Buffer, size: int, blended: Buffer) -> None:
        commands.dispatch(
            self._blend_ll,
            (groups(size * size, LL_TEXELS), branch.channels, 1),
            {"mean": branch.ll_mean.words, "basis": branch.ll_basis.words, "alpha": alpha, "blended": blended},
            mean_layout=branch.ll_mean.layout,
            basis_layout=branch.ll_basis.layout,
            channels=branch.channels,
            rank=branch.rank,
            size=size,
            alpha_offset=0,
        )

    def _blend_band(
        self, commands: Commands, branch: BranchBuffers, band: BandBuffers, alpha: Buffer, alpha_offset: int, size: int
    ) -> None:
        tiles = groups(size, DETAIL_TILE)
        commands.dispatch(
            self._blend_detail,
            (tiles, tiles, 3 * branch.channels),
            {"mean": band.mean.words, "h": band.h.words, "w": band.w.words, "alpha": alpha, "blended": self.details},
            mean_layout=band.mean.layout,
            h_layout=band.h.layout,
            w_layout=band.w.layout,
            channels=branch.channels,
            rank=band.rank,
            size=size,
            alpha_offset=alpha_offset,
        )

    def _synthesise(self, commands: Commands, branch: BranchBuffers, ll: Buffer, fine: Buffer, size: int) -> None:
        """One level, from planes of `size` to twice that."""
        tiles = groups(size, COARSE_TILE)
        commands.dispatch(
            self._inverse_dwt,
            (tiles, tiles, branch.channels),
            {
                "ll": ll,
                "details": self.details,
                "rec_lo": self.avatar.rec_lo,
                "rec_hi": self.avatar.rec_hi,
                "fine": fine,
            },
            channels=branch.channels,
            size=size,
            taps=len(self.avatar.avatar.wavelet.rec_lo),
        )

    def _upsample(
        self, commands: Commands, branch: BranchBuffers, shown: BranchLevel, size: int, first_row: int
    ) -> None:
        """All levels without details, from planes of `size`, and the static offset, at the valid texels."""
        upsampling = shown.upsampling
        commands.dispatch(
            self._upsample_texels,
            (self.level.tile_count, 1, groups(branch.channels, BATCH)),
            {
                "ll": self.textures[0],
                "upsampling": upsampling.taps,
                "tiles": self.level.tiles,
                "tile_rows": self.level.tile_rows,
                "static_offset": shown.static_offset.words,
                "texel_channels": self.texel_channels,
            },
            static_offset_layout=shown.static_offset.layout,
            channels=branch.channels,
            size=size,
            factor=upsampling.factor,
            reach=upsampling.reach,
            delay=upsampling.delay,
            texel_count=self.splat_count,
            first_row=first_row,
        )

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


def groups(count: int, size: int) -> int:
    """Groups of `size` that hold `count`."""
    return -(-count // size)
