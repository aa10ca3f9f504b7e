"""Splats to screen: culling, the ellipse of each splat in each eye, the depth key; splats and keys as a GPU holds them.

The screen covariance is that of the projection linearised at the centre (EWA, Zwicker et al. 2001,
https://doi.org/10.1145/383259.383300). No blur is added to it: splat_draw integrates over the pixel instead.
Eye space is right-handed, Y up, looking along -Z; rows of pixels run down, pixel centres lie at +0.5.
"""

import numpy as np

from mua.arrays import Array

LEAST_OPACITY = 1 / 255  # below it a splat changes no 8-bit image
LEAST_VARIANCE = 1e-4  # px^2; float32 rounding of the covariance of a 30 px splat, so that a thin axis stays positive
REACH = 2.015  # standard deviations from a splat's middle to its quad's edges
PIXEL_VARIANCE = 5 / 12 / REACH**2  # px^2; of the window that splat_draw draws, it is a unit square's 1 / 12
AWAY = 0.25  # sine of the angle by which a triangle is turned past edge-on where it is seen from behind
GUARD = 1.3  # the linearisation is clamped at this multiple of the screen's half size; beyond it, it diverges
LAST_KEY = 0xFFFE
HIDDEN = 0xFFFF  # the key of a splat that no eye sees
SPLAT_WORDS = 8
LARGEST_BARYCENTRIC = 0xFFFF  # stands for 1
ONE_SIDED = 1 << 31  # flag beside the triangle of a texel that is not drawn from behind
COLOR_STEPS, TINT_STEPS, OPACITY_STEPS = 1023, 63, 2047  # 10 bits, 7 bits for either sign, 11 bits
COLOR_SCALES = np.array([1.0, 2.0, 4.0, 8.0])  # what COLOR_STEPS may stand for


def splat_project(
    centres: Array,  # [N, 3] world, metres
    covariance: Array,  # [N, 6] xx, xy, xz, yy, yz, zz, square metres
    opacities: Array,  # [N]
    view: Array,  # [E, 4, 4] world to eye
    projection: Array,  # [E, 4, 4] eye to clip
    *,
    screen: tuple[int, int],  # width, height of one eye, pixels
    near: float,  # metres
    bounds: Array,  # [2, 3] world box over which depth is keyed
    normals: Array | None = None,  # [N, 3] world, normals of one-sided texels' triangles, not normalised; 0 for others
) -> tuple[Array, Array, Array]:
    """Keep the splats that at least one eye may see.

    Returns splats [M] int32 ascending, keys [M] uint16 (ascending = back to front, by the eyes' mean depth) and
    ellipses [E, M, 6]: centre column and row, cosine and sine of the major axis, standard deviations along it and
    across it, in pixels; both deviations are 0 where this eye does not see the splat.
    """
    dtype = centres.dtype
    view, projection, bounds = view.astype(dtype), projection.astype(dtype), bounds.astype(dtype)
    eyes = [eye_ellipses(centres, covariance, v, p, screen, near) for v, p in zip(view, projection, strict=True)]
    ellipses = np.stack(eyes)
    extent = half_extents(ellipses)
    middle = ellipses[..., 0:2]
    on_screen = np.all((middle + extent > 0) & (middle - extent < np.array(screen, dtype)), axis=-1)
    seen = on_screen & (ellipses[..., 4] > 0) & (opacities >= LEAST_OPACITY)
    if normals is not None:
        seen &= np.stack([facing(centres, normals, v) <= AWAY for v in view])
    splats = np.flatnonzero(seen.any(axis=0)).astype(np.int32)
    ellipses = ellipses[:, splats]
    ellipses[~seen[:, splats], 4:6] = 0
    return splats, _keys(centres[splats], view, near, bounds), ellipses


def wide_deviations(
    deviations: Array,  # [...] pixels
) -> Array:
    """Standard deviations [...] of the window that is drawn for a Gaussian."""
    return np.sqrt(deviations * deviations + deviations.dtype.type(PIXEL_VARIANCE))


def half_extents(
    ellipses: Array,  # [..., M, 6]
) -> Array:
    """Half width and height [..., M, 2] of the upright box around the quad, pixels."""
    wide = wide_deviations(ellipses[..., 4:6])
    size, longer = np.abs(ellipses[..., 2:4]), wide[..., :1] - wide[..., 1:]
    return np.asarray(REACH * (wide[..., 1:] + longer * size.sum(axis=-1, keepdims=True) * size))


def eye_ellipses(
    centres: Array,  # [N, 3]
    covariance: Array,  # [N, 6]
    view: Array,  # [4, 4]
    projection: Array,  # [4, 4]
    screen: tuple[int, int],
    near: float,
) -> Array:
    """Ellipses [N, 6] in one eye; deviations 0 before the near plane."""
    turn = view[:3, :3]
    eye = centres @ turn.T + view[:3, 3]
    depth = np.maximum(-eye[:, 2], near)
    half = np.array(screen, dtype=centres.dtype) / 2 * np.array([1, -1], dtype=centres.dtype)  # rows run down
    focal, skew = np.diagonal(projection)[:2], projection[:2, 2]
    ndc = eye[:, :2] / depth[:, None] * focal - skew
    slope = (np.clip(ndc, -GUARD, GUARD) + skew) / focal
    # Rows of the Jacobian of (column, row), times the view's rotation: half f / depth (e_i + slope_i e_z).
    jacobian = (half * focal / depth[:, None])[:, :, None] * (turn[:2] + slope[:, :, None] * turn[2])
    xx, xy, xz, yy, yz, zz = covariance.T
    sigma = np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=1).reshape(-1, 3, 3)
    screen_covariance = jacobian @ sigma @ jacobian.swapaxes(1, 2)
    a, b, c = screen_covariance[:, 0, 0], screen_covariance[:, 0, 1], screen_covariance[:, 1, 1]
    mean, spread = (a + c) / 2, np.hypot((a - c) / 2, b)
    angle = np.arctan2(b, (a - c) / 2) / 2
    deviations = np.sqrt(np.maximum([mean + spread, mean - spread], LEAST_VARIANCE)) * (-eye[:, 2] > near)
    column, row = ((ndc * np.sign(half) + 1) * np.abs(half)).T
    return np.stack([column, row, np.cos(angle), np.sin(angle), *deviations], axis=1).astype(centres.dtype)


def facing(
    centres: Array,  # [N, 3]
    normals: Array,  # [N, 3] of any length
    view: Array,  # [4, 4]
) -> Array:
    """How far normals are turned away from an eye, [N]: -1 towards it, 1 away; 0 where there is no normal."""
    eye = centres @ view[:3, :3].T + view[:3, 3]
    lengths = np.linalg.norm(normals, axis=1) * np.linalg.norm(eye, axis=1)
    away = np.einsum("ni,ni->n", normals @ view[:3, :3].T, eye)
    return np.asarray(away / np.maximum(lengths, np.finfo(centres.dtype).tiny))


def pack_texels(
    triangles: Array,  # [N]
    barycentrics: Array,  # [N, 2] or more: the first two
    one_sided: Array | None = None,  # [N] bool; None: no texel is
) -> Array:
    """The texels' places on the mesh as a GPU holds them, [N, 2] uint32: triangle, two barycentrics of 16 bits each.

    The highest bit of the triangle says whether the texel is one-sided.

    Half a step of a barycentric is less than a thousandth of a millimetre of an edge of 10 cm.
    """
    steps = np.rint(barycentrics[:, :2].astype(float) * LARGEST_BARYCENTRIC).astype(np.uint32)
    marks = np.where(False if one_sided is None else one_sided, np.uint32(ONE_SIDED), np.uint32(0))
    return np.stack([triangles.astype(np.uint32) | marks, steps[:, 0] | steps[:, 1] << 16], axis=1)


def pack_splats(
    centres: Array,  # [N, 3] metres
    colors: Array,  # [E, N, 3] sRGB towards one eye or two
    opacities: Array,  # [N]
    ellipses: Array,  # [E, N, 6] for one eye or two; deviations 0 where an eye does not see the splat
) -> Array:
    """Splats in the layout of the draw, 32 bytes each, [N, 8] uint32.

    Words 0-2: centre, f32; 3 and 4: pack_colors. The others are pairs of half floats, low half first: 5 and 6 the
    major axis of either eye, as long as its standard deviation, 7 the standard deviations across it in either eye.
    """
    largest = float(np.finfo(np.float16).max)
    first, last = ellipses[0], ellipses[-1]
    axes = [np.minimum(ellipse[:, 4:5], largest) * ellipse[:, 2:4] for ellipse in (first, last)]
    minors = np.stack([first[:, 5], last[:, 5]], axis=1)
    halves = np.clip(np.concatenate([*axes, minors], axis=1), -largest, largest)
    packed = np.zeros((len(centres), SPLAT_WORDS), dtype=np.uint32)
    packed[:, 0:3] = centres.astype("<f4").view("<u4")
    packed[:, 3:5] = pack_colors(colors, opacities)
    packed[:, 5:8] = np.ascontiguousarray(halves.astype("<f2")).view("<u4")
    return packed


def pack_colors(
    colors: Array,  # [E, N, 3] sRGB towards one eye or two, not below 0
    opacities: Array,  # [N] 0 to 1
) -> Array:
    """Colours and opacity of a splat, [N, 2] uint32.

    Word 0: red, green and blue of the eyes' mean, 10 bits each from the lowest on, then the number of the scale, the
    least of COLOR_SCALES that holds mean and tint. Word 1: opacity, 11 bits, then half the difference of the first
    eye's colour from the second's, 7 bits each, of which 64 is none, in steps as large as the mean's. Where colours are
    at most 1, either is off by 1/2046 at most; beyond 8 they are held there.
    """
    first, second = colors[0], colors[-1]
    mean, tint = (first + second) / 2, (first - second) / 2
    needed = np.maximum(mean, np.abs(tint) * (COLOR_STEPS / TINT_STEPS)).max(axis=1)
    number = np.searchsorted(COLOR_SCALES[:-1], needed)
    steps = (COLOR_STEPS / COLOR_SCALES[number])[:, None]
    color = np.floor(np.minimum(mean * steps, COLOR_STEPS) + 0.5).astype(np.uint32)
    turned = np.floor(np.clip(tint * steps, -TINT_STEPS, TINT_STEPS) + TINT_STEPS + 1.5).astype(np.uint32)
    word = color[:, 0] | color[:, 1] << 10 | color[:, 2] << 20 | number.astype(np.uint32) << 30
    opacity = np.floor(opacities * OPACITY_STEPS + 0.5).astype(np.uint32)
    return np.stack([word, opacity | turned[:, 0] << 11 | turned[:, 1] << 18 | turned[:, 2] << 25], axis=1)


def pack_keys(
    keys: Array,  # [N] HIDDEN where no eye sees the splat
) -> Array:
    """Two keys to a word, [ceil(N / 2)] uint32, the first in the low half; a missing second one is HIDDEN."""
    padded = np.append(keys, [HIDDEN] * (len(keys) % 2)).astype("<u2")
    return np.ascontiguousarray(padded).view("<u4")


def _keys(
    centres: Array,  # [M, 3]
    view: Array,  # [E, 4, 4]
    near: float,
    bounds: Array,  # [2, 3]
) -> Array:
    """Keys [M] uint16: 0 half the bounds' diagonal beyond their farthest depth, LAST_KEY as far before the nearest.

    Motion that the bounds were not made for may reach so far out; nearer than the near plane nothing is drawn.
    """
    spare = np.linalg.norm(bounds[1] - bounds[0]) / 2
    forward, offset = -view[:, 2, :3].mean(axis=0), -view[:, 2, 3].mean()
    low, high = np.sort(bounds * forward, axis=0)
    nearest = max(low.sum() + offset - spare, near)
    farthest = high.sum() + offset + spare
    span = max(farthest - nearest, np.finfo(centres.dtype).tiny)
    fraction = np.clip((farthest - (centres @ forward + offset)) / span, 0, 1)
    return np.floor(fraction * LAST_KEY + 0.5).astype(np.uint16)
