"""From a window of poses to channels: the dispatches of a decode, in parts that displayed frames can share.

Kept a plain list in the order of the kernels, as unity-package/Runtime/ChannelDecoder.cs.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mua.avatar.decode_turns import PARTS
from mua.gpu import Buffer, Commands, Device
from mua.gpu.kernel import Kernel
from mua.kernels.inverse_dwt import BATCH, ROWS, plane_bytes
from mua.player.buffers import AvatarBuffers, BandBuffers, BranchBuffers, BranchLevel, LayerBuffers, LevelBuffers

FLOAT = 4  # bytes
TEXEL_CHANNELS = 2 * ROWS * BATCH  # bytes
LAYER_ROWS, MESH_COLUMNS = 8, 64  # outputs of a group of MlpMatmul and of MlpMatmulTransposed
LL_PAIRS = 64  # pairs of texels, a word each, of a group of BlendLl
DETAIL_TILE = 24  # texels along a side of a group of BlendDetail
COARSE_TILE = 16  # samples along a side that a group of InverseDwt doubles
EXPRESSED = 64  # vertices or triangles of a group of the kernels of expressions
BEND = 24  # bytes of a bent triangle or vertex


@dataclass
class ChannelSet:
    """The result of a decode, with its window of poses and its level of detail."""

    level: LevelBuffers
    components: Buffer  # [K] components of the descriptor, which the networks read
    mesh: Buffer  # [V, 3] canonical vertices
    texel_channels: Buffer  # [6, N, 4] halves; holds the finest level
    weights: Buffer  # [E] of expressions
    expressive: bool = False  # whether one of them is not 0
    outside: float = 0.0  # share of the pose that training did not show (mua.pose.components)


class ChannelDecoder:
    """The buffers between the kernels of a decode, allocated once: parts read what the one before left in them."""

    def __init__(self, device: Device, avatar: AvatarBuffers) -> None:
        """Allocate. Errors: InputError where an intermediate buffer is larger than the device can bind or hold."""
        self.avatar = avatar
        self._load_kernels(device)
        self._create_buffers(device)

    def _load_kernels(self, device: Device) -> None:
        self._mlp_matmul = device.kernel("mlp_matmul.compute", "MlpMatmul")
        self._mlp_matmul_transposed = device.kernel("mlp_matmul.compute", "MlpMatmulTransposed")
        self._blend_ll = device.kernel("blend_subbands.compute", "BlendLl")
        self._blend_detail = device.kernel("blend_subbands.compute", "BlendDetail")
        self._inverse_dwt = device.kernel("inverse_dwt.compute", "InverseDwt")
        self._upsample_texels = device.kernel("inverse_dwt.compute", "UpsampleTexels")
        self._sum_targets = device.kernel("expressions.compute", "SumTargets")
        self._bend_triangles = device.kernel("expressions.compute", "BendTriangles")
        self._bend_vertices = device.kernel("expressions.compute", "BendVertices")
        self._bend_texels = device.kernel("expressions.compute", "BendTexels")
        self._light_texels = device.kernel("expressions.compute", "LightTexels")

    def _create_buffers(self, device: Device) -> None:
        avatar, branches = self.avatar.avatar, (self.avatar.geometry, self.avatar.appearance)
        layers = [*self.avatar.coarse_mlp, *(layer for branch in branches for layer in branch.mlp)]
        activations = FLOAT * max(layer.outputs for layer in layers)
        low = avatar.rig.texels.size >> avatar.wavelet.levels
        details = [3 * b.channels * plane_bytes(d.size) for b in branches for d in b.details]
        self.activations = tuple(device.buffer(activations, name=f"activations {i}") for i in range(2))
        self.details = device.buffer(max(details, default=0), name="details")
        textures = [  # finest with details, its ll
            max(b.channels * plane_bytes(low << len(b.details) >> i) for b in branches) for i in range(2)
        ]
        self.moved = device.buffer(np.zeros(4 * len(avatar.rig.mesh.vertices), np.float32), name="moved")  # [V, 4]
        self.triangle_bends = device.buffer(BEND * self.avatar.expressions.triangle_count, name="triangle_bends")
        self.vertex_bends = device.buffer(
            BEND * len(avatar.rig.mesh.vertices) * bool(avatar.expressions), name="vertex_bends"
        )
        self.textures = tuple(device.buffer(textures[i], name=f"texture {i}") for i in range(2))

    def part(self, commands: Commands, channels: ChannelSet, part: int) -> None:
        """Append one of PARTS, in their order; they read the components in `channels` and write their results there."""
        assert part < PARTS
        branch, shown, first_row = self.avatar.geometry, channels.level.geometry, 0
        if part >= PARTS // 2:
            branch, shown, first_row = self.avatar.appearance, channels.level.appearance, ROWS // 2
        if part % 2 == 0:
            self._blend(commands, branch, channels)
            return
        if part == 1:
            self._coarse(commands, channels)
            if channels.expressive:
                self._express(commands, channels)
        self._texels(commands, branch, shown, channels, first_row)

    def _mlp(self, commands: Commands, mlp: tuple[LayerBuffers, ...], components: Buffer) -> Buffer:
        """The MLP's output for the components; valid until the next MLP runs."""
        x = components
        for i, layer in enumerate(mlp):
            y = self.activations[i % 2]
            self._layer(commands, self._mlp_matmul, layer, x, y, LAYER_ROWS, relu=layer is not mlp[-1])
            x = y
        return x

    def _layer(
        self, commands: Commands, kernel: Kernel, layer: LayerBuffers, x: Buffer, y: Buffer, rows: int, *, relu: bool
    ) -> None:
        """One fully connected layer, or the basis of the mesh as one; `rows` outputs a group."""
        commands.dispatch(
            kernel,
            (groups(layer.outputs, rows), 1, 1),
            {"weight": layer.weight.words, "bias": layer.bias.words, "x": x, "y": y},
            weight_layout=layer.weight.layout,
            bias_layout=layer.bias.layout,
            inputs=layer.inputs,
            outputs=layer.outputs,
            relu=int(relu),
        )

    def _coarse(self, commands: Commands, channels: ChannelSet) -> None:
        basis, kernel = self.avatar.mesh, self._mlp_matmul_transposed
        coefficients = self._mlp(commands, self.avatar.coarse_mlp, channels.components)
        self._layer(commands, kernel, basis, coefficients, channels.mesh, MESH_COLUMNS, relu=False)

    def _express(self, commands: Commands, channels: ChannelSet) -> None:
        """Move the vertices of expressions, and say how those in reach bend."""
        targets = self.avatar.expressions
        moving = {"moved": self.moved, "mesh": channels.mesh}
        commands.dispatch(
            self._sum_targets,
            (groups(targets.vertex_count, EXPRESSED), 1, 1),
            {
                "vertices": targets.vertices,
                "starts": targets.starts,
                "expressions": targets.expressions,
                "changes": targets.changes,
                "weights": channels.weights,
                **moving,
            },
            vertex_count=targets.vertex_count,
        )
        commands.dispatch(
            self._bend_triangles,
            (groups(targets.triangle_count, EXPRESSED), 1, 1),
            {"corners": targets.corners, "triangle_bends": self.triangle_bends, **moving},
            triangle_count=targets.triangle_count,
        )
        commands.dispatch(
            self._bend_vertices,
            (groups(targets.bent_count, EXPRESSED), 1, 1),
            {
                "vertices": targets.bent_vertices,
                "starts": targets.star_starts,
                "stars": targets.stars,
                "moved": self.moved,
                "triangle_bends": self.triangle_bends,
                "vertex_bends": self.vertex_bends,
            },
            vertex_count=targets.bent_count,
        )

    def _blend(self, commands: Commands, branch: BranchBuffers, channels: ChannelSet) -> None:
        """Coefficients, LL, and level by level up to the finest details."""
        alpha = self._mlp(commands, branch.mlp, channels.components)
        size = self._size(0)
        self._blend_low(commands, branch, alpha, size, self.textures[len(branch.details) % 2])
        offset = branch.channels * branch.rank
        for level, band in enumerate(branch.details):
            if level > 0:
                self._synthesise(commands, branch, level - 1)
            self._blend_band(commands, branch, band, alpha, offset, self._size(level))
            offset += branch.channels * band.rank

    def _texels(
        self, commands: Commands, branch: BranchBuffers, shown: BranchLevel, channels: ChannelSet, first_row: int
    ) -> None:
        """The finest level with details; then the valid texels to `channels`."""
        levels = len(branch.details)
        if levels > 0:
            self._synthesise(commands, branch, levels - 1)
        self._upsample(commands, branch, shown, channels, self._size(levels), first_row)

    def _size(self, level: int) -> int:
        """Samples along a side of LL, or of what so many levels made of it."""
        return self.avatar.avatar.rig.texels.size >> self.avatar.avatar.wavelet.levels << level

    def _blend_low(self, commands: Commands, branch: BranchBuffers, alpha: Buffer, size: int, blended: Buffer) -> None:
        commands.dispatch(
            self._blend_ll,
            (groups(size * groups(size, 2), LL_PAIRS), branch.channels, 1),
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

    def _synthesise(self, commands: Commands, branch: BranchBuffers, level: int) -> None:
        """One level with its details, to planes of twice the size."""
        size, finest = self._size(level), len(branch.details)
        tiles = groups(size, COARSE_TILE)
        commands.dispatch(
            self._inverse_dwt,
            (tiles, tiles, branch.channels),
            {
                "ll": self.textures[(finest - level) % 2],
                "details": self.details,
                "rec_lo": self.avatar.rec_lo,
                "rec_hi": self.avatar.rec_hi,
                "fine": self.textures[(finest - level - 1) % 2],
            },
            channels=branch.channels,
            size=size,
            taps=self.avatar.taps,
        )

    def _upsample(
        self,
        commands: Commands,
        branch: BranchBuffers,
        shown: BranchLevel,
        channels: ChannelSet,
        size: int,
        first_row: int,
    ) -> None:
        """All levels without details, from planes of `size`, and the static offset, at the valid texels.

        Those in reach of expressions bend with geometry, and are lit with appearance.
        """
        level, upsampling, is_geometry = channels.level, shown.upsampling, first_row == 0
        buffers = {
            "ll": self.textures[0],
            "upsampling": upsampling.taps,
            "tiles": level.tiles,
            "static_offset": shown.static_offset.words,
            "texel_channels": channels.texel_channels,
        }
        constants: dict[str, Any] = {
            "static_offset_layout": shown.static_offset.layout,
            "channels": branch.channels,
            "size": size,
            "factor": upsampling.factor,
            "reach": upsampling.reach,
            "delay": upsampling.delay,
            "texel_count": level.splat_count,
        }
        if channels.expressive:
            kernel = self._bend_texels if is_geometry else self._light_texels
            if is_geometry:
                buffers |= {"faces": level.places.faces, "texels": level.places.texels}
                buffers |= {"vertex_bends": self.vertex_bends}
            commands.dispatch(kernel, (level.tile_count, 1, 1), buffers, **constants)
            return
        batches = groups(branch.channels, BATCH)
        commands.dispatch(
            self._upsample_texels, (level.tile_count, 1, batches), buffers, **constants, first_row=first_row
        )


def groups(count: int, size: int) -> int:
    """How many groups of `size` hold `count` elements."""
    return -(-count // size)
