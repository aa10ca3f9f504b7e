"""Kernel ridge regression against the textbook's formula, in double precision."""

import numpy as np
import pytest
import torch
from scipy.spatial.distance import cdist

from mua.student import smoother
from mua.student.smoother import RIDGE, WIDTH, fit_smoother


def frames(count: int, dimensions: int = 4) -> tuple[torch.Tensor, torch.Tensor]:
    x = torch.randn(count, dimensions, generator=torch.Generator().manual_seed(0))
    return x, torch.stack([torch.tanh(x[:, 0]), x[:, 1] * x[:, 2]], dim=1)


def fitted(x: torch.Tensor, targets: torch.Tensor) -> smoother.Smoother:
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
    monkeypatch.setattr(smoother, "CENTRES", 100)
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
