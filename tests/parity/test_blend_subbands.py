"""Subbands against the paper's sums, written out term by term."""

import numpy as np
import pytest

from mua.kernels.blend_subbands import blend_detail, blend_ll

SIZES = [(1, 1, 1), (2, 3, 5), (11, 7, 6), (3, 1, 13), (2, 0, 4)]  # channels, rank, side


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize(("channels", "rank", "side"), SIZES)
def test_ll_is_the_mean_and_a_weighted_sum_of_the_basis(channels: int, rank: int, side: int, dtype: type) -> None:
    rng = np.random.default_rng(rank)
    mean = rng.normal(size=(channels, side, side)).astype(dtype)
    basis = rng.normal(size=(channels, rank, side, side)).astype(dtype)
    alpha = rng.normal(size=(channels, rank)).astype(dtype)
    expected, magnitude = mean.astype(float), np.abs(mean).astype(float)
    for c in range(channels):
        for r in range(rank):
            expected[c] += float(alpha[c, r]) * basis[c, r].astype(float)
            magnitude[c] += np.abs(float(alpha[c, r]) * basis[c, r])
    blended = blend_ll(mean, basis, alpha)
    rounding_bound = (rank + 2) * np.finfo(dtype).eps * magnitude
    assert blended.dtype == dtype
    assert np.all(np.abs(blended - expected) <= rounding_bound)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize(("channels", "rank", "side"), SIZES)
def test_detail_is_the_mean_and_a_weighted_sum_of_outer_products(
    channels: int, rank: int, side: int, dtype: type
) -> None:
    rng = np.random.default_rng(rank)
    mean = rng.normal(size=(3, channels, side, side)).astype(dtype)
    h, w = rng.normal(size=(2, 3, channels, rank, side)).astype(dtype)
    alpha = rng.normal(size=(channels, rank)).astype(dtype)
    expected, magnitude = mean.astype(float), np.abs(mean).astype(float)
    for band, c, r in np.ndindex(3, channels, rank):
        term = float(alpha[c, r]) * np.multiply.outer(h[band, c, r].astype(float), w[band, c, r].astype(float))
        expected[band, c] += term
        magnitude[band, c] += np.abs(term)
    blended = blend_detail(mean, h, w, alpha)
    rounding_bound = (rank + 3) * np.finfo(dtype).eps * magnitude
    assert blended.dtype == dtype
    assert np.all(np.abs(blended - expected) <= rounding_bound)
