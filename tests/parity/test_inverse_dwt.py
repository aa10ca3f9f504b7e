"""Synthesis against PyWavelets, for every biorthogonal wavelet it has."""

import numpy as np
import pytest
import pywt

from mua.arrays import Array
from mua.kernels.inverse_dwt import add_static, inverse_dwt

WAVELETS = pywt.wavelist("bior")
SIDES = [1, 2, 3, 5, 8, 13]


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
