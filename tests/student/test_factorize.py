"""Closed-form blendshapes against numpy's SVD, planted models and their own start."""

from itertools import pairwise

import numpy as np
import pytest
import torch

from mua.student.factorize import (
    Factors,
    alternate,
    blendshapes,
    fit_coefficients,
    separable_blendshapes,
    start_from_modes,
    sweep,
    truncated_svd,
)

FLOAT32 = float(np.finfo(np.float32).eps)
NEARLY_ALIKE = [((50, 1), (50, 512)), ((3, 1, 24), (3, 512, 24)), ((3, 1, 24), (3, 512, 24))]


def generator(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def random(*shape: int, seed: int = 0) -> torch.Tensor:
    return torch.randn(*shape, generator=generator(seed))


def smooth_bands(frames: int, side: int, seed: int = 0) -> torch.Tensor:
    """Bands [F, 3, n, n] whose spectrum falls over frames and over space, as a texture's does."""
    modes = random(30, 3, side, side, seed=seed).cumsum(-1).cumsum(-2) / side
    weights = random(frames, 30, seed=seed + 1) / (1 + torch.arange(30))
    return torch.einsum("fk,ksij->fsij", weights, modes)


def squared_error(x: torch.Tensor, factors: Factors, worth: torch.Tensor | None = None) -> float:
    residual = x.flatten(1).double() - factors.coefficients.double() @ factors.basis().double()
    if worth is not None:
        residual = residual.unflatten(1, x.shape[1:]) * worth
    return float(residual.square().sum())


def seen(side: int) -> torch.Tensor:
    """Weights of samples [n, n]: some a hundredfold, and no outer product of lines."""
    return 10 ** (random(side, side, seed=9) - 1)


@pytest.mark.parametrize("shape", [(40, 23), (23, 40), (7, 1), (1, 7)])
def test_truncated_svd_leaves_no_more_than_the_best_rank(shape: tuple[int, int]) -> None:
    x = random(*shape) * torch.logspace(0, -3, shape[1])
    rank = 5
    u, s, v = truncated_svd(x, rank, generator=generator())
    values = np.linalg.svd(x.double().numpy(), compute_uv=False)
    best = np.square(values[rank:]).sum()
    left = float((x - (u * s) @ v).double().square().sum())
    rounding = (FLOAT32 * max(shape) * values[0]) ** 2
    assert left <= 1.001 * best + rounding
    assert len(s) == min(rank, *shape)


def test_blendshapes_have_coefficients_of_unit_variance() -> None:
    x = random(50, 12)
    shapes = blendshapes(x - x.mean(0), 4, generator=generator())
    variance = shapes.coefficients.square().mean(0)
    assert torch.allclose(variance, torch.ones(4), atol=50 * FLOAT32)


def test_blendshapes_beyond_the_number_of_frames_are_zero_and_the_rest_is_exact() -> None:
    x = random(5, 12)
    shapes = blendshapes(x, 8, generator=generator())
    assert shapes.basis.shape == (8, 12)
    assert not shapes.basis[5:].any()
    assert torch.allclose(shapes.coefficients @ shapes.basis, x, atol=100 * FLOAT32)


def test_blendshapes_are_the_best_where_samples_differ_in_worth() -> None:
    x, worth = random(50, 12), 10 ** random(12, seed=1)
    shapes = blendshapes(x, 4, generator=generator(), worth=worth)
    left = float(((x - shapes.coefficients @ shapes.basis) * worth).double().square().sum())
    values = np.linalg.svd((x * worth).double().numpy(), compute_uv=False)
    assert left == pytest.approx(np.square(values[4:]).sum(), rel=1e-3)
    assert torch.allclose(shapes.coefficients.square().mean(0), torch.ones(4), atol=50 * FLOAT32)


def test_separable_blendshapes_are_better_where_samples_count_for_more() -> None:
    x, worth = smooth_bands(37, 11), seen(11)
    found = separable_blendshapes(x, 6, sweeps=10, generator=generator(), worth=worth)
    alike = separable_blendshapes(x, 6, sweeps=10, generator=generator())
    assert squared_error(x, found, worth) < 0.9 * squared_error(x, alike, worth)
    assert squared_error(x, alike) < squared_error(x, found)


def test_samples_that_count_alike_change_nothing() -> None:
    x = smooth_bands(37, 11)
    found = separable_blendshapes(x, 6, sweeps=3, generator=generator(), worth=torch.full((11, 11), 2.0))
    alike = separable_blendshapes(x, 6, sweeps=3, generator=generator())
    assert squared_error(x, found) == pytest.approx(squared_error(x, alike), rel=1e-3)


@pytest.mark.parametrize("worth", [None, seen(11)])
def test_sweeps_never_raise_the_error(worth: torch.Tensor | None) -> None:
    x = smooth_bands(37, 11)
    factors = start_from_modes(x, 9)
    factors = Factors(fit_coefficients(x, factors, worth), factors.h, factors.w)
    errors = [squared_error(x, factors, worth)]
    for _ in range(12):
        factors = sweep(x, factors, worth)
        errors.append(squared_error(x, factors, worth))
    rounding = 100 * FLOAT32 * errors[0]
    assert all(after <= before + rounding for before, after in pairwise(errors))


@pytest.mark.parametrize("worth", [None, seen(11)])
def test_momentum_never_raises_the_error(worth: torch.Tensor | None) -> None:
    x = smooth_bands(37, 11)
    start = start_from_modes(x, 9)
    errors = [squared_error(x, alternate(x, start, sweeps=count, worth=worth), worth) for count in range(1, 26)]
    rounding = 100 * FLOAT32 * errors[0]
    assert all(after <= before + rounding for before, after in pairwise(errors))


@pytest.mark.parametrize("worth", [None, seen(11)])
def test_fifteen_rounds_with_momentum_beat_twenty_without(worth: torch.Tensor | None) -> None:
    x = smooth_bands(37, 11)
    plain = start = start_from_modes(x, 9)
    for _ in range(20):
        plain = sweep(x, plain, worth)
    assert squared_error(x, alternate(x, start, sweeps=15, worth=worth), worth) < squared_error(x, plain, worth)


def test_sweeps_beat_the_start_from_an_svd() -> None:
    x = smooth_bands(37, 11)
    start = separable_blendshapes(x, 9, sweeps=1, generator=generator())
    swept = separable_blendshapes(x, 9, sweeps=15, generator=generator())
    assert squared_error(x, swept) < 0.9 * squared_error(x, start)


def test_a_planted_separable_model_is_recovered() -> None:
    coefficients, h, w = random(60, 3), random(3, 3, 8, seed=1), random(3, 3, 8, seed=2)
    x = torch.einsum("fr,sri,srj->fsij", coefficients, h, w)
    found = separable_blendshapes(x, 3, sweeps=200, generator=generator())
    # Alternating least squares converges linearly: what is left after 200 sweeps is rounding, far below this share.
    assert squared_error(x, found) < 1e-6 * float(x.square().sum())


def test_rows_and_columns_have_equal_length_and_coefficients_unit_variance() -> None:
    found = separable_blendshapes(smooth_bands(20, 7), 4, sweeps=3, generator=generator())
    assert torch.allclose(found.h.square().sum((0, 2)), found.w.square().sum((0, 2)), rtol=100 * FLOAT32)
    assert torch.allclose(found.coefficients.square().mean(0), torch.ones(4), rtol=100 * FLOAT32)


def test_a_sweep_survives_terms_that_are_nearly_alike() -> None:
    """Their Gram matrix is beyond single precision."""
    near = [random(*one) + 1e-3 * random(*all_, seed=1) for one, all_ in NEARLY_ALIKE]
    found = sweep(random(50, 3, 24, 24), Factors(near[0], near[1], near[2]))
    assert torch.isfinite(found.h).all()


@pytest.mark.parametrize("frames", [1, 2])
def test_more_blendshapes_than_the_data_hold_still_fit(frames: int) -> None:
    x = smooth_bands(frames, 5)
    found = separable_blendshapes(x, 40, sweeps=3, generator=generator())
    assert found.h.shape == (3, 40, 5)
    assert torch.isfinite(found.h).all()
    assert squared_error(x, found) < 1e-4 * float(x.square().sum())


def test_a_channel_that_never_varies_has_no_blendshapes() -> None:
    found = separable_blendshapes(torch.zeros(6, 3, 4, 4), 3, sweeps=2, generator=generator())
    assert not found.basis().any()
    assert torch.isfinite(found.coefficients).all()


def test_the_same_generator_gives_the_same_bytes() -> None:
    x = smooth_bands(20, 6)
    first, second = (separable_blendshapes(x, 4, sweeps=3, generator=generator(5)) for _ in range(2))
    assert torch.equal(first.coefficients, second.coefficients)
    assert torch.equal(first.h, second.h)
