"""Kernel ridge regression: the smooth function of the descriptor that the coefficient MLPs are taught.

An MLP trained on the frames alone fits them and little between them. A wide Gaussian kernel, solved in closed form,
carries over to unseen motion far better; the MLP learns its values at points around the frames, as many as it takes.
Nystrom's approximation over some of the frames bounds the cost (Williams and Seeger 2001,
https://papers.nips.cc/paper/1866-using-the-nystrom-method-to-speed-up-kernel-machines).
"""

from dataclasses import dataclass

import torch
from torch import Tensor

CENTRES = 2048  # frames that the function is spanned by
WIDTH = 3.0  # squared width of the kernel relative to the mean squared distance between frames
RIDGE = 3e-3  # noise variance that a frame's value is granted, relative to the function's own
RANK_FLOOR = 1e-12  # of the kernel matrix's largest eigenvalue: what lies below is rounding


@dataclass(frozen=True, eq=False)
class Smoother:
    """f(x) = kernel(x, centres) @ values."""

    centres: Tensor  # [M, D]
    values: Tensor  # [M, K]
    width: float

    def __call__(self, x: Tensor) -> Tensor:
        """The function's values [F, K] at points [F, D]."""
        return _kernel(x, self.centres, self.width) @ self.values


def fit_smoother(
    x: Tensor,  # [F, D]
    targets: Tensor,  # [F, K]
    *,
    generator: torch.Generator,
    weights: Tensor | None = None,  # [F] how much each frame counts, by default 1: its noise is RIDGE over that
) -> Smoother:
    """The smooth function that comes near `targets` at `x`."""
    weights = torch.ones_like(x[:, 0]) if weights is None else weights
    chosen = torch.randperm(len(x), generator=generator)[:CENTRES].sort().values.to(x.device)
    centres = x[chosen]
    distance = float(2 * (x - x.mean(0)).square().sum(1).mean())
    width = WIDTH * distance if distance > 0 else 1.0
    kernel = _kernel(centres, centres, width).double()
    if len(centres) == len(x):  # no approximation
        system = kernel + torch.diag(RIDGE / weights[chosen].double())
        solved = torch.cholesky_solve(targets[chosen].double(), torch.linalg.cholesky(system))
        return Smoother(centres, solved.to(targets), width)
    values, vectors = torch.linalg.eigh(kernel)
    kept = values > RANK_FLOOR * values[-1]
    features = vectors[:, kept] / values[kept].sqrt()
    seen = _kernel(x, centres, width).double() @ features
    weighted = seen.T * weights.double()
    system = weighted @ seen + RIDGE * torch.eye(seen.shape[1], dtype=seen.dtype, device=seen.device)
    solved = features @ torch.linalg.solve(system, weighted @ targets.double())
    return Smoother(centres, solved.to(targets), width)


@dataclass(frozen=True, eq=False)
class Sum:
    """f(x) = sum_p smoother_p(x @ turns[p])."""

    turns: tuple[Tensor, ...]  # [D, D'] each
    smoothers: tuple[Smoother, ...]

    def __call__(self, x: Tensor) -> Tensor:
        """The function's values [F, K] at points [F, D]."""
        total = x.new_zeros(len(x), self.smoothers[0].values.shape[1])
        for turn, one in zip(self.turns, self.smoothers, strict=True):
            total.addmm_(_kernel(x @ turn, one.centres, one.width), one.values)
        return total


def _kernel(a: Tensor, b: Tensor, width: float) -> Tensor:
    return torch.cdist(a, b).square_().div_(-width).exp_()  # in place: this is where a lesson's time goes
