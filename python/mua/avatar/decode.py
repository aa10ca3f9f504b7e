"""From an avatar and a window of poses to posed splats, by the reference kernels."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from mua import rotation
from mua.arrays import Array
from mua.avatar.model import Branch, Mlp, Model, Wavelet
from mua.channels import APPEARANCE
from mua.kernels.blend_subbands import blend_detail, blend_ll
from mua.kernels.dq_skinning import blend_texels, blend_vertices, skin_splats
from mua.kernels.expressions import bend_texels, bend_triangles, bend_vertices, brighten_texels, reach_of
from mua.kernels.inverse_dwt import add_static, halve, inverse_dwt
from mua.kernels.mlp_matmul import mlp_matmul
from mua.pose.clip import Clip
from mua.pose.components import read_components
from mua.pose.descriptor import describe_window
from mua.pose.resample import sample
from mua.pose.skeleton import Pose
from mua.rig.rig import Rig


@dataclass(frozen=True, eq=False, repr=False)
class Splats:
    """A posed avatar, in the dtype it was decoded in; world space, metres; N splats in the order of the texel map."""

    canonical: Array  # [V, 3] canonical vertices
    mesh: Array  # [V, 3] posed vertices
    texture: Array  # [N, 23] raw channels (mua.channels)
    centres: Array  # [N, 3]
    rotations: Array  # [N, 4] unit, wxyz
    scales: Array  # [N, 3] standard deviations
    opacities: Array  # [N] in 0..1
    sh: Array  # [N, 12] degree 1, canonical space
    texel_dq: Array  # [N, 8] bind pose to world; the real part is R_tex
    bounds: Array  # [2, 3] lowest and highest corner of the box over which depth is keyed
    outside: float = 0.0  # share of the pose that training did not show (schemas/README.md, 3.7)
    normals: Array | None = (
        None  # [N, 3] normals of one-sided texels' triangles, not normalised, 0 for others; None: all 0
    )

    def __len__(self) -> int:
        return len(self.centres)

    def __repr__(self) -> str:
        return f"<mua.Splats: {len(self):,} splats, {self.centres.dtype}>"


@dataclass(frozen=True, eq=False)
class Unposed:
    """A decoded frame in canonical space."""

    mesh: Array  # [V, 3] canonical vertices
    texture: Array  # [N, 23] raw channels (mua.channels)
    outside: float  # share of the pose that training did not show (schemas/README.md, 3.7)


@dataclass(frozen=True, eq=False)
class PoseWindow:
    """Poses that a frame is decoded from, newest first."""

    rotations: Array  # [k, J, 4] local joint rotations
    translations: Array  # [k, J, 3] local joint translations, metres
    expressions: Array | None = None  # [E] weights of the newest frame, 0 to 1; None: all 0


def decode(avatar: Model, window: PoseWindow, *, dtype: npt.DTypeLike = np.float32) -> Splats:
    """Decode the newest frame of a window of poses; float64 gives the most exact reference."""
    unposed = decode_unposed(avatar, window, dtype=dtype)
    pose = Pose(window.rotations[0], window.translations[0])
    splats = pose_splats(avatar.rig, unposed.mesh, texture=unposed.texture, pose=pose, bounds=avatar.bounds)
    return replace(splats, outside=unposed.outside)


def decode_unposed(avatar: Model, window: PoseWindow, *, dtype: npt.DTypeLike = np.float32) -> Unposed:
    """Decode the newest frame of a window of poses in canonical space."""
    descriptor = describe_window(avatar.rig.skeleton, avatar.encoding, window.rotations, window.translations)
    read, outside = read_components(avatar.components, descriptor)
    x = read.astype(dtype)
    canonical = expand_mesh(avatar, x)
    geometry = decode_branch(avatar.geometry, avatar.wavelet, x, texels=avatar.rig.texels.texels)
    appearance = decode_branch(avatar.appearance, avatar.wavelet, x, texels=avatar.rig.texels.texels)
    texture = np.concatenate([geometry, appearance]).T
    canonical, texture = express(avatar.rig, canonical, texture=texture, weights=window.expressions)
    return Unposed(canonical, texture, float(outside))


def decode_clip_frame(
    avatar: Model,
    clip: Clip,
    *,
    frame: int,  # at the rate of the avatar's encoding
    dtype: npt.DTypeLike = np.float32,
) -> Splats:
    """Decode one frame of a clip; before its first frame, the clip stands still."""
    return decode(avatar, _window(avatar, clip, frame), dtype=dtype)


def unposed_clip_frame(
    avatar: Model,
    clip: Clip,
    *,
    frame: int,  # at the rate of the avatar's encoding
) -> Unposed:
    """One frame of a clip as `decode_clip_frame` decodes it, in canonical space."""
    return decode_unposed(avatar, _window(avatar, clip, frame))


def _window(avatar: Model, clip: Clip, frame: int) -> PoseWindow:
    """The poses, newest first, and the expressions that a frame of a clip is decoded from."""
    window = sample(clip, np.array(avatar.encoding.frames(frame)), rate=avatar.encoding.rate)
    weights = None if window.expressions is None else window.expressions[0]
    return PoseWindow(window.rotations, window.translations, weights)


def expand_mesh(
    avatar: Model,
    x: Array,  # [K] components of the descriptor
) -> Array:
    """Canonical vertices [V, 3]: F_temp, then the PCA basis."""
    coefficients = _mlp(avatar.coarse.mlp, x)
    rank = len(coefficients)
    basis = avatar.coarse.basis.reshape(rank, -1).astype(x.dtype, copy=False).T
    mean = avatar.coarse.mean.reshape(-1).astype(x.dtype, copy=False)
    return mlp_matmul(basis, mean, coefficients, relu=False).reshape(-1, 3)


def decode_branch(
    branch: Branch,
    wavelet: Wavelet,
    x: Array,  # [K] components of the descriptor
    *,
    texels: Array,  # [N] row * size + column
) -> Array:
    """Raw channels [C, N]: coefficients, subbands, synthesis over all levels and the static offset."""
    dtype = x.dtype
    alphas = _mlp(branch.mlp, x)
    splits = np.cumsum(branch.channels * np.array(branch.ranks))[:-1]
    alpha_ll, *alpha_details = (a.reshape(branch.channels, -1) for a in np.split(alphas, splits))
    texture = blend_ll(branch.ll_mean.astype(dtype, copy=False), branch.ll_basis.astype(dtype, copy=False), alpha_ll)
    for level in range(wavelet.levels):
        details = None
        if level < len(branch.details):
            band = branch.details[level]
            mean, h, w = (a.astype(dtype, copy=False) for a in (band.mean, band.h, band.w))
            details = blend_detail(mean, h, w, alpha_details[level])
        texture = inverse_dwt(texture, details, wavelet.rec_lo, wavelet.rec_hi)
    for _ in range(wavelet.coarser):
        texture = halve(texture)
    return add_static(texture, texels, branch.static.astype(dtype, copy=False))


def express(
    rig: Rig,
    canonical: Array,  # [V, 3] canonical vertices, metres
    *,
    texture: Array,  # [N, 23] raw channels at the valid texels
    weights: Array | None,  # [E] 0 to 1; None: all 0
) -> tuple[Array, Array]:
    """Vertices and texture with the expressions, as rules hold these back; the very same where all weights are 0."""
    if rig.expressions is None or weights is None:
        return canonical, texture
    expressions, texels = rig.expressions, rig.texels
    weights = expressions.shown(weights).astype(canonical.dtype)
    if not weights.any():
        return canonical, texture
    moved = expressions.displacement(weights, vertices=len(canonical))
    gains = expressions.brightening(weights, vertices=len(canonical))
    reach = reach_of(expressions.moved(weights), rig.mesh.faces, texels.triangles)
    at, about = np.flatnonzero(reach.texels), reach.vertices
    corners = np.searchsorted(about, rig.mesh.faces[texels.triangles[at]])
    barycentrics = texels.barycentrics[at].astype(canonical.dtype, copy=False)
    bends = bend_vertices(bend_triangles(canonical, moved, reach.corners), reach.starts, reach.stars)
    expressed = texture.copy(order="K")
    expressed[at] = bend_texels(bends, corners, barycentrics, texture[at])
    expressed[at] = brighten_texels(gains[about], corners, barycentrics, expressed[at])
    return canonical + moved, expressed


def pose_splats(
    rig: Rig,
    canonical: Array,  # [V, 3] canonical vertices, metres
    *,
    texture: Array,  # [N, 23] raw channels at the valid texels; its dtype is that of the frame
    pose: Pose,
    bounds: Array | None = None,  # [2, 3] box of the splats about the root joint, metres; their own box if left out
) -> Splats:
    """Skin mesh and texture, a student's or a teacher's, into the world."""
    dtype = texture.dtype
    canonical = canonical.astype(dtype, copy=False)
    faces, triangles = rig.mesh.faces, rig.texels.triangles
    barycentrics = rig.texels.barycentrics.astype(dtype, copy=False)
    joints = rig.skeleton.skinning(pose.rotations, pose.translations).astype(dtype)
    vertex_dq = blend_vertices(joints, rig.skin_indices, rig.skin_weights)
    texel_dq = blend_texels(vertex_dq, faces, triangles, barycentrics)
    centres, rotations, scales, opacities = skin_splats(texel_dq, canonical, faces, triangles, barycentrics, texture)
    root = rig.skeleton.world(pose.rotations, pose.translations)[1][rig.skeleton.root]
    return Splats(
        canonical=canonical,
        mesh=rotation.dual_transform(vertex_dq, canonical),
        texture=texture,
        centres=centres,
        rotations=rotations,
        scales=scales,
        opacities=opacities,
        sh=texture[:, APPEARANCE],
        texel_dq=texel_dq,
        bounds=box_of(centres) if bounds is None else (bounds + root).astype(dtype),
        normals=None if rig.texels.one_sided is None else texel_normals(rig, canonical, texel_dq),
    )


def texel_normals(
    rig: Rig,
    canonical: Array,  # [V, 3] canonical vertices
    texel_dq: Array,  # [N, 8] bind pose to world
) -> Array:
    """Normals [N, 3] of the texels' triangles in the world, not normalised; 0 for two-sided texels."""
    a, b, c = np.swapaxes(canonical[rig.mesh.faces[rig.texels.triangles]], 0, 1)
    normals = rotation.rotate(texel_dq[:, :4], np.cross(b - a, c - a))
    return normals if rig.texels.one_sided is None else normals * rig.texels.one_sided[:, None]


def box_of(points: Array) -> Array:
    """Lowest and highest corner [2, 3] of points [N, 3]; zeros where there are none."""
    if len(points) == 0:
        return np.zeros((2, 3), dtype=points.dtype)
    return np.stack([points.min(axis=0), points.max(axis=0)])


def _mlp(mlp: Mlp, x: Array) -> Array:
    """ReLU on every layer but the last."""
    for layer in mlp:
        weight, bias = layer.weight.astype(x.dtype, copy=False), layer.bias.astype(x.dtype, copy=False)
        x = mlp_matmul(weight, bias, x, relu=layer is not mlp[-1])
    return x
