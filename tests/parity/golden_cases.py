"""The cases of tests/parity/golden: inputs of every entry point, and what the reference makes of them in float64.

Inputs and bounds are those of the kernels' own tests.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from packed_splats import LEAST_NORMAL_HALF, MANTISSA_BITS, unpacked
from projected import Scene
from splat_rounding import ULP, exact_keys, eye_bounds
from stored import STORAGES, groups, store
from test_dq_skinning import (
    BLEND_BOUND,
    CENTRE_BOUND,
    COVARIANCE_BOUND,
    FACES,
    JOINTS,
    OPACITY_BOUND,
    random_influences,
    random_joints,
    random_texels,
)
from test_inverse_dwt import taps
from test_mlp_matmul import layer, shader_bound
from test_splat_project import BOX, packed_splats, stereo

from mua.arrays import Array
from mua.camera import NEAR, Camera
from mua.kernels.blend_subbands import blend_detail, blend_ll
from mua.kernels.dq_skinning import METRES2_TO_MM2, blend_texels, blend_vertices, covariances, skin_splats
from mua.kernels.inverse_dwt import add_static, inverse_dwt
from mua.kernels.mlp_matmul import mlp_matmul
from mua.kernels.splat_draw import splat_colors
from mua.kernels.splat_project import eye_ellipses, splat_project
from mua.kernels.splat_sort import DIGIT_BITS, splat_sort

Kind = Literal["uint", "float", "half"]
UNTOUCHED = np.float32(-7)
EPS = float(np.finfo(np.float32).eps)


@dataclass(frozen=True)
class Expected:
    """What stands in `length` of every `period` words of a buffer, from word `first` on.

    A value may differ by absolute + relative |value|; of a half there are two values to a word, the low one first.
    """

    buffer: str
    kind: Kind
    values: Array
    absolute: float = 0.0
    relative: float = 0.0
    first: int = 0
    length: int = 1
    period: int = 1


@dataclass(frozen=True)
class Case:
    name: str
    entry: str
    groups: tuple[int, int, int]
    constants: Mapping[str, int | float | Array]
    buffers: Mapping[str, Array]  # as they are before the dispatch
    expected: tuple[Expected, ...]


def cases() -> dict[str, list[Case]]:
    """All cases by the stem of their kernel."""
    return {
        "mlp_matmul": [_layer(s, relu=relu) for s in STORAGES for relu in (0, 1)] + [_mesh(s) for s in STORAGES],
        "blend_subbands": [make(s) for make in (_blend_ll, _blend_detail) for s in STORAGES],
        "inverse_dwt": [
            *(_level(name, full=full) for name in ("bior4.4", "bior2.2") for full in (True, False)),
            *(_static(s) for s in STORAGES),
        ],
        "dq_skinning": [_vertices(), _texels()],
        "splat_project": [*(_project(eyes) for eyes in (1, 2)), _scan(), _compact()],
        "splat_sort": _sort(),
    }


def _layer(storage: Literal["f32", "f16", "i8"], *, relu: int) -> Case:
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


def _mesh(storage: Literal["f32", "f16", "i8"]) -> Case:
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


def _blend_ll(storage: Literal["f32", "f16", "i8"]) -> Case:
    channels, rank, size, offset = 3, 5, 9, 7
    rng = np.random.default_rng(1)
    mean = store(rng.normal(size=(channels, size, size)), storage, rows=channels)
    basis = store(rng.normal(size=(channels, rank, size, size)), storage, rows=channels * rank)
    alpha = rng.normal(size=(channels, rank)).astype(np.float32)
    blended = blend_ll(mean.values, basis.values, alpha.astype(float))
    magnitude = blend_ll(np.abs(mean.values), np.abs(basis.values), np.abs(alpha).astype(float)).max()
    return Case(
        storage,
        "BlendLl",
        groups((size * size, 64), (channels, 1)),
        {
            **{"mean_layout": mean.layout, "basis_layout": basis.layout},
            **{"channels": channels, "rank": rank, "size": size, "alpha_offset": offset},
        },
        {
            **{"mean": mean.words, "basis": basis.words, "alpha": np.append(np.full(offset, UNTOUCHED), alpha)},
            "blended": np.full(blended.size, UNTOUCHED),
        },
        (Expected("blended", "float", blended, (rank + 2) * EPS * magnitude),),
    )


def _blend_detail(storage: Literal["f32", "f16", "i8"]) -> Case:
    channels, rank, size, offset = 2, 5, 27, 3
    rng = np.random.default_rng(2)
    mean = store(rng.normal(size=(3, channels, size, size)), storage, rows=3 * channels)
    h, w = (store(f, storage, rows=3 * channels * rank) for f in rng.normal(size=(2, 3, channels, rank, size)))
    alpha = rng.normal(size=(channels, rank)).astype(np.float32)
    blended = blend_detail(mean.values, h.values, w.values, alpha.astype(float))
    magnitude = blend_detail(*(np.abs(t.values) for t in (mean, h, w)), np.abs(alpha).astype(float)).max()
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
            **{"alpha": np.append(np.full(offset, UNTOUCHED), alpha), "blended": np.full(blended.size, UNTOUCHED)},
        },
        (Expected("blended", "float", blended, (rank + 3) * EPS * magnitude),),
    )


def _level(wavelet: str, *, full: bool) -> Case:
    channels, size = 2, 19
    lo, hi = (t.astype(np.float32) for t in taps(wavelet))
    bands = np.random.default_rng(3).normal(size=(4, channels, size, size)).astype(np.float32)
    ll, details = bands[0], bands[1:]
    doubles = details.astype(float) if full else None
    fine = inverse_dwt(ll.astype(float), doubles, lo.astype(float), hi.astype(float))
    gain = (np.abs(lo).sum(dtype=float) + np.abs(hi).sum(dtype=float)) ** 2
    sums_bound = 2 * (len(lo) + 1) * EPS * gain * float(np.abs(bands).max())
    return Case(
        wavelet,
        "InverseDwt" if full else "InverseDwtLowPass",
        groups((size, 16), (size, 16), (channels, 1)),
        {"size": size, "taps": len(lo)} | ({"channels": channels} if full else {}),
        {"ll": ll, "rec_lo": lo, "fine": np.full(fine.size, UNTOUCHED)}
        | ({"details": details, "rec_hi": hi} if full else {}),
        (Expected("fine", "float", fine, sums_bound),),
    )


def _static(storage: Literal["f32", "f16", "i8"]) -> Case:
    channels, size, count, first = 3, 13, 101, 2
    rng = np.random.default_rng(4)
    fine = rng.normal(size=(channels, size, size)).astype(np.float32)
    texels = np.sort(rng.permutation(size * size)[:count]).astype(np.uint32)
    offset = store(rng.normal(size=(channels, count)), storage, rows=channels)
    found = np.full((first + channels + 1, count), float(UNTOUCHED))
    found[first : first + channels] = add_static(fine.astype(float), texels, offset.values)
    return Case(
        storage,
        "AddStatic",
        groups((count, 256)),
        {
            **{"static_offset_layout": offset.layout, "channels": channels, "size": size},
            **{"texel_count": count, "first_channel": first},
        },
        {
            **{"fine": fine, "texels": texels, "static_offset": offset.words},
            "texel_channels": np.full(found.size, UNTOUCHED),
        },
        (Expected("texel_channels", "float", found, relative=2 * EPS),),
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


def _halves(buffer: str, values: Array, bound: float, *, first: int = 0, length: int = 1, period: int = 1) -> Expected:
    """Half floats within a bound of the float32 that they are made from: rounded either way, subnormals flushed."""
    step = 2.0**-MANTISSA_BITS
    return Expected(buffer, "half", values, bound * (1 + step) + LEAST_NORMAL_HALF, step, first, length, period)


def _texels() -> Case:
    count, others, rng = 67, 3, np.random.default_rng(6)
    vertex_dq = (random_joints(rng, 6) * rng.choice([-1.0, 1.0], (6, 1))).astype(np.float32)
    mesh = rng.uniform(-0.5, 0.5, (6, 3)).astype(np.float32)
    texels = random_texels(rng, count)
    texels.texture[:, 7:10] = rng.uniform(-7, -5, (count, 3))  # 1 to 7 mm, so that one bound fits all covariances
    texture = texels.texture.astype(float)
    on_faces = FACES, texels.triangles, texels.barycentrics
    texel_dq = blend_texels(vertex_dq.astype(float), *on_faces)
    centres, rotations, scales, opacities = skin_splats(texel_dq, mesh, *on_faces, texture)
    covariance = METRES2_TO_MM2 * covariances(rotations, scales)
    covariance_bound = COVARIANCE_BOUND * METRES2_TO_MM2 * float(scales.max()) ** 2
    return Case(
        "three triangles",
        "SkinSplats",
        groups((count, 64)),
        {"texel_count": count, "first_splat": others},
        {
            **{"vertex_dq": vertex_dq, "mesh": mesh, "faces": FACES.astype(np.uint32)},
            **{"triangles": texels.triangles.astype(np.uint32), "barycentrics": texels.barycentrics[:, :2]},
            **{"texel_channels": texels.texture.T, "splats": np.full((others + count, 16), 0xFFFFFFFF, np.uint32)},
        },
        (
            Expected("splats", "uint", np.full(16 * others, 0xFFFFFFFF), length=16, period=16),
            Expected("splats", "float", centres, CENTRE_BOUND, first=16 * others, length=3, period=16),
            _halves("splats", covariance, covariance_bound, first=16 * others + 3, length=3, period=16),
            _halves("splats", texel_dq[:, :4], BLEND_BOUND, first=16 * others + 6, length=2, period=16),
            _halves("splats", texture[:, 11:], 0, first=16 * others + 8, length=6, period=16),
            Expected("splats", "float", opacities, OPACITY_BOUND, first=16 * others + 14, period=16),
            Expected("splats", "uint", np.zeros(count), first=16 * others + 15, period=16),
        ),
    )


def _scene(eyes: int) -> Scene:
    """Splats whose visibility, key and axes float32 cannot turn, before cameras that float32 holds exactly."""
    exact = [(c.view.astype(np.float32).astype(float), c.projection.astype(np.float32).astype(float)) for c in stereo()]
    cameras = tuple(Camera(view, projection, stereo()[0].screen) for view, projection in exact[:eyes])
    scene = Scene(packed_splats(1999, reach=1.6), cameras, (1.6 * BOX).astype(np.float32).astype(float))
    centres, covariance, opacities = scene.splats()
    keys, key_bound = exact_keys(centres, np.stack([c.view for c in cameras]), scene.bounds)
    clear = np.abs(keys - np.floor(keys) - 0.5) > 2 * key_bound
    for camera in cameras:
        bound = eye_bounds(centres, covariance, opacities, camera)
        ellipses = eye_ellipses(centres, covariance, camera.view, camera.projection, camera.screen, NEAR)
        clear &= (np.abs(bound.margin) > 2) & (bound.middle.max(axis=1) < 1e-3)
        clear &= (_axis_bound(ellipses, bound.variance) < 1e-3) & (ellipses[:, 2] > 0.01)
    return Scene(scene.words[clear][:283], cameras, scene.bounds)


def _axis_bound(ellipses: Array, variance_bound: Array) -> Array:
    """Bound [N] of the major axis: the covariance's error over the difference of its axes."""
    spread = (ellipses[:, 4] ** 2 - ellipses[:, 5] ** 2) / 2
    return np.asarray(variance_bound / np.maximum(spread, 1e-30) + 8 * ULP)


def _project(eyes: int) -> Case:
    scene = _scene(eyes)
    count = len(scene.words)
    fields = unpacked(scene.words)
    centres, covariance, opacities = scene.splats()
    constants = {
        name: np.float32(value) if name not in ("eyes", "splat_count", "instances") else value
        for name, value in scene.constants.items()
        if name != "instances"
    }
    views, projections = (constants[name][:eyes].astype(float) for name in ("view", "projection"))
    splats, keys, seen = splat_project(
        *(centres, covariance, opacities, views, projections),
        screen=scene.cameras[0].screen,
        near=float(constants["near"]),
        bounds=scene.bounds,
    )
    ellipses = np.full((eyes, count, 6), float(UNTOUCHED))
    ellipses[:, splats] = seen
    flags = np.zeros(count, np.uint32)
    flags[splats] = keys.astype(np.uint32) | 0x10000
    colors = np.zeros((count, 4))
    turn, sh = fields["turn"].astype(float), fields["sh"].astype(float)
    colors[splats, :3] = splat_colors(centres, turn, sh, constants["camera"][:3].astype(float))[splats]
    colors[splats, 3] = opacities[splats]
    counts = np.add.reduceat(flags > 0, np.arange(0, count, 256)).astype(np.uint32)

    bounds = [eye_bounds(centres, covariance, opacities, camera) for camera in scene.cameras]
    variance = np.max([bound.variance[splats] for bound in bounds], axis=0)
    middle = max(float(bound.middle[splats].max()) for bound in bounds)
    drawn = seen[..., 4] > 0
    axis = max(float(_axis_bound(e[d], variance[d]).max()) for e, d in zip(seen, drawn, strict=True))
    deviation = max(float((variance[d] / e[d, 5]).max()) for e, d in zip(seen, drawn, strict=True))
    direction = ULP * (3 / np.linalg.norm(centres - constants["camera"][:3], axis=1).min() + 28)
    return Case(
        f"{eyes} of two eyes",
        "SplatProject",
        groups((count, 256)),
        constants,
        {
            **{"splats": scene.words, "ellipses": np.full(ellipses.size, UNTOUCHED)},
            **{"colors": np.zeros(2 * count, np.uint32), "flags": np.full(count, 0xFFFFFFFF, np.uint32)},
            "group_counts": np.full(len(counts), 0xFFFFFFFF, np.uint32),
        },
        (
            Expected("ellipses", "float", ellipses[..., 0:2], middle, first=0, length=2, period=6),
            Expected("ellipses", "float", ellipses[..., 2:4], axis, first=2, length=2, period=6),
            Expected("ellipses", "float", ellipses[..., 4:6], deviation, 5 * ULP, first=4, length=2, period=6),
            _halves("colors", colors, float(np.abs(sh).sum(axis=1).max()) * direction),
            Expected("flags", "uint", flags),
            Expected("group_counts", "uint", counts),
        ),
    )


def _scan() -> Case:
    splats = 300_007  # more groups than threads
    counts = np.random.default_rng(7).integers(0, 257, -(-splats // 256), dtype=np.uint32)
    total = int(counts.sum())
    arguments = np.array([6 * total, 2, 0, 0, -(-total // 2048), 1, 1, total], np.uint32)
    return Case(
        "300,007 splats",
        "ScanCounts",
        (1, 1, 1),
        {"splat_count": splats, "instances": 2},
        {"group_counts": counts, "arguments": np.full(8, 0xFFFFFFFF, np.uint32)},
        (
            Expected("group_counts", "uint", (np.cumsum(counts) - counts).astype(np.uint32)),
            Expected("arguments", "uint", arguments),
        ),
    )


def _compact() -> Case:
    count, rng = 517, np.random.default_rng(8)
    flags = ((rng.random(count) < 0.4) * (0x10000 + rng.integers(0, 0x10000, count))).astype(np.uint32)
    counts = np.add.reduceat(flags > 0, np.arange(0, count, 256))
    visible = np.flatnonzero(flags).astype(np.uint32)
    rest = np.full(count - len(visible), 0xFFFFFFFF, np.uint32)
    return Case(
        "three groups",
        "SplatCompact",
        groups((count, 256)),
        {"splat_count": count},
        {
            **{"flags": flags, "group_counts": (np.cumsum(counts) - counts).astype(np.uint32)},
            **{name: np.full(count, 0xFFFFFFFF, np.uint32) for name in ("visible", "keys")},
        },
        (
            Expected("visible", "uint", np.append(visible, rest)),
            Expected("keys", "uint", np.append(flags[visible] & 0xFFFF, rest)),
        ),
    )


def _sort() -> list[Case]:
    """Both passes over two groups of keys, many of them equal."""
    count, rng = 2048 + 517, np.random.default_rng(9)
    keys = (rng.integers(0, 40, count) * 0x333).astype(np.uint32)
    values = np.sort(rng.permutation(4 * count)[:count]).astype(np.uint32)
    after = splat_sort(keys.astype(np.uint16))
    low = np.argsort(keys & 0xFF, kind="stable")
    passes = ((0, keys, values, low), (DIGIT_BITS, keys[low], values[low], None))
    found = []
    for shift, pass_keys, pass_values, order in passes:
        sorted_keys = keys[after] if order is None else pass_keys[order]
        sorted_values = values[after] if order is None else pass_values[order]
        found += _sort_pass(shift, pass_keys, pass_values, sorted_keys, sorted_values)
    return found


def _sort_pass(shift: int, keys: Array, values: Array, sorted_keys: Array, sorted_values: Array) -> list[Case]:
    blocks = -(-len(keys) // 2048)
    arguments = np.array([6 * len(keys), 1, 0, 0, blocks, 1, 1, len(keys)], np.uint32)
    digits = (keys >> shift) & 0xFF
    counts = np.stack([np.bincount(d, minlength=256) for d in np.split(digits, range(2048, len(keys), 2048))], axis=1)
    before = np.cumsum(counts, axis=1) - counts
    counts, before, totals = (a.astype(np.uint32) for a in (counts, before, counts.sum(axis=1)))
    blank, name = np.full(len(keys), 0xFFFFFFFF, np.uint32), f"shift {shift}"
    return [
        Case(
            *(name, "CountDigits", (blocks, 1, 1), {"shift": shift}),
            {"keys": keys, "arguments": arguments, "digit_counts": np.full(counts.size, 0xFFFFFFFF, np.uint32)},
            (Expected("digit_counts", "uint", counts),),
        ),
        Case(
            *(name, "ScanDigits", (256, 1, 1), {}),
            {"arguments": arguments, "digit_counts": counts, "digit_totals": np.full(256, 0xFFFFFFFF, np.uint32)},
            (Expected("digit_counts", "uint", before), Expected("digit_totals", "uint", totals)),
        ),
        Case(
            *(name, "ScatterDigits", (blocks, 1, 1), {"shift": shift}),
            {
                **{"keys": keys, "values": values, "arguments": arguments, "digit_counts": before},
                **{"digit_totals": totals, "sorted_keys": blank, "sorted_values": blank},
            },
            (Expected("sorted_keys", "uint", sorted_keys), Expected("sorted_values", "uint", sorted_values)),
        ),
    ]
