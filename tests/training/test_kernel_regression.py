"""Kernel ridge regression against the textbook's formula, in double precision."""

import math

import numpy as np
import pytest
import torch
from scipy.spatial.distance import cdist

from mua.training import kernel_regression
from mua.training.kernel_regression import LEAST, RIDGE, WIDTH, Through, fit_beyond, fit_smoother


def frames(count: int, dimensions: int = 4) -> tuple[torch.Tensor, torch.Tensor]:
    x = torch.randn(count, dimensions, generator=torch.Generator().manual_seed(0))
    return x, torch.stack([torch.tanh(x[:, 0]), x[:, 1] * x[:, 2]], dim=1)


def fitted(x: torch.Tensor, targets: torch.Tensor) -> kernel_regression.Smoother:
    return fit_smoother(x, targets, generator=torch.Generator().manual_seed(1))


def test_is_kernel_ridge_regression_where_every_frame_is_a_centre() -> None:
    x, targets = frames(50)
    new = frames(57)[0][50:]
    wide = WIDTH * 2 * (x.double() - x.double().mean(0)).square().sum(1).mean().item()
    kernel = np.exp(-cdist(x, x, "sqeuclidean") / wide)
    expected = np.exp(-cdist(new, x, "sqeuclidean") / wide) @ np.linalg.solve(
        kernel + RIDGE * np.eye(50), targets.double().numpy()
    )
    assert np.abs(fitted(x, targets)(new).numpy() - expected).max() < 1e-3 * np.abs(expected).max()


def test_some_of_the_frames_span_nearly_the_same_function(monkeypatch: pytest.MonkeyPatch) -> None:
    x, targets = frames(300)
    every = fitted(x, targets)(x)
    monkeypatch.setattr(kernel_regression, "CENTRES", 100)
    some = fitted(x, targets)
    assert len(some.centres) == 100
    assert (some(x) - every).square().sum() < 0.05 * every.square().sum()


@pytest.mark.parametrize("count", [1, 2])
def test_one_or_two_frames_are_given_back(count: int) -> None:
    x, targets = frames(count)
    assert torch.allclose(fitted(x, targets)(x), targets, atol=0.02 * float(targets.abs().max()))


def test_frames_that_are_all_alike_give_their_mean() -> None:
    targets = torch.tensor([[1.0], [3.0], [2.0]])
    found = fitted(torch.ones(3, 2), targets)(torch.ones(1, 2))
    assert float(found) == pytest.approx(2, rel=0.01)


def test_noise_counts_frame_by_frame_also_where_only_some_span_the_function(monkeypatch: pytest.MonkeyPatch) -> None:
    x, targets = frames(300)
    noise = torch.where(torch.arange(300) < 150, RIDGE, 10.0)
    every, some = (
        fit_smoother(x, targets, generator=torch.Generator().manual_seed(1), noise=noise)(x)
        for centres in (300, 200)
        if monkeypatch.setattr(kernel_regression, "CENTRES", centres) is None
    )
    errors = (every - targets).square().sum(1)
    assert errors[:150].mean() < 0.5 * errors[150:].mean()
    assert (some - every).square().sum() < 0.05 * every.square().sum()


def users_and_range() -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    """Points of the user's motion, close together, those of the range of motion, targets, and which is which."""
    x, targets = frames(80)
    own = torch.arange(80) < 50
    return torch.where(own[:, None], 0.2 * x + 1, 2 * x), torch.where(own[:, None], targets, 4 * targets), own


def test_what_all_frames_have_in_common_and_what_the_users_show_besides_add_up() -> None:
    frames_of, wanted, users = users_and_range()
    asked = torch.cat([frames_of[users][:5] + 0.05, 2 * frames(90)[0][80:]])
    found = fit_beyond(frames_of, wanted, users, beyond=10.0, generator=torch.Generator().manual_seed(1))(asked)
    x, targets, new, own = (part.double().numpy() for part in (frames_of, wanted, asked, users))
    own = own > 0

    def spread(points: np.ndarray) -> float:
        return float(2 * np.square(points - points.mean(0)).sum(1).mean())

    wide, reach = WIDTH * spread(x), spread(x[own])

    def kernel(a: np.ndarray, b: np.ndarray, width: float = wide) -> np.ndarray:
        return np.asarray(np.exp(-cdist(a, b, "sqeuclidean") / width))

    size = np.linalg.norm(targets, axis=1)
    noise = 10 * np.maximum(size / np.sqrt(np.square(size[~own]).mean()), LEAST)
    mean = targets[~own].mean(0)
    common = np.linalg.solve(kernel(x, x) + np.diag(noise), targets - mean)
    left = targets[own] - mean - kernel(x[own], x) @ common
    narrower = math.sqrt(wide * WIDTH * reach)
    besides = np.linalg.solve(kernel(x[own], x[own], narrower) + RIDGE * np.eye(own.sum()), left)
    trust = np.exp(-cdist(new, x[own], "sqeuclidean").min(1) / reach)
    expected = mean + kernel(new, x) @ common + trust[:, None] * (kernel(new, x[own], narrower) @ besides)
    assert np.abs(found.numpy() - expected).max() < 1e-3 * np.abs(expected).max()


def test_the_users_frames_are_kept_and_end_with_them() -> None:
    x, targets, own = users_and_range()
    function = fit_beyond(x, targets, own, beyond=10.0, generator=torch.Generator().manual_seed(1))
    assert (function(x[own]) - targets[own]).square().sum() < 0.1 * targets[own].square().sum()
    far = x[~own]
    assert (function(far) - targets[~own]).square().sum() > 0.5 * targets[~own].square().sum()
    assert function(far).square().sum() < 0.2 * targets[~own].square().sum()


def test_centres_that_both_widths_share_are_in_memory_once() -> None:
    x, targets, own = users_and_range()
    function = fit_beyond(x, targets, own, beyond=10.0, generator=torch.Generator().manual_seed(1))
    nested = function.terms[1]
    assert isinstance(nested, kernel_regression.Nested)
    assert torch.equal(nested.narrow.centres, x[own])
    assert nested.narrow.centres.data_ptr() == nested.wide.centres.data_ptr()


def test_far_from_all_frames_is_the_mean_of_those_that_are_not_the_users() -> None:
    x, targets, own = users_and_range()
    function = fit_beyond(x, targets, own, beyond=10.0, generator=torch.Generator().manual_seed(1))
    assert torch.allclose(function(x[:3] + 1e3), targets[~own].mean(0).repeat(3, 1), atol=1e-5)


@pytest.mark.parametrize("count", [1, 2])
def test_one_or_two_frames_of_the_user_are_given_back(count: int) -> None:
    x, targets, own = users_and_range()
    rows = torch.cat([torch.arange(count), torch.arange(50, 80)])
    function = fit_beyond(x[rows], targets[rows], own[rows], beyond=10.0, generator=torch.Generator().manual_seed(1))
    assert torch.allclose(function(x[:count]), targets[:count], atol=0.06 * float(targets[:count].abs().max()))


def test_where_no_frame_is_the_users_all_are_smoothed() -> None:
    x, targets, _ = users_and_range()
    none = torch.zeros(len(x), dtype=torch.bool)
    mean = targets.mean(0)
    found = fit_beyond(x, targets, none, beyond=10.0, generator=torch.Generator().manual_seed(1))(x) - mean
    size = targets.norm(dim=1)
    noise = 10 * (size / size.square().mean().sqrt()).clamp(min=LEAST)
    around = fit_smoother(x, targets - mean, generator=torch.Generator(), noise=noise)(x)
    assert torch.allclose(found, around, atol=1e-5)
    assert 0 < found.square().sum() < 0.2 * (targets - mean).square().sum()


def test_values_go_through_a_matrix() -> None:
    x, targets, own = users_and_range()
    function = fit_beyond(x, targets, own, beyond=10.0, generator=torch.Generator().manual_seed(1))
    matrix = torch.tensor([[1.0, 2.0, 0.0], [0.0, -1.0, 3.0]])
    assert torch.allclose(Through(function, matrix)(x), function(x) @ matrix, atol=1e-3)
