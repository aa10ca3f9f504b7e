"""An avatar of random numbers in the shapes of a preset, so that a device can be measured without an asset.

Its body is a tube of a person's size with round ends, about as many of its texels are valid as of the paper's avatars,
and its splats are as large as their distance, so that visibility, sort and overdraw are those of a real avatar seen
from its front. It is closed, and all its texels are marked as one-sided; few give 1/16 of a pixel or more from behind.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.model import Branch, Coarse, DetailBand, Layer, Mlp
from mua.channels import LEVELS
from mua.filters import WAVELET
from mua.limits import MAX_INFLUENCES
from mua.pose.clip import Clip
from mua.pose.encoding import Components, Normalization, PoseEncoding
from mua.pose.skeleton import Skeleton
from mua.rig.character import Mesh
from mua.rig.expressions import Expressions
from mua.rig.rig import Rig
from mua.rig.texel_map import build_texel_map
from mua.rig.triangulate import triangulate
from mua.student.settings import Ranks, Settings
from mua.student.shapes import wavelet_of

HEIGHT, RADIUS = 1.7, 0.18  # metres
HOLE = 0.02  # share of the radius left at both ends, so that no triangle has zero area
RINGS, SPOKES = 102, 54  # 5,508 vertices; the template of the paper's family has 5,514
# A face as large as that of a Ready Player Me figure: 66 expressions of 40,094 entries at 2,101 vertices.
FACE_RINGS = 39  # all of whose vertices some expression moves, at the upper end
FACE = 1 / 6  # share of the texels that are in reach of these
ENTRIES = np.linspace(17, 1198, 66).astype(int)  # vertices of each expression
MOVE, LIGHT = 0.003, 0.1  # metres and a share of colours, standard deviations
JOINTS = 54  # all of them encoded, as in the family's released character
VALID = 300_000 / 768**2  # share of the texels that are valid (paper, Animatable Coarse Geometry)
ENCODING = PoseEncoding(joints=tuple(range(1, JOINTS)), rate=25.0)
FRAMES = 50  # frames of the clip
FARTHEST = 100.0  # standard deviation of a component
SWING = 0.02  # radians of one joint; 53 of them bend the tube by at most 60 degrees
OFFSET, TURN, SPREAD, LOGIT, SHADE = 0.003, 0.05, 0.1, 0.3, 0.2  # standard deviations of the moving channels


def random_avatar(settings: Settings) -> Avatar:
    """An untrained avatar, as large and as visible as a trained one; equal arguments give equal avatars."""
    rng = np.random.default_rng(0)
    rig = replace(_rig(settings.texels), expressions=_face(np.random.default_rng(1)))
    vertices = rig.mesh.vertices.astype(np.float32)
    scale = np.log(0.6 * np.sqrt(2 * np.pi * RADIUS * HEIGHT / len(rig.texels.texels)))
    geometry_means = [0.0] * 3 + [1.0, 0.0, 0.0, 0.0] + [scale] * 3 + [2.0]
    geometry_spreads = [OFFSET] * 3 + [TURN] * 4 + [SPREAD] * 3 + [LOGIT]
    return Avatar(
        name=f"random numbers, {settings.texels} texels",
        producer="mua-bench",
        rig=rig,
        encoding=ENCODING,
        components=_components(),
        coarse=Coarse(
            _mlp(rng, ENCODING.width, settings.hidden, settings.components),
            vertices,
            _normal(rng, (settings.components, *vertices.shape), OFFSET / np.sqrt(settings.components)),
        ),
        geometry=_branch(rng, rig, settings, settings.geometry, geometry_means, geometry_spreads),
        appearance=_branch(rng, rig, settings, settings.appearance, [0.0] * 12, [SHADE] * 12),
        wavelet=wavelet_of(WAVELET),
        clips=(_clip(rig.skeleton),),
        bounds=np.array([[-1, -0.3, -1], [1, HEIGHT + 0.3, 1]], dtype=np.float32),
        thumbnail=b"",
        notes="random numbers for mua-bench, not a trained avatar",
        surface=triangulate(rig.mesh, rig.texels),
    )


def _components() -> Components:
    """As many components as the descriptor has numbers, the maximum; no pose of the clip leaves their ranges."""
    directions = np.eye(ENCODING.width, dtype=np.float32)
    zeros, ones = (make(ENCODING.width, np.float32) for make in (np.zeros, np.ones))
    return Components(Normalization(zeros, ones), directions, FARTHEST * np.stack([-ones, ones]), ones)


def _rig(texels: int) -> Rig:
    """A chain of joints up a tube; its one UV chart fills VALID of the texture."""
    heights = np.linspace(0, HEIGHT, JOINTS)
    skeleton = Skeleton(
        names=tuple(f"joint {j}" for j in range(JOINTS)),
        parents=np.arange(-1, JOINTS - 1, dtype=np.int32),
        bind_rotations=np.tile([1.0, 0, 0, 0], (JOINTS, 1)),
        bind_translations=np.stack([np.zeros(JOINTS), np.diff(heights, prepend=0), np.zeros(JOINTS)], axis=1),
        root=0,
    )
    mesh = _tube()
    closeness = np.maximum(1 - np.abs(mesh.vertices[:, 1:2] - heights) / (MAX_INFLUENCES / 2 * heights[1]), 0)
    indices = np.argsort(-closeness, axis=1, kind="stable")[:, :MAX_INFLUENCES].astype(np.int32)
    weights = np.take_along_axis(closeness, indices, axis=1)
    weights = (weights / weights.sum(axis=1, keepdims=True)).astype(np.float32)
    texel_map = build_texel_map(mesh, texels)
    one_sided = np.ones(len(texel_map.texels), bool)
    return Rig(skeleton, mesh, indices, weights, replace(texel_map, one_sided=one_sided))


def _tube() -> Mesh:
    """Rings at equal distances along a profile of half a circle, a straight line and half a circle."""
    quarter = np.pi / 2 * RADIUS
    length = HEIGHT - 2 * RADIUS + 2 * quarter
    shares = np.interp(np.arange(RINGS), [0, RINGS - 2 - FACE_RINGS, RINGS - 1], [0, 1 - FACE, 1])  # closer in the face
    along = HOLE * RADIUS + shares * (length - 2 * HOLE * RADIUS)
    inwards = np.minimum(along, length - along)  # distance from the nearer end
    turn = np.minimum(inwards / RADIUS, np.pi / 2)
    rise = RADIUS * (1 - np.cos(turn)) + np.maximum(inwards - quarter, 0)
    height, angle = np.meshgrid(
        np.where(along < length / 2, rise, HEIGHT - rise), 2 * np.pi * np.arange(SPOKES) / SPOKES, indexing="ij"
    )
    radius = RADIUS * np.sin(turn)[:, None]
    vertices = np.stack([radius * np.sin(angle), height, radius * np.cos(angle)], axis=-1).reshape(-1, 3)
    margin = (1 - np.sqrt(VALID)) / 2
    columns, rows = np.meshgrid(np.linspace(margin, 1 - margin, SPOKES + 1), 1 - margin - shares * (1 - 2 * margin))
    ring, spoke = (i.ravel() for i in np.indices((RINGS - 1, SPOKES)))
    quads = np.stack([(ring, spoke), (ring, spoke + 1), (ring + 1, spoke + 1), (ring + 1, spoke)])  # [4, 2, quads]
    triangles = np.concatenate([quads[[0, 1, 2]], quads[[0, 2, 3]]], axis=2).transpose(2, 0, 1)  # [F, 3, 2]
    return Mesh(
        vertices=vertices,
        faces=(triangles[..., 0] * SPOKES + triangles[..., 1] % SPOKES).astype(np.int32),
        uv=np.stack([columns, rows], axis=-1).reshape(-1, 2),
        uv_faces=(triangles[..., 0] * (SPOKES + 1) + triangles[..., 1]).astype(np.int32),
    )


def _face(rng: np.random.Generator) -> Expressions:
    """Each expression moves and lights vertices that follow one another in the rings."""
    first = (RINGS - FACE_RINGS) * SPOKES
    begins = rng.integers(first, RINGS * SPOKES - ENTRIES, endpoint=True)
    begins[[0, -1, -2]] = first, RINGS * SPOKES - ENTRIES[-1], first
    count = int(ENTRIES.sum())
    return Expressions(
        names=tuple(f"expression {number}" for number in range(len(ENTRIES))),
        starts=np.concatenate([[0], np.cumsum(ENTRIES)]).astype(np.int32),
        vertices=np.concatenate([np.arange(b, b + n) for b, n in zip(begins, ENTRIES, strict=True)]).astype(np.int32),
        offsets=_normal(rng, (count, 3), MOVE),
        gains=_normal(rng, (count,), LIGHT),
    )


def _clip(skeleton: Skeleton) -> Clip:
    """The tube sways to its sides and back."""
    swing = SWING * np.sin(2 * np.pi * np.arange(FRAMES) / FRAMES)
    axes = np.tile([0.0, 0.0, 1.0], (FRAMES, JOINTS, 1))
    rotations = rotation.from_axis_angle(axes, np.tile(swing[:, None], (1, JOINTS)))
    return Clip("sway", ENCODING.rate, rotations, np.tile(skeleton.bind_translations, (FRAMES, 1, 1)))


def _branch(
    rng: np.random.Generator,
    rig: Rig,
    settings: Settings,
    ranks: Ranks,
    means: Sequence[float],  # [C] means of the texture's channels
    spreads: Sequence[float],  # [C] their deviations
) -> Branch:
    """Bands whose deviation is the channel's; a constant gains two per level through the analysis."""
    channels, side = len(means), settings.texels >> LEVELS
    mean, spread = (np.array(a, dtype=np.float32)[:, None, None] for a in (means, spreads))
    return Branch(
        mlp=_mlp(rng, ENCODING.width, settings.hidden, channels * ranks.total),
        ll_mean=2**LEVELS * (mean + spread * _normal(rng, (channels, side, side), 0.1)),
        ll_basis=spread[..., None] * _normal(rng, (channels, ranks.ll, side, side), 1 / np.sqrt(ranks.ll)),
        details=tuple(_band(rng, spread, rank, side << i) for i, rank in enumerate((ranks.d3, ranks.d2))),
        static=spread[..., 0] * _normal(rng, (channels, len(rig.texels.texels)), 0.1),
    )


def _band(
    rng: np.random.Generator,
    spread: Array,  # [C, 1, 1]
    rank: int,
    side: int,
) -> DetailBand:
    shape = (3, len(spread), rank, side)
    mean = spread * _normal(rng, (3, len(spread), side, side), 0.1)
    return DetailBand(mean, spread * _normal(rng, shape, 1 / np.sqrt(rank)), _normal(rng, shape, 1.0))


def _mlp(rng: np.random.Generator, inputs: int, hidden: int, outputs: int) -> Mlp:
    sizes = (inputs, hidden, hidden, outputs)
    return tuple(Layer(_normal(rng, (n, m), 1 / np.sqrt(m)), _normal(rng, (n,), 0.1)) for m, n in pairwise(sizes))


def _normal(rng: np.random.Generator, shape: tuple[int, ...], scale: float) -> Array:
    return np.float32(scale) * rng.standard_normal(shape, dtype=np.float32)
