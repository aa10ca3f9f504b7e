"""Golden cases of the kernels from pose to channels, with inputs and bounds of the kernels' own tests."""

from functools import partial

import numpy as np
from bent_cases import (
    BENT_BOUND,
    MEAN_BOUND,
    MIRROR,
    PER_METRE,
    ROOT_BOUND,
    bent_texels,
    lit_texels,
    random_stars,
    random_targets,
    triangle_words,
    triangles,
    vertex_numbers,
)
from dwt_cases import taps, upsampling_bound
from golden_case import UNTOUCHED, UNWRITTEN, Case, Expected, halves
from layer_cases import layer, shader_bound
from skinned_cases import (
    BLEND_BOUND,
    JOINTS,
    random_influences,
    random_joints,
)
from splat_rounding import ULP
from stored import STORAGES, groups, store

from mua.asset.tensors import Element
from mua.kernels.blend_subbands import blend_detail, blend_ll
from mua.kernels.dq_skinning import blend_vertices
from mua.kernels.expressions import bend_triangles, bend_vertices, pack_entries
from mua.kernels.inverse_dwt import (
    inverse_dwt,
    pack_planes,
    texel_tiles,
    unpack_planes,
    upsample_texels,
    upsampling_taps,
    whole_words,
)
from mua.kernels.mlp_matmul import mlp_matmul


def mlp_matmul_cases() -> list[Case]:
    return [_layer(s, relu=relu) for s in STORAGES for relu in (0, 1)] + [_mesh(s) for s in STORAGES]


def blend_subbands_cases() -> list[Case]:
    return [make(s) for make in (_blend_ll, _blend_detail) for s in STORAGES]


def inverse_dwt_cases() -> list[Case]:
    levels = [_level(name) for name in ("bior4.4", "bior2.2")]
    texels = [_texels_of(storage, levels=n) for storage in STORAGES for n in (1, 2)]
    return [*levels, *texels]


def dq_skinning_cases() -> list[Case]:
    return [_vertices()]


def expressions_cases() -> list[Case]:
    return [_targets(), _triangles(), _bent_vertices(), _bent_texels(), _lit_texels()]


def _layer(storage: Element, *, relu: int) -> Case:
    raw_weight, raw_bias, x = layer(37, 29, np.float32)
    weight, bias = store(raw_weight, storage, rows=37), store(raw_bias, "f32")
    y = mlp_matmul(weight.values, bias.values, x.astype(float), relu=bool(relu))
    bound = float(shader_bound(weight.values, bias.values, x).max())
    return Case(
        f"{storage}, {'ReLU' if relu else 'linear'}",
        "MlpMatmul",
        groups((37, 8)),
        {"weight_layout": weight.layout, "bias_layout": bias.layout, "inputs": 29, "outputs": 37, "relu": relu},
        {"weight": weight.words, "bias": bias.words, "x": x, "y": np.full(37, UNTOUCHED)},
        (Expected("y", "float", y, bound),),
    )


def _mesh(storage: Element) -> Case:
    raw_weight, raw_bias, x = layer(69, 11, np.float32)
    basis, mean = store(np.ascontiguousarray(raw_weight.T), storage, rows=11), store(raw_bias, storage)
    y = mlp_matmul(basis.values.T, mean.values, x.astype(float), relu=False)
    bound = float(shader_bound(basis.values.T, mean.values, x).max())
    return Case(
        storage,
        "MlpMatmulTransposed",
        groups((69, 64)),
        {"weight_layout": basis.layout, "bias_layout": mean.layout, "inputs": 11, "outputs": 69},
        {"weight": basis.words, "bias": mean.words, "x": x, "y": np.full(69, UNTOUCHED)},
        (Expected("y", "float", y, bound),),
    )


def _blend_ll(storage: Element) -> Case:
    channels, rank, size, offset = 3, 5, 9, 7
    rng = np.random.default_rng(1)
    mean = store(rng.normal(size=(channels, size, size)), storage, rows=channels)
    basis = store(rng.normal(size=(channels, rank, size, size)), storage, rows=channels * rank)
    alpha = rng.normal(size=(channels, rank)).astype(np.float32)
    blended = blend_ll(mean.values, basis.values, alpha.astype(float))
    blended = np.pad(blended, ((0, 0), (0, 0), (0, size % 2)), mode="edge")
    magnitude = blend_ll(np.abs(mean.values), np.abs(basis.values), np.abs(alpha).astype(float)).max()
    return Case(
        storage,
        "BlendLl",
        groups((size * -(-size // 2), 64), (channels, 1)),
        {
            **{"mean_layout": mean.layout, "basis_layout": basis.layout},
            **{"channels": channels, "rank": rank, "size": size, "alpha_offset": offset},
        },
        {
            **{"mean": mean.words, "basis": basis.words, "alpha": np.append(np.full(offset, UNTOUCHED), alpha)},
            "blended": np.full(blended.size // 2, UNWRITTEN),
        },
        (halves("blended", blended, (rank + 2) * ULP * magnitude),),
    )


def _blend_detail(storage: Element) -> Case:
    channels, rank, size, offset = 2, 5, 27, 3
    rng = np.random.default_rng(2)
    mean = store(rng.normal(size=(3, channels, size, size)), storage, rows=3 * channels)
    h, w = (store(f, storage, rows=3 * channels * rank) for f in rng.normal(size=(2, 3, channels, rank, size)))
    alpha = rng.normal(size=(channels, rank)).astype(np.float32)
    blended = blend_detail(mean.values, h.values, w.values, alpha.astype(float))
    blended = np.concatenate([blended, mean.values[..., -1:]], axis=-1)  # what fills up the last word
    magnitude = blend_detail(np.abs(mean.values), np.abs(h.values), np.abs(w.values), np.abs(alpha).astype(float)).max()
    return Case(
        storage,
        "BlendDetail",
        groups((size, 24), (size, 24), (3 * channels, 1)),
        {
            **{"mean_layout": mean.layout, "h_layout": h.layout, "w_layout": w.layout},
            **{"channels": channels, "rank": rank, "size": size, "alpha_offset": offset},
        },
        {
            **{"mean": mean.words, "h": h.words, "w": w.words},
            **{"alpha": np.append(np.full(offset, UNTOUCHED), alpha), "blended": np.full(blended.size // 2, UNWRITTEN)},
        },
        (halves("blended", blended, (rank + 3) * ULP * magnitude),),
    )


def _level(wavelet: str) -> Case:
    channels, size = 2, 19
    lo, hi = (whole_words(t).astype(np.float32) for t in taps(wavelet))
    bands = np.random.default_rng(3).normal(size=(4, channels, size, size)).astype(np.float32)
    packed = pack_planes(bands)
    ll, details = unpack_planes(packed)[0], unpack_planes(packed)[1:]
    fine = inverse_dwt(ll.astype(float), details.astype(float), lo.astype(float), hi.astype(float))
    gain = (np.abs(lo).sum(dtype=float) + np.abs(hi).sum(dtype=float)) ** 2
    sums_bound = 2 * (len(lo) + 1) * ULP * gain * float(np.abs(bands).max())
    return Case(
        wavelet,
        "InverseDwt",
        groups((size, 16), (size, 16), (channels, 1)),
        {"size": size, "taps": len(lo), "channels": channels},
        {
            **{"ll": packed[0], "rec_lo": lo, "details": packed[1:], "rec_hi": hi},
            "fine": np.full(fine.size // 2, UNWRITTEN),
        },
        (halves("fine", fine, sums_bound),),
    )


def _texels_of(storage: Element, *, levels: int) -> Case:
    channels, rows, size, count, first = 5, 2, 5, 101, 2
    rng = np.random.default_rng(4)
    lo = taps("bior4.4")[0]
    packed = pack_planes(rng.normal(size=(channels, size, size)))
    ll = unpack_planes(packed)
    side = size << levels
    texels = np.sort(rng.permutation(side * side)[: min(count, side * side)])
    count = len(texels)
    offset = store(rng.normal(size=(channels, count)), storage, rows=channels)
    tiles = texel_tiles(texels, side, rng.random(count) < 0.7)
    before = np.full((first + rows + 1, count, 2), UNWRITTEN)
    filtered, delay = upsampling_taps(lo, levels)
    reach, factor = filtered.shape
    exact = upsample_texels(ll.astype(float), lo, levels, texels=texels, static_offset=offset.values)
    padded = np.concatenate([exact, np.zeros((4 * rows - channels, count))])
    found = padded.reshape(rows, 4, count).swapaxes(1, 2)
    bound = upsampling_bound(filtered, float(np.abs(ll).max()), float(np.abs(offset.values).max()))
    return Case(
        f"{storage}, {levels} levels",
        "UpsampleTexels",
        (len(tiles), 1, rows),
        {
            **{"static_offset_layout": offset.layout, "channels": channels, "size": size},
            **{"factor": factor, "reach": reach, "delay": delay},
            **{"texel_count": count, "first_row": first},
        },
        {
            **{"ll": packed, "upsampling": filtered.astype(np.float32), "tiles": tiles},
            **{"static_offset": offset.words, "texel_channels": before},
        },
        (
            Expected("texel_channels", "uint", before[:first]),
            halves("texel_channels", found, bound, first=2 * first * count),
            Expected(
                "texel_channels",
                "uint",
                np.full(2 * count, UNWRITTEN),
                first=2 * (first + rows) * count,
            ),
        ),
    )


def _vertices() -> Case:
    rng = np.random.default_rng(5)
    joints = (random_joints(rng) * rng.choice([-1.0, 1.0], (JOINTS, 1))).astype(np.float32)
    indices, weights = random_influences(rng, 131)
    return Case(
        "five joints",
        "BlendVertices",
        groups((131, 64)),
        {"vertex_count": 131},
        {
            **{"joints": joints, "indices": indices.astype(np.uint32), "weights": weights},
            "vertex_dq": np.full((131, 8), UNTOUCHED),
        },
        (Expected("vertex_dq", "float", blend_vertices(joints.astype(float), indices, weights), BLEND_BOUND),),
    )


def _targets() -> Case:
    """Every other vertex is moved."""
    rng, count, expressions = np.random.default_rng(6), 67, 5
    targets = random_targets(rng, 2 * np.arange(count), expressions)
    weights = rng.random(expressions).astype(np.float32)
    mesh = rng.uniform(-1, 1, (2 * count, 3)).astype(np.float32)
    moved = np.zeros((count, 4))
    entries = weights[targets.expressions, None].astype(float) * targets.changes
    np.add.at(moved, np.repeat(np.arange(count), np.diff(targets.starts)), entries)
    bound = 2 * expressions * ULP * float(np.abs(entries).max()) * expressions
    untouched = np.full((2 * count, 4), UNTOUCHED)
    return Case(
        "five expressions",
        "SumTargets",
        groups((count, 64)),
        {"vertex_count": count},
        {
            **{"vertices": targets.vertices.astype(np.uint32), "starts": targets.starts.astype(np.uint32)},
            **dict(zip(("expressions", "changes"), pack_entries(targets), strict=True)),
            **{"weights": weights, "moved": untouched, "mesh": mesh},
        },
        (
            Expected("moved", "float", moved, bound, length=4, period=8),
            Expected("moved", "float", untouched[1::2], first=4, length=4, period=8),
            Expected("mesh", "float", mesh[::2] + moved[:, :3], bound + 2 * ULP, length=3, period=6),
            Expected("mesh", "float", mesh[1::2], first=3, length=3, period=6),
        ),
    )


def _triangles() -> Case:
    """The first triangles bend, the others have no area or do not move; one is out of reach."""
    bent = triangles(np.random.default_rng(7), 70)
    count = len(bent.faces)
    held = bend_triangles(bent.mesh.astype(float), bent.moved.astype(float), bent.faces)[1:]
    bends = partial(halves, "triangle_bends", period=6)
    return Case(
        "edges of 0.2 to 2 metres",
        "BendTriangles",
        groups((count - 1, 64)),
        {"triangle_count": count - 1},
        {
            "corners": bent.faces[1:].astype(np.uint32),
            **{"moved": np.pad(bent.moved, ((0, 0), (0, 1))), "mesh": bent.mesh + bent.moved},
            "triangle_bends": np.full((count, 3, 2), UNWRITTEN),
        },
        (
            bends(held[:, :10], BENT_BOUND, length=5),
            bends(held[:, 10:] * [PER_METRE, 1], PER_METRE * ROOT_BOUND, first=5),
            Expected("triangle_bends", "uint", np.full(6, UNWRITTEN), first=6 * (count - 1)),
        ),
    )


def _bent_vertices() -> Case:
    """About each vertex up to 12 triangles, some of no area and some that do not move; every other one is in reach."""
    rng, count = np.random.default_rng(10), 70
    rows, starts, stars = random_stars(rng, count)
    moved = rng.normal(size=(2 * count, 4)).astype(np.float32)
    means = bend_vertices(rows.astype(float), starts.astype(int), stars.astype(int))
    return Case(
        "up to 12 triangles about each",
        "BendVertices",
        groups((count, 64)),
        {"vertex_count": count},
        {
            **{"vertices": 2 * np.arange(count, dtype=np.uint32), "starts": starts, "stars": stars, "moved": moved},
            **{"triangle_bends": triangle_words(rows), "vertex_bends": np.full((2 * count, 3, 2), UNWRITTEN)},
        },
        (
            halves("vertex_bends", vertex_numbers(means, moved[::2, 3]), MEAN_BOUND, length=6, period=12),
            Expected("vertex_bends", "uint", np.full(6 * count, UNWRITTEN), first=6, length=6, period=12),
        ),
    )


def _bent_texels() -> Case:
    """Some bend and some do not, all within reach; the first row of appearance says how light turns."""
    count = 101
    bent = bent_texels(np.random.default_rng(8), count, reach=1)
    return Case(
        "turns of up to 60 degrees",
        "BendTexels",
        bent.groups,
        bent.constants,
        {**bent.buffers, "texel_channels": np.full((5, count, 2), UNWRITTEN)},
        (
            halves("texel_channels", bent.expected.reshape(-1, 3, 4).swapaxes(0, 1), bent.bound),
            halves("texel_channels", bent.mirrors, MIRROR * bent.bound, first=6 * count),
            Expected("texel_channels", "uint", np.full(2 * count, UNWRITTEN), first=8 * count),
        ),
    )


def _lit_texels() -> Case:
    """Some within reach and some not; geometry is not written."""
    count = 101
    lit = lit_texels(np.random.default_rng(9), count)
    expected = lit.expected.reshape(-1, 3, 4).swapaxes(0, 1)
    return Case(
        "light that turns and brightens",
        "LightTexels",
        lit.groups,
        lit.constants,
        lit.buffers,
        (
            Expected("texel_channels", "uint", lit.buffers["texel_channels"][:3]),
            halves("texel_channels", expected[0, :, :2], lit.bounds[0], first=6 * count, period=2),
            halves("texel_channels", expected[0, :, 2:], lit.bounds[3], first=6 * count + 1, period=2),
            halves("texel_channels", expected[1:], lit.bounds[3], first=8 * count),
        ),
    )
