"""The wavelet transforms against PyWavelets."""

import numpy as np
import pytest
import pywt
import torch

from mua import wavelets
from mua.errors import InputError

OURS = "spline3"
NAMES = [*pywt.wavelist("bior"), "haar", "db3"]
SIZES = [(32, 32, 1), (48, 16, 3), (4, 2, 1), (80, 112, 4)]
TAP_ERROR = 1e-11  # the published taps of bior4.4 to bior6.8 invert each other only to about 12 digits


def oracle(wavelet: str) -> pywt.Wavelet:
    """PyWavelets' bank of a name, and one of our wavelet, whose analysis PyWavelets is not asked for."""
    if wavelet != OURS:
        return pywt.Wavelet(wavelet)
    low, high = np.array([[1, 3, 3, 1], [1, -3, 3, -1]]) / np.sqrt(32)
    return pywt.Wavelet(OURS, filter_bank=(low, high, low, high))


def rounding(wavelet: str, levels: int, dtype: torch.dtype) -> float:
    """Bound for the rounding of `levels` 2-D steps on unit normal values: eps x operations x gain of the filters."""
    bank = oracle(wavelet)
    gain = max(np.abs(taps).sum() for taps in bank.filter_bank) ** 2
    largest_value = 6
    return float(torch.finfo(dtype).eps * 2 * bank.dec_len * levels * gain**levels * largest_value)


def images(rows: int, columns: int, dtype: torch.dtype) -> torch.Tensor:
    return torch.from_numpy(np.random.default_rng(rows * 1000 + columns).standard_normal((2, 3, rows, columns))).to(
        dtype
    )


def pywt_subbands(x: torch.Tensor, wavelet: str, levels: int) -> tuple[np.ndarray, list[np.ndarray]]:
    """pywt's subbands of float64 images, one level at a time: its own loop warns of filters longer than images."""
    ll = x.double().numpy()
    details: list[np.ndarray] = []
    for _ in range(levels):
        ll, bands = pywt.dwt2(ll, wavelet, "periodization")
        details.insert(0, np.stack(bands, axis=-3))
    return ll, details


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("wavelet", NAMES)
def test_subbands_equal_pywt(wavelet: str, size: tuple[int, int, int], dtype: torch.dtype) -> None:
    rows, columns, levels = size
    x = images(rows, columns, dtype)
    ll, details = wavelets.wavedec2(x, wavelet, levels)
    expected_ll, expected_details = pywt_subbands(x, wavelet, levels)
    bound = rounding(wavelet, levels, dtype)
    assert ll.dtype == dtype
    np.testing.assert_allclose(ll.numpy(), expected_ll, rtol=0, atol=bound)
    assert len(details) == levels
    for level, expected in zip(details, expected_details, strict=True):
        np.testing.assert_allclose(level.numpy(), expected, rtol=0, atol=bound)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("wavelet", [*NAMES, OURS])
def test_reconstruction_is_perfect(wavelet: str, size: tuple[int, int, int]) -> None:
    rows, columns, levels = size
    x = images(rows, columns, torch.float64)
    rebuilt = wavelets.waverec2(*wavelets.wavedec2(x, wavelet, levels), wavelet)
    bound = rounding(wavelet, 2 * levels, torch.float64) + levels * TAP_ERROR * float(x.abs().max())
    torch.testing.assert_close(rebuilt, x, rtol=0, atol=bound)


@pytest.mark.parametrize("wavelet", ["bior4.4", "bior2.2", "haar", OURS])
def test_synthesis_of_arbitrary_subbands_equals_pywt(wavelet: str) -> None:
    ll, details = wavelets.wavedec2(images(48, 32, torch.float64), wavelet, 3)
    ll, details = ll * 2, [torch.flip(level, (-1,)) for level in details]
    expected = ll.numpy()
    for level in details:
        expected = pywt.idwt2((expected, tuple(np.moveaxis(level.numpy(), -3, 0))), oracle(wavelet), "periodization")
    bound = rounding(wavelet, 6, torch.float64)
    np.testing.assert_allclose(wavelets.waverec2(ll, details, wavelet).numpy(), expected, rtol=0, atol=bound)


@pytest.mark.parametrize("wavelet", ["bior4.4", OURS])
def test_lowpass_alone_equals_the_full_transform(wavelet: str) -> None:
    x = images(96, 64, torch.float64)
    ll, details = wavelets.wavedec2(x, wavelet, 2)
    bound = rounding(wavelet, 4, torch.float64)
    torch.testing.assert_close(wavelets.analyse_lowpass(x, wavelet, 2), ll, rtol=0, atol=bound)
    silent = [torch.zeros_like(level) for level in details]
    expected = wavelets.waverec2(ll, silent, wavelet)
    torch.testing.assert_close(wavelets.synthesise_lowpass(ll, wavelet, 2), expected, rtol=0, atol=bound)


def test_half_the_size_is_the_nearest_that_splines_come() -> None:
    """The low-pass subband is the least-squares solution over all images that the low-pass synthesis makes."""
    x = images(32, 32, torch.float64)
    low = wavelets.synthesise_lowpass(wavelets.analyse_lowpass(x, OURS, 1), OURS, 1)
    left = wavelets.analyse_lowpass(x - low, OURS, 1)
    bound = rounding(OURS, 3, torch.float64)
    torch.testing.assert_close(left, torch.zeros_like(left), rtol=0, atol=bound)
    other = wavelets.synthesise_lowpass(images(16, 16, torch.float64), OURS, 1)
    products = ((x - low) * other).sum((-2, -1))
    torch.testing.assert_close(products, torch.zeros_like(products), rtol=0, atol=bound * x[0, 0].numel())


def test_static_offset_completes_the_lowpass_synthesis() -> None:
    """Paper, Wavelet-Guided Representation: IDWT(LL, D3, D2, 0, 0) + IDWT(0, 0, 0, D1, D0) is the image."""
    x = images(64, 64, torch.float64)
    ll, (d3, d2, d1, d0) = wavelets.wavedec2(x, "bior4.4", 4)
    middle = wavelets.waverec2(ll, [d3, d2], "bior4.4")
    fine = wavelets.waverec2(torch.zeros_like(middle), [d1, d0], "bior4.4")
    bound = rounding("bior4.4", 8, torch.float64) + 4 * TAP_ERROR * float(x.abs().max())
    torch.testing.assert_close(wavelets.synthesise_lowpass(middle, "bior4.4", 2) + fine, x, rtol=0, atol=bound)


def test_gradient_passes_through() -> None:
    x = images(8, 8, torch.float64).requires_grad_()
    assert torch.autograd.gradcheck(lambda image: wavelets.wavedec2(image, "bior4.4", 2)[0], (x,))


@pytest.mark.parametrize(("rows", "columns", "levels"), [(7, 8, 1), (8, 6, 2), (1, 1, 1)])
def test_rejects_sizes_that_cannot_be_halved(rows: int, columns: int, levels: int) -> None:
    with pytest.raises(InputError, match=f"{rows} x {columns} cannot be halved {levels} times"):
        wavelets.wavedec2(torch.zeros(rows, columns), "bior4.4", levels)
    with pytest.raises(InputError, match="cannot be halved"):
        wavelets.analyse_lowpass(torch.zeros(rows, columns), "bior4.4", levels)


def test_rejects_a_detail_level_of_another_size() -> None:
    with pytest.raises(InputError, match=r"shape \(3, 4, 8\), expected \[\.\.\., 3, 8, 8\]"):
        wavelets.waverec2(torch.zeros(8, 8), [torch.zeros(3, 4, 8)], "bior4.4")


def test_rejects_an_unknown_wavelet() -> None:
    with pytest.raises(InputError, match=r"'bior9\.9' is unknown"):
        wavelets.wavedec2(torch.zeros(8, 8), "bior9.9", 1)
