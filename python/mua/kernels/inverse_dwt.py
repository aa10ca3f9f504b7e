"""The periodised 2D wavelet synthesis: level by level, and the static offset at its end.

In one dimension x[m] = sum_k lo[m - 2k + L/2 - 1] a[k] + hi[m - 2k + L/2 - 1] d[k], indices of x modulo 2n: the phase
of PyWavelets' mode "periodization", where a[k] is centred on sample 2k and d[k] on 2k + 1.
"""

import numpy as np

from mua.arrays import Array
from mua.channels import APPEARANCE
from mua.limits import LARGEST

TILE = 16  # texels along a side of a group of UpsampleTexels
BATCH = 4  # channels that lie together in a row of texel_channels
ROWS = 6  # rows of texel_channels, 3 for either branch


def inverse_dwt(
    ll: Array,  # [C, n, n]
    details: Array | None,  # [3, C, n, n] high-pass along rows' axis, along columns' axis, along both; None: zeros
    rec_lo: Array,  # [L], L even
    rec_hi: Array,  # [L]
) -> Array:
    """The next finer approximation [C, 2n, 2n]."""
    if details is None:
        return _upsample(_upsample(ll, rec_lo, 2), rec_lo, 1)
    along_rows, along_columns, along_both = details
    low = _upsample(ll, rec_lo, 2) + _upsample(along_columns, rec_hi, 2)
    high = _upsample(along_rows, rec_lo, 2) + _upsample(along_both, rec_hi, 2)
    return _upsample(low, rec_lo, 1) + _upsample(high, rec_hi, 1)


def add_static(
    fine: Array,  # [C, H, W]
    texels: Array,  # [N] row * W + column
    static_offset: Array,  # [C, N]
) -> Array:
    """The texture at the valid texels, [C, N], with the static offset of the finest levels."""
    channels, rows, columns = fine.shape
    return np.asarray(fine.reshape(channels, rows * columns)[:, texels] + static_offset)


def halve(
    texture: Array,  # [C, 2n, 2n]
) -> Array:
    """The means of 2 x 2 texels [C, n, n]."""
    channels, size, _ = texture.shape
    return np.asarray(texture.reshape(channels, size // 2, 2, size // 2, 2).mean(axis=(2, 4), dtype=texture.dtype))


def upsample_texels(
    ll: Array,  # [C, n, n]
    rec_lo: Array,  # [L], L even
    levels: int,  # without details
    *,
    texels: Array,  # [N] row * 2^levels n + column
    static_offset: Array,  # [C, N]
    coarser: int = 0,  # how often 2 x 2 texels were merged; N counts the valid ones then
) -> Array:
    """All levels without details and the static offset, at the valid texels, [C, N]."""
    for _ in range(levels):
        ll = inverse_dwt(ll, None, rec_lo, rec_lo)
    for _ in range(coarser):
        ll = halve(ll)
    return add_static(ll, texels, static_offset)


def pack_channels(
    texture: Array,  # [N, 23] raw channels
) -> Array:
    """Channels as the kernels hold them, [6, N, 2] uint32: geometry in three rows of four half floats, then appearance.

    Beyond the largest half float, values are held there; the twelfth of geometry is zero, or how much brighter
    expressions made the colours.
    """
    padded = np.insert(texture, APPEARANCE.start, 0, axis=1)
    halves = np.clip(padded, -LARGEST, LARGEST).astype("<f2").reshape(len(texture), ROWS, BATCH)
    return np.ascontiguousarray(halves.swapaxes(0, 1)).view("<u4")


def unpack_channels(
    words: Array,  # [6, N, 2] uint32, or as many words in a row
) -> Array:
    """The raw channels [N, 23] that pack_channels packed, float32."""
    halves = np.ascontiguousarray(words, "<u4").view("<f2").reshape(ROWS, -1, BATCH).swapaxes(0, 1)
    return np.delete(halves.reshape(-1, ROWS * BATCH), APPEARANCE.start, axis=1).astype(np.float32)


def pack_planes(
    planes: Array,  # [..., n, n]
) -> Array:
    """LL or details as kernels exchange them, [..., n, ceil(n / 2)] uint32: two columns' half floats to a word.

    Each is off by at most 1/2048 of itself, or 2^-25 below 2^-14; 1/1024 and 2^-24 where a device rounds towards zero.
    Beyond the largest half float, values are held there.
    """
    largest = np.finfo(np.float16).max
    padding = [(0, 0)] * (planes.ndim - 1) + [(0, planes.shape[-1] % 2)]
    halves = np.pad(
        np.clip(planes, -largest, largest).astype("<f2"), padding, mode="edge" if planes.size else "constant"
    )
    return np.ascontiguousarray(halves).view("<u4")


def unpack_planes(
    words: Array,  # [..., n, ceil(n / 2)] uint32
) -> Array:
    """The planes that pack_planes packed, [..., n, n] float32."""
    halves = np.ascontiguousarray(words, "<u4").view("<f2")
    return halves[..., : words.shape[-2]].astype(np.float32)


def plane_bytes(size: int) -> int:
    """Bytes of a plane that pack_planes packed."""
    return 4 * size * ((size + 1) // 2)


def whole_words(
    taps: Array,  # [L], L even
) -> Array:
    """The filter padded to twice an odd number of taps, so that a thread of InverseDwt completes its words."""
    return np.pad(taps, 1) if len(taps) % 4 == 0 else taps


def upsampling_taps(
    rec_lo: Array,  # [L], L even
    levels: int,  # without details
    coarser: int = 0,  # at most `levels`: how often two texels were merged
) -> tuple[Array, int]:
    """The filter g [S, F] that levels of low-pass synthesis are together, and its delay, in float64.

    x[p] = sum_j g[j, s] a[k - j] with F k + s = p + delay, F = 2^(levels - coarser), indices wrapped: one level and
    then another are the taps of the first, spread by two, convolved with those of the second (the noble identity of
    multirate filters); means of two texels are a filter of the means of two taps. Zeros at both ends of g are left out,
    since a kernel would multiply by them.
    """
    taps = np.ones(1)
    for _ in range(levels):
        spread = np.zeros(2 * len(taps) - 1)
        spread[::2] = taps
        taps = np.convolve(spread, np.asarray(rec_lo, dtype=np.float64))
    delay = ((1 << levels) - 1) * (len(rec_lo) // 2 - 1)
    for _ in range(coarser):
        even = np.concatenate([np.zeros(delay % 2), taps, np.zeros((len(taps) + delay) % 2)])
        taps, delay = even.reshape(-1, 2).mean(axis=1), (delay + 1) // 2
    factor = 1 << levels - coarser
    used = np.flatnonzero(taps)
    first, last = (min(int(used[0]), delay), int(used[-1])) if len(used) else (0, 0)
    padded = np.zeros(-(-(last + 1 - first) // factor) * factor)
    padded[: last + 1 - first] = taps[first : last + 1]
    return padded.reshape(-1, factor), delay - first


def texel_tiles(
    texels: Array,  # [N] row * size + column, ascending
    size: int,
    reached: Array | None = None,  # [N] bool: those that expressions may change; None: none
) -> Array:
    """Tiles of 16 x 16 texels that hold a valid one, as the shader takes them, [T, 17, 2].

    Column and row of a tile, in tiles; and of each of its rows the place in `texels` of the first that it holds, and
    its columns as bits, from bit 16 on those that are reached.
    """
    rows, columns = np.divmod(texels, size)
    numbers, places = np.unique((rows // TILE << 16) + columns // TILE, return_inverse=True)
    lines, firsts, line_of = np.unique(places * (TILE + 1) + 1 + rows % TILE, return_index=True, return_inverse=True)
    tiles = np.zeros((len(numbers) * (TILE + 1), 2), np.uint32)
    tiles[:: TILE + 1] = np.stack([numbers & 0xFFFF, numbers >> 16], axis=1)
    tiles[lines, 0] = firsts
    held, bits = np.zeros(len(lines), np.uint32), np.uint32(1) << (columns % TILE).astype(np.uint32)
    if reached is not None:
        bits |= bits << np.uint32(TILE) * reached.astype(np.uint32)
    np.bitwise_or.at(held, line_of, bits)
    tiles[lines, 1] = held
    return tiles.reshape(-1, TILE + 1, 2)


def _upsample(
    band: Array,  # [C, p, q]
    taps: Array,  # [L]
    axis: int,  # 1 or 2
) -> Array:
    """Put zeros between the samples along `axis` and filter circularly, one output phase at a time."""
    shape = list(band.shape)
    shape[axis] *= 2
    fine = np.zeros(shape, dtype=band.dtype)
    phases = [fine[:, p::2] if axis == 1 else fine[:, :, p::2] for p in (0, 1)]
    centre = len(taps) // 2 - 1
    for t in np.flatnonzero(taps):
        step, phase = divmod(int(t) - centre, 2)
        phases[phase] += band.dtype.type(taps[t]) * np.roll(band, step, axis)
    return fine
