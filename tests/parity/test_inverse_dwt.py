"""The reference against PyWavelets for every biorthogonal wavelet it has; the shader against the reference."""

from typing import Any

import numpy as np
import pytest
import pywt
from dispatch import run
from dwt_cases import taps, upsampling_bound
from packed_splats import assert_halves
from stored import STORAGES, groups, store

from mua.arrays import Array
from mua.asset.tensors import Element
from mua.gpu import Device
from mua.kernels.inverse_dwt import (
    BATCH,
    add_static,
    halve,
    inverse_dwt,
    pack_channels,
    pack_planes,
    texel_tiles,
    unpack_channels,
    unpack_planes,
    upsample_texels,
    upsampling_taps,
    whole_words,
)
from mua.limits import MOST_TAPS

WAVELETS = pywt.wavelist("bior")
SIDES = [1, 2, 3, 5, 8, 13]
PAPER_LEVELS = [(11, 48), (12, 96)]  # channels, side of the coarse level
LONGEST = 40  # taps that a file may hold
TILE = 16
UNTOUCHED = np.float16(-7)


def rounding_bound(name: str, dtype: type, largest: float) -> float:
    """Each output is a sum of at most 4 L^2 products, rounded twice, of coefficients below `largest`."""
    lo, hi = taps(name)
    gain = (np.abs(lo).sum() + np.abs(hi).sum()) ** 2
    return float(2 * len(lo) * np.finfo(dtype).eps * gain * largest)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("name", WAVELETS)
def test_full_level_equals_pywt(name: str, dtype: Any) -> None:
    for side in SIDES:
        rng = np.random.default_rng(side)
        bands = rng.normal(size=(4, 2, side, side)).astype(dtype)
        fine = inverse_dwt(bands[0], bands[1:], *taps(name))
        expected = pywt.idwt2((bands[0].astype(float), tuple(bands[1:].astype(float))), name, "periodization", (1, 2))
        assert fine.dtype == dtype
        np.testing.assert_allclose(fine, expected, rtol=0, atol=rounding_bound(name, dtype, np.abs(bands).max()))


@pytest.mark.parametrize("name", WAVELETS)
def test_low_pass_level_equals_zero_details(name: str) -> None:
    for side in SIDES:
        ll = np.random.default_rng(side).normal(size=(3, side, side))
        expected = inverse_dwt(ll, np.zeros((3, *ll.shape)), *taps(name))
        np.testing.assert_allclose(inverse_dwt(ll, None, *taps(name)), expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize("name", ["bior1.1", "bior2.2", "bior4.4", "bior6.8"])
def test_four_levels_equal_pywt(name: str) -> None:
    texture = np.random.default_rng(0).normal(size=(1, 288, 288))
    coefficients = pywt.wavedec2(texture, name, "periodization", level=4, axes=(1, 2))
    restored = coefficients[0]
    for details in coefficients[1:]:
        restored = inverse_dwt(restored, np.stack(details), *taps(name))
    expected = pywt.waverec2(coefficients, name, "periodization", axes=(1, 2))
    bound = 4 * rounding_bound(name, np.float64, max(np.abs(c).max() for c in map(np.asarray, coefficients)))
    np.testing.assert_allclose(restored, expected, rtol=0, atol=bound)


def test_no_channels_and_no_texels() -> None:
    assert inverse_dwt(np.zeros((0, 3, 3)), None, *taps("bior2.2")).shape == (0, 6, 6)
    assert add_static(np.zeros((2, 4, 4)), np.zeros(0, int), np.zeros((2, 0))).shape == (2, 0)


def test_static_offset_lands_on_its_texels() -> None:
    texture = np.arange(2 * 3 * 3.0).reshape(2, 3, 3)
    found = add_static(texture, np.array([0, 5, 8]), np.array([[100.0, 200, 300], [0, 0, 1]]))
    np.testing.assert_array_equal(found, [[100, 205, 308], [9, 14, 18]])


LOW_PASSES = [(0, 0), (1, 0), (2, 0), (3, 0), (1, 1), (2, 1), (2, 2), (3, 1)]


@pytest.mark.parametrize(("levels", "coarser"), LOW_PASSES)
@pytest.mark.parametrize("name", ["bior1.1", "bior3.1", "bior4.4", "bior6.8"])
def test_low_pass_levels_and_means_of_them_are_one_filter(name: str, levels: int, coarser: int) -> None:
    filtered, delay = upsampling_taps(taps(name)[0], levels, coarser)
    factor, means = 1 << levels - coarser, 1 << coarser
    assert filtered.shape[1] == factor
    assert coarser or (filtered[0].any() and filtered[-1].any())
    for side in (1, 2, 5):
        samples = np.random.default_rng(side).normal(size=side)
        expected = samples
        for _ in range(levels):
            expected = pywt.idwt(expected, None, name, "periodization")
        newest, phases = np.divmod(np.arange(factor * side) + delay, factor)
        found = sum(filtered[j, phases] * samples[(newest - j) % side] for j in range(len(filtered)))
        np.testing.assert_allclose(found, expected.reshape(-1, means).mean(axis=1), rtol=0, atol=1e-12)


@pytest.mark.parametrize("side", [2, 6])
def test_a_coarser_texture_is_the_means_of_its_blocks(side: int) -> None:
    texture = np.random.default_rng(side).normal(size=(3, side, side)).astype(np.float32)
    found = halve(texture)
    assert found.dtype == np.float32
    for row, column in np.ndindex(side // 2, side // 2):
        block = texture[:, 2 * row : 2 * row + 2, 2 * column : 2 * column + 2]
        np.testing.assert_allclose(found[:, row, column], block.mean(axis=(1, 2)), rtol=0, atol=1e-6)


def test_a_filter_of_zeros_is_one_sample() -> None:
    filtered, delay = upsampling_taps(np.zeros(4), 1)
    np.testing.assert_array_equal(filtered, [[0, 0]])
    assert delay == 1


def test_zeros_before_the_centre_alone_are_left_out() -> None:
    late = np.array([0, 0, 0, 1.0])  # its only tap comes after the centre of its four
    filtered, delay = upsampling_taps(late, 1)
    assert delay == 0
    np.testing.assert_array_equal(filtered, [[0, 0], [1, 0]])


def test_tiles_hold_each_valid_texel_once_and_no_tile_is_empty() -> None:
    size = 37
    texels = np.sort(np.random.default_rng(0).permutation(size * size)[:90])
    reached = np.random.default_rng(1).random(len(texels)) < 0.3
    tiles = texel_tiles(texels, size, reached)
    assert tiles[:, 1:, 1].any(axis=1).all()
    found: dict[int, Any] = {}
    for (across, down), *lines in tiles.astype(int):
        for line, (first, mask) in enumerate(lines):
            columns = [c for c in range(TILE) if mask >> c & 1]
            at = (TILE * down + line) * size + TILE * across
            found |= {at + c: (first + i, bool(mask >> TILE + c & 1)) for i, c in enumerate(columns)}
    assert found == {texel: (place, reached[place]) for place, texel in enumerate(texels)}
    np.testing.assert_array_equal(texel_tiles(texels, size)[..., 1] >> TILE, 0)


@pytest.mark.parametrize("count", [0, 1, 7])
def test_packed_channels_are_their_half_floats(count: int) -> None:
    texture = np.random.default_rng(count).normal(size=(count, 23)).astype(np.float16).astype(np.float32)
    words = pack_channels(texture)
    assert words.shape == (6, count, 2)
    np.testing.assert_array_equal(unpack_channels(words), texture)
    rows = words.view(np.float16)
    np.testing.assert_array_equal(rows[2, :, 2:], np.stack([texture[:, 10], np.zeros(count)], axis=1))
    np.testing.assert_array_equal(rows[3], texture[:, 11:15])


def test_channels_beyond_half_floats_are_held_at_the_largest() -> None:
    texture = np.resize([1e9, -1e9], (1, 23))
    np.testing.assert_array_equal(unpack_channels(pack_channels(texture)), np.resize([65504.0, -65504.0], (1, 23)))


@pytest.mark.parametrize("side", [0, 1, 4, 7])
def test_planes_are_halves_in_rows_of_whole_words(side: int) -> None:
    planes = np.random.default_rng(side).normal(size=(3, 2, side, side)).astype(np.float32)
    words = pack_planes(planes)
    assert words.shape == (3, 2, side, -(-side // 2))
    np.testing.assert_array_equal(unpack_planes(words), planes.astype(np.float16))


@pytest.mark.parametrize("length", [2, 4, 10, LONGEST])
def test_taps_for_whole_words_filter_the_same(length: int) -> None:
    lo, hi = np.random.default_rng(length).normal(size=(2, length))
    bands = np.random.default_rng(1).normal(size=(4, 2, 7, 7))
    assert len(whole_words(lo)) % 4 == 2
    np.testing.assert_array_equal(
        inverse_dwt(bands[0], bands[1:], whole_words(lo), whole_words(hi)), inverse_dwt(bands[0], bands[1:], lo, hi)
    )


def shader_level(device: Device, ll: Array, details: Array, lo: Array, hi: Array) -> Array:
    """One level of packed bands by the shader, after checking that it wrote nothing else."""
    lo, hi = whole_words(lo), whole_words(hi)
    channels, side, _ = ll.shape
    fine = run(
        device,
        "inverse_dwt.compute",
        "InverseDwt",
        groups((side, TILE), (side, TILE), (channels, 1)),
        {
            **{"ll": ll, "details": details, "rec_lo": lo.astype(np.float32), "rec_hi": hi.astype(np.float32)},
            "fine": np.full((channels + 1, 2 * side, 2 * side), UNTOUCHED),
        },
        size=side,
        taps=len(lo),
        channels=channels,
    )["fine"]
    assert np.all(fine[channels] == UNTOUCHED)
    return np.asarray(fine[:channels])


def check_level(device: Device, bands: Array, lo: Array, hi: Array) -> None:
    """The shader against the reference in double precision, on the taps that the shader has.

    Each of the two axes rounds a sum of L products, L + 1 times on the way of one term.
    """
    lo, hi = lo.astype(np.float32), hi.astype(np.float32)
    gain = (np.abs(lo.astype(float)).sum() + np.abs(hi.astype(float)).sum()) ** 2
    sums_bound = 2 * (len(lo) + 1) * np.finfo(np.float32).eps * gain * np.abs(bands).max(initial=0)
    packed = pack_planes(bands)
    ll, details = unpack_planes(packed)[0], unpack_planes(packed)[1:]
    expected = inverse_dwt(ll.astype(float), details.astype(float), lo.astype(float), hi.astype(float))
    assert_halves(shader_level(device, packed[0], packed[1:], lo, hi), expected, sums_bound)


@pytest.mark.parametrize("name", WAVELETS)
def test_shader_equals_the_reference_for_every_wavelet(device: Device, name: str) -> None:
    for side in (3, 13):
        bands = np.random.default_rng(side).normal(size=(4, 2, side, side)).astype(np.float32)
        check_level(device, bands, *taps(name))


@pytest.mark.parametrize("channels", [0, 1, 3])
@pytest.mark.parametrize("side", [*SIDES, 17, 31])
def test_shader_equals_the_reference_at_odd_sizes(device: Device, channels: int, side: int) -> None:
    bands = np.random.default_rng(side).normal(size=(4, channels, side, side)).astype(np.float32)
    check_level(device, bands, *taps("bior4.4"))


@pytest.mark.parametrize("length", [2, 4, 38, LONGEST])
def test_shader_takes_any_even_number_of_taps(device: Device, length: int) -> None:
    rng = np.random.default_rng(length)
    for side in (1, 2, 7, 19):
        check_level(device, rng.normal(size=(4, 2, side, side)).astype(np.float32), *rng.normal(size=(2, length)))


@pytest.mark.parametrize(("channels", "side"), PAPER_LEVELS)
def test_shader_equals_the_reference_at_the_papers_sizes(device: Device, channels: int, side: int) -> None:
    bands = np.random.default_rng(side).normal(size=(4, channels, side, side)).astype(np.float32)
    check_level(device, bands, *taps("bior4.4"))


def check_texels(
    device: Device,
    ll: Array,
    lo: Array,
    levels: int,
    *,
    count: int,
    storage: Element = "f32",
    first_row: int = 0,
    coarser: int = 0,
) -> None:
    """The shader against the reference at `count` valid texels; nothing else is written."""
    channels, side, _ = ll.shape
    packed = pack_planes(ll)
    ll = unpack_planes(packed)
    rows, fine = -(-channels // BATCH), side << levels - coarser
    rng = np.random.default_rng(count)
    texels = np.sort(rng.permutation(fine * fine)[:count])
    static_offset = store(rng.normal(size=(channels, count)), storage, rows=channels)
    before = np.full((first_row + rows + 1, count, BATCH), UNTOUCHED, np.float16)
    tiles = texel_tiles(texels, fine, rng.random(count) < 0.7)
    filtered, delay = upsampling_taps(lo, levels, coarser)
    reach, factor = filtered.shape
    found = run(
        device,
        "inverse_dwt.compute",
        "UpsampleTexels",
        (len(tiles), 1, rows),
        {
            **{"ll": packed, "upsampling": filtered.astype(np.float32), "tiles": tiles},
            **{"static_offset": static_offset.words, "texel_channels": before},
        },
        static_offset_layout=static_offset.layout,
        **{"channels": channels, "size": side, "factor": factor, "reach": reach, "delay": delay},
        texel_count=count,
        first_row=first_row,
    )["texel_channels"]
    written = slice(first_row, first_row + rows)
    halves = found[written].swapaxes(1, 2).reshape(BATCH * rows, count)
    kept: dict[str, Any] = {"texels": texels, "static_offset": static_offset.values, "coarser": coarser}
    expected = upsample_texels(ll.astype(float), lo, levels, **kept)
    largest = np.abs(static_offset.values).max(initial=0)
    bound = upsampling_bound(filtered, np.abs(ll).max(initial=0), largest)
    assert_halves(halves[:channels], expected, bound)
    assert not halves[channels:].any()
    np.testing.assert_array_equal(np.delete(found, written, axis=0), np.delete(before, written, axis=0))


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize(
    ("channels", "side", "levels", "count"),
    [(1, 1, 0, 1), (11, 5, 1, 13), (12, 7, 2, 0), (0, 3, 2, 4), (3, 24, 2, 5003), (5, 3, 3, 570)],
)
def test_texel_shader_equals_the_reference(
    device: Device, channels: int, side: int, levels: int, count: int, storage: Element
) -> None:
    ll = np.random.default_rng(side).normal(size=(channels, side, side)).astype(np.float32)
    check_texels(device, ll, taps("bior4.4")[0], levels, count=count, storage=storage, first_row=2)


@pytest.mark.parametrize(("levels", "coarser"), [(1, 1), (2, 1), (2, 2)])
@pytest.mark.parametrize("length", [2, 10, MOST_TAPS])
def test_texel_shader_equals_the_reference_at_coarser_levels(
    device: Device, length: int, levels: int, coarser: int
) -> None:
    rng = np.random.default_rng(length)
    for side in (3, 24):
        ll, count = rng.normal(size=(5, side, side)).astype(np.float32), (side << levels - coarser) ** 2 // 2
        check_texels(device, ll, rng.normal(size=length), levels, count=count, coarser=coarser)


@pytest.mark.parametrize("levels", [0, 1, 2, 4])
@pytest.mark.parametrize("length", [2, 4, 38, LONGEST])
def test_texel_shader_takes_any_even_number_of_taps(device: Device, length: int, levels: int) -> None:
    rng = np.random.default_rng(length)
    for side in (1, 3):
        ll = rng.normal(size=(2, side, side)).astype(np.float32)
        check_texels(device, ll, rng.normal(size=length), levels, count=(side << levels) ** 2)


def test_texel_shader_equals_the_reference_at_the_papers_size(device: Device) -> None:
    ll = np.random.default_rng(0).normal(size=(12, 192, 192)).astype(np.float32)
    check_texels(device, ll, taps("bior4.4")[0], 2, count=300_000, storage="f16", first_row=3)
