"""One frame of an avatar: the dispatches from a window of poses to splats sorted for one or two eyes.

Kept a plain list in the order of the kernels, so that unity-package/Runtime/AvatarFrame.cs reads line for line like it.
"""

from collections.abc import Sequence

import numpy as np

from mua.arrays import Array
from mua.camera import NEAR, Camera
from mua.errors import InputError
from mua.gpu import Buffer, Commands, Device
from mua.motion.descriptor import describe_window
from mua.player.buffers import AvatarBuffers, BandBuffers, BranchBuffers, LayerBuffers
from mua.player.draw import SortedSplats
from mua.texture.channels import APPEARANCE, CHANNELS, GEOMETRY

EYES = 2  # at most
FLOAT = 4  # bytes
LAYER_ROWS, MESH_COLUMNS = 8, 64  # outputs of a group of MlpMatmul and of MlpMatmulTransposed
LL_TEXELS = 64  # of a group of BlendLl
DETAIL_TILE = 24  # texels along a side of a group of BlendDetail
COARSE_TILE = 16  # samples along a side that a group of InverseDwt and InverseDwtLowPass doubles
STATIC_TEXELS = 256  # of a group of AddStatic
SKINNED = 64  # vertices or texels of a group of BlendVertices and SkinSplats
PROJECTED = 256  # splats of a group of SplatProject and SplatCompact
SORTED = 2048  # keys of a group of the sort
DIGITS = 256  # values of 8 bits
DIGIT_SHIFTS = (0, 8)
SORT_ARGUMENTS = 16  # byte of `arguments` at which the group counts of the sort stand


class AvatarFrame:
    """The buffers between the kernels, sized once and reused by every frame.

    A splat's colour is computed once for both eyes, towards the mean of their positions: degree-1 harmonics turn with
    the direction, and two eyes 63 mm apart see an avatar a metre away in directions 4 degrees apart.
    """

    def __init__(self, device: Device, avatar: AvatarBuffers) -> None:
        """Errors: InputError where an intermediate buffer is more than the device can bind or hold."""
        rig = avatar.avatar.rig
        self.avatar = avatar
        self.splat_count = len(rig.texels.texels)
        self.vertex_count = len(rig.mesh.vertices)
        self.root = np.zeros(3)  # world position of the root joint, metres, as of the last decode
        self._load_kernels(device)
        self._create_buffers(device)

    def _load_kernels(self, device: Device) -> None:
        self._mlp_matmul = device.kernel("mlp_matmul.compute", "MlpMatmul")
        self._mlp_matmul_transposed = device.kernel("mlp_matmul.compute", "MlpMatmulTransposed")
        self._blend_ll = device.kernel("blend_subbands.compute", "BlendLl")
        self._blend_detail = device.kernel("blend_subbands.compute", "BlendDetail")
        self._inverse_dwt = device.kernel("inverse_dwt.compute", "InverseDwt")
        self._inverse_dwt_low_pass = device.kernel("inverse_dwt.compute", "InverseDwtLowPass")
        self._add_static = device.kernel("inverse_dwt.compute", "AddStatic")
        self._blend_vertices = device.kernel("dq_skinning.compute", "BlendVertices")
        self._skin_splats = device.kernel("dq_skinning.compute", "SkinSplats")
        self._splat_project = device.kernel("splat_project.compute", "SplatProject")
        self._scan_counts = device.kernel("splat_project.compute", "ScanCounts")
        self._splat_compact = device.kernel("splat_project.compute", "SplatCompact")
        self._count_digits = device.kernel("splat_sort.compute", "CountDigits")
        self._scan_digits = device.kernel("splat_sort.compute", "ScanDigits")
        self._scatter_digits = device.kernel("splat_sort.compute", "ScatterDigits")

    def _create_buffers(self, device: Device) -> None:
        avatar, buffer = self.avatar.avatar, device.buffer
        splats, vertices, joints = self.splat_count, self.vertex_count, len(avatar.rig.skeleton.names)
        branches = (self.avatar.geometry, self.avatar.appearance)
        layers = [*self.avatar.coarse_mlp, *(layer for branch in branches for layer in branch.mlp)]
        activations = FLOAT * max(layer.outputs for layer in layers)
        texture = FLOAT * max(branch.channels for branch in branches) * avatar.rig.texels.size**2
        details = [3 * b.channels * d.size**2 for b in branches for d in b.details]
        self.descriptor = buffer(FLOAT * avatar.encoding.width, name="descriptor")
        self.activations = tuple(buffer(activations, name=f"activations {i}") for i in range(2))
        self.mesh = buffer(FLOAT * 3 * vertices, name="mesh")  # [V, 3] canonical vertices
        self.details = buffer(FLOAT * max(details, default=0), name="details")
        self.textures = tuple(buffer(texture >> 2 * i, name=f"texture {i}") for i in range(2))  # finest, and its ll
        self.texel_channels = buffer(FLOAT * CHANNELS * splats, name="texel_channels")  # [23, N]
        self.joints = buffer(FLOAT * 8 * joints, name="joints")  # [J, 8]
        self.vertex_dq = buffer(FLOAT * 8 * vertices, name="vertex_dq")  # [V, 8]
        self.splats = buffer(64 * splats, name="splats")  # [N, 16] words (mua.kernels.dq_skinning.pack_splats)
        self.ellipses = buffer(FLOAT * 6 * EYES * splats, name="ellipses")  # [E, N, 6]
        self.colors = buffer(8 * splats, name="colors")  # [N, 4] halves
        self.flags = buffer(4 * splats, name="flags")
        self.group_counts = buffer(4 * _groups(splats, PROJECTED), name="group_counts")
        self.arguments = buffer(32, name="arguments", indirect=True)
        self.keys = tuple(buffer(4 * splats, name=f"keys {i}") for i in range(2))
        self.orders = tuple(buffer(4 * splats, name=f"order {i}") for i in range(2))
        self.digit_counts = buffer(4 * DIGITS * _groups(splats, SORTED), name="digit_counts")
        self.digit_totals = buffer(4 * DIGITS, name="digit_totals")
        self.sorted = SortedSplats(  # two passes of the sort end where they began
            splats, self.splats, self.ellipses, self.colors, self.orders[0], self.arguments
        )

    def decode(
        self,
        commands: Commands,
        rotations: Array,  # [k, J, 4] local joint rotations, newest first
        translation: Array,  # [k, 3] local translation of the root joint, metres
    ) -> None:
        """Append the dispatches from a window of poses to posed splats.

        What depends on the pose alone is written to the device at once: submit before the next decode.
        """
        self._write_pose(rotations, translation)
        self._coarse(commands)
        self._branch(commands, self.avatar.geometry, first_channel=GEOMETRY.start)
        self._branch(commands, self.avatar.appearance, first_channel=APPEARANCE.start)
        self._pose(commands)

    def sort(self, commands: Commands, cameras: Sequence[Camera]) -> None:
        """Append the dispatches from posed splats to `sorted`, the splats that one or two eyes see, back to front.

        Errors: InputError unless there are one or two cameras of one screen.
        """
        if not 1 <= len(cameras) <= EYES or any(camera.screen != cameras[0].screen for camera in cameras):
            screens = ", ".join("x".join(map(str, camera.screen)) for camera in cameras)
            raise InputError(f"cameras have the screens [{screens}]; expected one or {EYES} of one size")
        self._project(commands, cameras)
        for i, shift in enumerate(DIGIT_SHIFTS):
            self._sort_digit(commands, shift, source=i % 2)

    def _write_pose(self, rotations: Array, translation: Array) -> None:
        avatar = self.avatar.avatar
        skeleton, normalization = avatar.rig.skeleton, avatar.normalization
        descriptor = describe_window(skeleton, avatar.encoding, rotations, translation)
        self.descriptor.write(((descriptor - normalization.mean) / normalization.scale).astype(np.float32))
        self.joints.write(skeleton.skinning(rotations[0], translation[0]).astype(np.float32))
        self.root = skeleton.world(rotations[0], translation[0])[1][skeleton.root]

    def _mlp(self, commands: Commands, mlp: tuple[LayerBuffers, ...]) -> Buffer:
        """What the MLP makes of the descriptor; good until the next MLP."""
        x = self.descriptor
        for i, layer in enumerate(mlp):
            y = self.activations[i % 2]
            commands.dispatch(
                self._mlp_matmul,
                (_groups(layer.outputs, LAYER_ROWS), 1, 1),
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
            (_groups(basis.outputs, MESH_COLUMNS), 1, 1),
            {"weight": basis.weight.words, "bias": basis.bias.words, "x": coefficients, "y": self.mesh},
            weight_layout=basis.weight.layout,
            bias_layout=basis.bias.layout,
            inputs=basis.inputs,
            outputs=basis.outputs,
            relu=0,
        )

    def _branch(self, commands: Commands, branch: BranchBuffers, *, first_channel: int) -> None:
        """Coefficients, LL, then level by level to the whole texture; its valid texels go to `texel_channels`."""
        alpha = self._mlp(commands, branch.mlp)
        levels = self.avatar.avatar.wavelet.levels
        size = self.avatar.avatar.rig.texels.size >> levels
        self._blend_low(commands, branch, alpha, size, self.textures[levels % 2])
        offset = branch.channels * branch.rank
        for level in range(levels):
            ll, fine = self.textures[(levels - level) % 2], self.textures[(levels - level - 1) % 2]
            if level < len(branch.details):
                self._blend_band(commands, branch, branch.details[level], alpha, offset, size)
                offset += branch.channels * branch.details[level].rank
            self._synthesise(commands, branch, ll, fine, size, detailed=level < len(branch.details))
            size *= 2
        commands.dispatch(
            self._add_static,
            (_groups(self.splat_count, STATIC_TEXELS), 1, 1),
            {
                "fine": self.textures[0],
                "texels": self.avatar.texels,
                "static_offset": branch.static_offset.words,
                "texel_channels": self.texel_channels,
            },
            static_offset_layout=branch.static_offset.layout,
            channels=branch.channels,
            size=size,
            texel_count=self.splat_count,
            first_channel=first_channel,
        )

    def _blend_low(self, commands: Commands, branch: BranchBuffers, alpha: Buffer, size: int, blended: Buffer) -> None:
        commands.dispatch(
            self._blend_ll,
            (_groups(size * size, LL_TEXELS), branch.channels, 1),
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
        tiles = _groups(size, DETAIL_TILE)
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

    def _synthesise(
        self, commands: Commands, branch: BranchBuffers, ll: Buffer, fine: Buffer, size: int, *, detailed: bool
    ) -> None:
        """One level, from planes of `size` to twice that."""
        tiles = _groups(size, COARSE_TILE)
        groups, taps = (tiles, tiles, branch.channels), len(self.avatar.avatar.wavelet.rec_lo)
        buffers = {"ll": ll, "rec_lo": self.avatar.rec_lo, "fine": fine}
        if detailed:
            buffers |= {"details": self.details, "rec_hi": self.avatar.rec_hi}
        kernel = self._inverse_dwt if detailed else self._inverse_dwt_low_pass
        commands.dispatch(kernel, groups, buffers, channels=branch.channels, size=size, taps=taps)

    def _pose(self, commands: Commands) -> None:
        commands.dispatch(
            self._blend_vertices,
            (_groups(self.vertex_count, SKINNED), 1, 1),
            {
                "joints": self.joints,
                "indices": self.avatar.skin_indices,
                "weights": self.avatar.skin_weights,
                "vertex_dq": self.vertex_dq,
            },
            vertex_count=self.vertex_count,
        )
        commands.dispatch(
            self._skin_splats,
            (_groups(self.splat_count, SKINNED), 1, 1),
            {
                "vertex_dq": self.vertex_dq,
                "mesh": self.mesh,
                "faces": self.avatar.faces,
                "triangles": self.avatar.triangles,
                "barycentrics": self.avatar.barycentrics,
                "texel_channels": self.texel_channels,
                "splats": self.splats,
            },
            texel_count=self.splat_count,
        )

    def _project(self, commands: Commands, cameras: Sequence[Camera]) -> None:
        low, high = self.avatar.avatar.bounds + self.root
        pair = (cameras[0], cameras[-1])
        groups = (_groups(self.splat_count, PROJECTED), 1, 1)
        commands.dispatch(
            self._splat_project,
            groups,
            {
                "splats": self.splats,
                "ellipses": self.ellipses,
                "colors": self.colors,
                "flags": self.flags,
                "group_counts": self.group_counts,
            },
            view=np.stack([camera.view for camera in pair]),
            projection=np.stack([camera.projection for camera in pair]),
            camera=np.append(np.mean([camera.position for camera in cameras], axis=0), 1),
            bounds_low=np.append(low, 1),
            bounds_high=np.append(high, 1),
            screen=np.array(cameras[0].screen),
            near=NEAR,
            eyes=len(cameras),
            splat_count=self.splat_count,
        )
        commands.dispatch(
            self._scan_counts,
            (1, 1, 1),
            {"group_counts": self.group_counts, "arguments": self.arguments},
            splat_count=self.splat_count,
            instances=1,
        )
        commands.dispatch(
            self._splat_compact,
            groups,
            {
                "flags": self.flags,
                "group_counts": self.group_counts,
                "visible": self.orders[0],
                "keys": self.keys[0],
            },
            splat_count=self.splat_count,
        )

    def _sort_digit(self, commands: Commands, shift: int, *, source: int) -> None:
        """One pass of the sort, from buffers `source` of the two pairs to the others."""
        keys, arguments = self.keys[source], self.arguments
        counts = {"digit_counts": self.digit_counts, "arguments": arguments}
        totals = {**counts, "digit_totals": self.digit_totals}
        target = {"sorted_keys": self.keys[1 - source], "sorted_values": self.orders[1 - source]}
        commands.dispatch_indirect(self._count_digits, arguments, SORT_ARGUMENTS, {"keys": keys, **counts}, shift=shift)
        commands.dispatch(self._scan_digits, (DIGITS, 1, 1), totals)
        commands.dispatch_indirect(
            self._scatter_digits,
            arguments,
            SORT_ARGUMENTS,
            {"keys": keys, "values": self.orders[source], **totals, **target},
            shift=shift,
        )


def _groups(count: int, size: int) -> int:
    """Groups of `size` that hold `count`."""
    return -(-count // size)
