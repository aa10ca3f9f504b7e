"""The reference against PyWavelets for every biorthogonal wavelet it has; the shader against the reference."""

import numpy as np
import pytest
import pywt
from stored import STORAGES, groups, store

from mua.arrays import Array
from mua.asset.tensors import Storage
from mua.gpu import Device, run
from mua.kernels.inverse_dwt import add_static, inverse_dwt

WAVELETS = pywt.wavelist("bior")
SIDES = [1, 2, 3, 5, 8, 13]
PAPER_LEVELS = [(11, 48), (12, 96), (2, 192), (1, 384)]  # channels, side of the coarse level
LONGEST = 40  # taps that a file may hold
TILE, TEXELS_PER_GROUP = 16, 256
UNTOUCHED = np.float32(-7)


def taps(name: str) -> tuple[Array, Array]:
    wavelet = pywt.Wavelet(name)
    return np.array(wavelet.rec_lo), np.array(wavelet.rec_hi)


def rounding_bound(name: str, dtype: type, largest: float) -> float:
    """Each output is a sum of at most 4 L^2 products, rounded twice, of coefficients below `largest`."""
    lo, hi = taps(name)
    gain = (np.abs(lo).sum() + np.abs(hi).sum()) ** 2
    return float(2 * len(lo) * np.finfo(dtype).eps * gain * largest)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("name", WAVELETS)
def test_full_level_equals_pywt(name: str, dtype: type) -> None:
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


def shader_level(device: Device, ll: Array, details: Array | None, lo: Array, hi: Array) -> Array:
    """One level by the shader, after checking that it wrote nothing else."""
    channels, side, _ = ll.shape
    inputs = {"ll": ll, "rec_lo": lo.astype(np.float32)}
    if details is not None:
        inputs |= {"details": details, "rec_hi": hi.astype(np.float32)}
    fine = run(
        device,
        "inverse_dwt.compute",
        "InverseDwtLowPass" if details is None else "InverseDwt",
        groups((side, TILE), (side, TILE), (channels, 1)),
        inputs | {"fine": np.full((channels + 1, 2 * side, 2 * side), UNTOUCHED)},
        size=side,
        taps=len(lo),
        **({} if details is None else {"channels": channels}),
    )["fine"]
    assert np.all(fine[channels] == UNTOUCHED)
    return np.asarray(fine[:channels])


def check_level(device: Device, bands: Array, lo: Array, hi: Array) -> None:
    """Both variants against the reference in double precision, on the taps that the shader has.

    Each of the two axes rounds a sum of L products, L + 1 times on the way of one term.
    """
    lo, hi = lo.astype(np.float32), hi.astype(np.float32)
    gain = (np.abs(lo.astype(float)).sum() + np.abs(hi.astype(float)).sum()) ** 2
    sums_bound = 2 * (len(lo) + 1) * np.finfo(np.float32).eps * gain * np.abs(bands).max(initial=0)
    ll, details = bands[0], bands[1:]
    for parts in (details, None):
        doubles = None if parts is None else parts.astype(float)
        expected = inverse_dwt(ll.astype(float), doubles, lo.astype(float), hi.astype(float))
        np.testing.assert_allclose(shader_level(device, ll, parts, lo, hi), expected, rtol=0, atol=sums_bound)


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


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize(("channels", "side", "count"), [(1, 1, 1), (11, 5, 13), (12, 7, 0), (0, 3, 4), (3, 96, 5003)])
def test_static_shader_equals_the_reference(
    device: Device, channels: int, side: int, count: int, storage: Storage
) -> None:
    rng = np.random.default_rng(count)
    fine = rng.normal(size=(channels, side, side)).astype(np.float32)
    texels = np.sort(rng.permutation(side * side)[:count]).astype(np.uint32)
    static_offset = store(rng.normal(size=(channels, count)), storage, rows=channels)
    first_channel = 2
    found = run(
        device,
        "inverse_dwt.compute",
        "AddStatic",
        groups((count, TEXELS_PER_GROUP)),
        {
            "fine": fine,
            "texels": texels,
            "static_offset": static_offset.words,
            "texel_channels": np.full((first_channel + channels + 1, count), UNTOUCHED),
        },
        static_offset_layout=static_offset.layout,
        channels=channels,
        size=side,
        texel_count=count,
        first_channel=first_channel,
    )["texel_channels"]
    written = slice(first_channel, first_channel + channels)
    expected = add_static(fine.astype(float), texels, static_offset.values)
    one_sum_bound = np.finfo(np.float32).eps * np.abs(expected)
    assert np.all(np.abs(found[written] - expected) <= one_sum_bound)
    assert np.all(np.delete(found, written, axis=0) == UNTOUCHED)
