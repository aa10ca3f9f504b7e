"""The reference against the paper's sums, written out term by term; the shader against the reference."""

from typing import Any

import numpy as np
import pytest
from dispatch import run
from packed_splats import assert_halves
from stored import STORAGES, groups, store

from mua.arrays import Array
from mua.asset.tensors import Element
from mua.gpu import Device
from mua.kernels.blend_subbands import blend_detail, blend_ll

SIZES = [(1, 1, 1), (2, 3, 5), (11, 7, 6), (3, 1, 13), (2, 0, 4)]  # channels, rank, side
SHADER_SIZES = [*SIZES, (0, 3, 4), (1, 17, 31), (2, 33, 24)]
PAPER_LL = [(11, 192, 48), (12, 128, 48)]
PAPER_DETAILS = [(11, 128, 48), (12, 96, 96)]
PAIRS_PER_GROUP, TILE = 64, 24
ALPHA_OFFSET = 7
UNTOUCHED = np.float16(-7)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize(("channels", "rank", "side"), SIZES)
def test_ll_is_the_mean_and_a_weighted_sum_of_the_basis(channels: int, rank: int, side: int, dtype: Any) -> None:
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
    channels: int, rank: int, side: int, dtype: Any
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


def buffered(alpha: Array) -> Array:
    """The coefficients as they follow others in the output of the MLP."""
    return np.concatenate([np.full(ALPHA_OFFSET, np.nan), alpha.ravel(), np.full(3, np.nan)]).astype(np.float32)


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize(("channels", "rank", "side"), SHADER_SIZES + PAPER_LL)
def test_ll_shader_equals_the_reference(device: Device, channels: int, rank: int, side: int, storage: Element) -> None:
    rng = np.random.default_rng(side)
    mean = store(rng.normal(size=(channels, side, side)), storage, rows=channels)
    basis = store(rng.normal(size=(channels, rank, side, side)), storage, rows=channels * rank)
    alpha = rng.normal(size=(channels, rank)).astype(np.float32)
    blended = run(
        device,
        "blend_subbands.compute",
        "BlendLl",
        groups((side * -(-side // 2), PAIRS_PER_GROUP), (channels, 1)),
        {
            "mean": mean.words,
            "basis": basis.words,
            "alpha": buffered(alpha),
            "blended": np.full((channels + 1, side, side + side % 2), UNTOUCHED),
        },
        mean_layout=mean.layout,
        basis_layout=basis.layout,
        channels=channels,
        rank=rank,
        size=side,
        alpha_offset=ALPHA_OFFSET,
    )["blended"]
    expected = blend_ll(mean.values, basis.values, alpha.astype(float))
    magnitude = blend_ll(np.abs(mean.values), np.abs(basis.values), np.abs(alpha).astype(float))
    rounding_bound = (rank + 2) * np.finfo(np.float32).eps * magnitude
    assert_halves(blended[:channels, :, :side], expected, rounding_bound)
    assert np.all(blended[channels] == UNTOUCHED)


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize(("channels", "rank", "side"), SHADER_SIZES + PAPER_DETAILS)
def test_detail_shader_equals_the_reference(
    device: Device, channels: int, rank: int, side: int, storage: Element
) -> None:
    rng = np.random.default_rng(side)
    mean = store(rng.normal(size=(3, channels, side, side)), storage, rows=3 * channels)
    h, w = (store(f, storage, rows=3 * channels * rank) for f in rng.normal(size=(2, 3, channels, rank, side)))
    alpha = rng.normal(size=(channels, rank)).astype(np.float32)
    blended = run(
        device,
        "blend_subbands.compute",
        "BlendDetail",
        groups((side, TILE), (side, TILE), (3 * channels, 1)),
        {
            "mean": mean.words,
            "h": h.words,
            "w": w.words,
            "alpha": buffered(alpha),
            "blended": np.full((3 * channels + 1, side, side + side % 2), UNTOUCHED),
        },
        mean_layout=mean.layout,
        h_layout=h.layout,
        w_layout=w.layout,
        channels=channels,
        rank=rank,
        size=side,
        alpha_offset=ALPHA_OFFSET,
    )["blended"]
    found, beyond = blended[:-1, :, :side].reshape(mean.values.shape), blended[-1]
    expected = blend_detail(mean.values, h.values, w.values, alpha.astype(float))
    magnitude = blend_detail(np.abs(mean.values), np.abs(h.values), np.abs(w.values), np.abs(alpha).astype(float))
    rounding_bound = (rank + 3) * np.finfo(np.float32).eps * magnitude
    assert_halves(found, expected, rounding_bound)
    assert np.all(beyond == UNTOUCHED)
