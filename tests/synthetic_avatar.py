"""A small random avatar for tests: a three-joint tube of 12 vertices, 32 x 32 texels, four levels (LL 2 x 2)."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pywt
from people import upright

from mua import rotation
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.model import Branch, Coarse, DetailBand, Layer, Mlp, Wavelet
from mua.pose.clip import Clip
from mua.pose.encoding import Components, Normalization, PoseEncoding
from mua.pose.skeleton import Skeleton
from mua.rig.character import Mesh
from mua.rig.rig import Rig
from mua.rig.texel_map import TexelMap

SIZE = 32
LEVELS = 4
RINGS, SPOKES = 4, 3
RANKS = (4, 3, 2)  # LL, D3, D2
PCA = 4
HIDDEN = 16
COMPONENTS = 20


def synthetic_avatar(seed: int = 0, *, wavelet: str = "bior4.4", levels: int = LEVELS) -> Avatar:
    """The same avatar for the same arguments; all tensors float32, wavelet taps and UV float64."""
    rng = np.random.default_rng(seed)
    rig = synthetic_rig()
    encoding = PoseEncoding(joints=(1, 2), rate=24.0, translated=(2,))
    taps = pywt.Wavelet(wavelet)
    side, texels = SIZE >> levels, len(rig.texels.texels)
    vertices = rig.mesh.vertices.astype(np.float32)
    return Avatar(
        name="synthetic",
        producer="mua tests",
        rig=rig,
        encoding=encoding,
        components=synthetic_components(rng, encoding.width, seed),
        coarse=Coarse(_mlp(rng, encoding.width, PCA), vertices, _normal(rng, (PCA, *vertices.shape), 0.01)),
        geometry=_branch(rng, encoding.width, [0] * 3 + [1, 0, 0, 0] + [-3] * 3 + [2], side, texels),
        appearance=_branch(rng, encoding.width, [0] * 12, side, texels),
        wavelet=Wavelet(wavelet, levels, np.array(taps.rec_lo), np.array(taps.rec_hi)),
        clips=(synthetic_clip(rig.skeleton, rng),),
        bounds=np.array([[-1, -1, -1], [1, 2, 1]], dtype=np.float32),
        thumbnail=b"",
        notes="random numbers in the shape of an avatar",
    )


def synthetic_components(rng: np.random.Generator, width: int, seed: int) -> Components:
    """Random ones; poses of the clip are within the ranges of some and beyond those of others."""
    normalization = Normalization(scale=rng.uniform(0.5, 2, width).astype(np.float32), mean=_normal(rng, width, 0.1))
    rng = np.random.default_rng([seed, 1])  # its own: what else is drawn does not depend on the components
    middle, half = _normal(rng, COMPONENTS, 0.5), np.abs(_normal(rng, COMPONENTS, 1.0))
    return Components(
        normalization=normalization,
        directions=_normal(rng, (COMPONENTS, width), 1 / np.sqrt(width)),
        ranges=np.stack([middle - half, middle + half]),
        margins=np.abs(_normal(rng, COMPONENTS, 0.3)),
    )


def with_random_poses(avatar: Avatar, frames: int) -> Avatar:
    """With a clip of random turns and places of all joints, far outside of what training showed."""
    rng, skeleton, own = np.random.default_rng(1), avatar.rig.skeleton, avatar.components
    shape = (frames, len(skeleton.names))
    turns = rotation.normalize(rng.normal(size=(*shape, 4)))
    clip = Clip("random poses", 24.0, turns, skeleton.bind_translations + rng.normal(size=(*shape, 3)) / 4)
    return replace(avatar, clips=(clip,), components=replace(own, directions=100 * own.directions))


def with_surface(avatar: Avatar) -> Avatar:
    """The same avatar with triangles over its texels, as bakes store them."""
    from mua.rig.triangulate import triangulate  # here, because it needs more packages than an avatar

    return replace(avatar, surface=triangulate(avatar.rig.mesh, avatar.rig.texels))


def sparse_avatar(seed: int) -> Avatar:
    """A synthetic avatar of which a fifth of the texels is not valid, with a surface, and more than half one-sided."""
    avatar = synthetic_avatar(seed)
    kept, one_sided = np.random.default_rng(seed).random((2, len(avatar.rig.texels.texels))) < [[0.8], [0.6]]
    return with_surface(with_texels(with_one_sided(avatar, one_sided), kept))


def with_one_sided(
    avatar: Avatar,
    one_sided: Array | None,  # [N] bool
) -> Avatar:
    """The same avatar, some of whose texels are not seen from behind."""
    return replace(avatar, rig=replace(avatar.rig, texels=replace(avatar.rig.texels, one_sided=one_sided)))


def texels_at(texels: TexelMap, kept: Array | slice) -> TexelMap:
    """Some of the valid texels of a map."""
    return replace(
        texels,
        texels=texels.texels[kept],
        triangles=texels.triangles[kept],
        barycentrics=texels.barycentrics[kept],
        one_sided=None if texels.one_sided is None else texels.one_sided[kept],
    )


def with_texels(avatar: Avatar, kept: Array) -> Avatar:
    """The same avatar, valid at some of its texels alone: [N] for each whether it is kept."""
    few = texels_at(avatar.rig.texels, kept)
    branches = [replace(b, static=b.static[:, kept]) for b in (avatar.geometry, avatar.appearance)]
    return replace(avatar, rig=replace(avatar.rig, texels=few), geometry=branches[0], appearance=branches[1])


def empty_avatar() -> Avatar:
    """A synthetic avatar without valid texels."""
    avatar = synthetic_avatar()
    return with_texels(avatar, np.zeros(len(avatar.rig.texels.texels), bool))


def synthetic_rig() -> Rig:
    """A triangular tube along +Y, open at both ends, with a UV seam along it; joints at heights 0, 0.5 and 1 m."""
    skeleton = upright(("root", "middle", "tip"), (-1, 0, 1), [[0, 0.1, 0], [0, 0.5, 0], [0, 0.5, 0]])
    height, angle = np.meshgrid(np.linspace(0, 1.5, RINGS), 2 * np.pi * np.arange(SPOKES) / SPOKES, indexing="ij")
    vertices = np.stack([0.3 * np.sin(angle), height, 0.3 * np.cos(angle)], axis=-1).reshape(-1, 3)
    columns, rows = np.meshgrid(np.linspace(0.1, 0.9, SPOKES + 1), np.linspace(0.9, 0.1, RINGS))
    corners = [(r, s) for r in range(RINGS - 1) for s in range(SPOKES)]
    quads = [[(r, s), (r, s + 1), (r + 1, s + 1), (r + 1, s)] for r, s in corners]
    triangles = [[q[i] for i in half] for q in quads for half in ((0, 1, 2), (0, 2, 3))]
    mesh = Mesh(
        vertices=vertices,
        faces=np.array([[r * SPOKES + s % SPOKES for r, s in t] for t in triangles], dtype=np.int32),
        uv=np.stack([columns, rows], axis=-1).reshape(-1, 2),
        uv_faces=np.array([[r * (SPOKES + 1) + s for r, s in t] for t in triangles], dtype=np.int32),
    )
    skin = np.maximum(0, 1 - 2 * np.abs(vertices[:, 1:2] - [[0.1, 0.6, 1.1]])) + 0.05
    order = np.argsort(-skin, axis=1, kind="stable")
    indices, weights = np.zeros((len(vertices), 8), np.int32), np.zeros((len(vertices), 8), np.float32)
    indices[:, :3] = order
    weights[:, :3] = np.take_along_axis(skin / skin.sum(axis=1, keepdims=True), order, axis=1)
    return Rig(skeleton, mesh, indices, weights, _texel_map(mesh))


def synthetic_clip(skeleton: Skeleton, rng: np.random.Generator, *, frames: int = 7) -> Clip:
    """Random smooth turning of every joint while the root drifts and the last joint moves in its parent."""
    axes = rotation.normalize(rng.normal(size=(len(skeleton.names), 3)))
    angles = 0.6 * np.sin(np.arange(frames)[:, None] / 2 + np.arange(len(skeleton.names)))
    drift = skeleton.bind_translations[skeleton.root] + np.arange(frames)[:, None] * [0.02, 0, 0.05]
    translations = skeleton.with_root(drift)
    translations[:, -1] += 0.1 * np.sin(np.arange(frames)[:, None] / [2, 3, 4])
    return Clip("wave", 24.0, rotation.from_axis_angle(axes, angles), translations)


def _texel_map(mesh: Mesh) -> TexelMap:
    """Texels whose centre lies in a UV triangle; the first triangle that holds it wins."""
    row, column = np.divmod(np.arange(SIZE * SIZE), SIZE)
    centres = (np.stack([column, row], axis=1) + 0.5) / SIZE
    corners = mesh.uv[mesh.uv_faces]  # [F, 3, 2]
    system = np.concatenate([corners, np.ones((len(corners), 3, 1))], axis=2).transpose(0, 2, 1)
    wanted = np.concatenate([centres, np.ones((len(centres), 1))], axis=1)
    bary = np.einsum("fij,nj->nfi", np.linalg.inv(system), wanted)
    inside = bary.min(axis=2) >= 0
    texels = np.flatnonzero(inside.any(axis=1))
    triangles = np.argmax(inside[texels], axis=1)
    return TexelMap(
        SIZE, texels.astype(np.int32), triangles.astype(np.int32), bary[texels, triangles].astype(np.float32), 0
    )


def _branch(rng: np.random.Generator, inputs: int, means: Sequence[float], side: int, texels: int) -> Branch:
    channels = len(means)
    gain = SIZE // side  # of a constant through the analysis, two per level in 2D
    constant = np.array(means, dtype=np.float32)[:, None, None] * gain
    return Branch(
        mlp=_mlp(rng, inputs, channels * sum(RANKS)),
        ll_mean=constant + _normal(rng, (channels, side, side), 0.3),
        ll_basis=_normal(rng, (channels, RANKS[0], side, side), 0.3),
        details=tuple(_band(rng, channels, rank, side << i) for i, rank in enumerate(RANKS[1:])),
        static=_normal(rng, (channels, texels), 0.01),
    )


def _band(rng: np.random.Generator, channels: int, rank: int, side: int) -> DetailBand:
    shape = (3, channels, rank, side)
    return DetailBand(_normal(rng, (3, channels, side, side), 0.1), _normal(rng, shape, 0.2), _normal(rng, shape, 0.2))


def _mlp(rng: np.random.Generator, inputs: int, outputs: int) -> Mlp:
    """One that reads as many of `inputs` as there are components."""
    sizes = (inputs, HIDDEN, HIDDEN, outputs)
    first, *others = (Layer(_normal(rng, (n, m), 1 / np.sqrt(m)), _normal(rng, n, 0.1)) for m, n in pairwise(sizes))
    return Layer(first.weight[:, :COMPONENTS], first.bias), *others


def _normal(rng: np.random.Generator, shape: int | tuple[int, ...], scale: float) -> Array:
    return (scale * rng.normal(size=shape)).astype(np.float32)
