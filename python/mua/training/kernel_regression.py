"""Kernel ridge regression: the smooth function of the descriptor that the coefficient MLPs are fitted to.

An MLP trained on the frames alone fits them and little between them. A wide Gaussian kernel, solved in closed form,
carries over to unseen motion far better; the MLP is fitted to its values at points around the frames, as many as it
needs. Nystrom's approximation over some of the frames bounds the cost (Williams and Seeger 2001,
https://papers.nips.cc/paper/1866-using-the-nystrom-method-to-speed-up-kernel-machines).
"""

import functools
import math
from dataclasses import dataclass, replace
from typing import Protocol

import torch
from torch import Tensor

CENTRES = 2048  # frames that span the function
WIDTH = 3.0  # squared width of the kernel relative to the mean squared distance between frames
RIDGE = 3e-3  # noise variance of a frame's value, relative to the function's own
LEAST = 0.2  # share of it for a frame near the mean; distant frames say less about other motion
RANK_FLOOR = 1e-12  # share of the kernel matrix's largest eigenvalue; smaller ones are rounding


class Smooth(Protocol):
    """A function of points [F, D]."""

    def __call__(self, x: Tensor) -> Tensor:
        """The values [F, K]."""


@dataclass(frozen=True, eq=False)
class Smoother:
    """f(x) = kernel(x, centres) @ values; far from the centres less, where it has a reach."""

    centres: Tensor  # [M, D]
    values: Tensor  # [M, K]
    width: float
    reach: float = math.inf  # squared distance from the nearest centre at which the function has faded to 1 / e

    def __call__(self, x: Tensor) -> Tensor:
        return self.at(_exponents(x, self.centres, self.width))

    def at(
        self,
        exponents: Tensor,  # [F, M] of the kernel; overwritten
    ) -> Tensor:
        """The values [F, K] at points that are so far from the centres."""
        trust = None if math.isinf(self.reach) else (exponents.amax(1) * (self.width / self.reach)).exp_()
        values = exponents.exp_() @ self.values
        return values if trust is None else values.mul_(trust[:, None])


@dataclass(frozen=True, eq=False)
class Constant:
    """Constant values at every point."""

    values: Tensor  # [K]

    def __call__(self, x: Tensor) -> Tensor:
        return self.values.repeat(len(x), 1)


@dataclass(frozen=True, eq=False)
class Through:
    """A function whose values are multiplied by a matrix."""

    function: Smooth
    matrix: Tensor  # [K, K']

    def __call__(self, x: Tensor) -> Tensor:
        return self.function(x) @ self.matrix


@dataclass(frozen=True, eq=False)
class Nested:
    """The sum of a function and a narrower one that fades; distances are computed for both at once."""

    wide: Smoother
    narrow: Smoother  # its centres are the first of the wide one's

    def __call__(self, x: Tensor) -> Tensor:
        wide, narrow = self.wide, self.narrow
        exponents = _exponents(x, wide.centres, wide.width)
        nearer = exponents[:, : len(narrow.centres)] * (wide.width / narrow.width)
        return wide.at(exponents).add_(narrow.at(nearer))


@dataclass(frozen=True, eq=False)
class Sum:
    """The sum of functions, each of which may see the points transformed."""

    terms: tuple[Smooth, ...]
    turns: tuple[Tensor, ...] | None = None  # [D, D'] each

    def __call__(self, x: Tensor) -> Tensor:
        turns = self.turns or (None,) * len(self.terms)
        parts = (term(x if turn is None else x @ turn) for term, turn in zip(self.terms, turns, strict=True))
        return functools.reduce(Tensor.add_, parts)


def fit_smoother(
    x: Tensor,  # [F, D]
    targets: Tensor,  # [F, K]
    *,
    generator: torch.Generator,
    noise: Tensor | float = RIDGE,  # [F] noise variance of each frame's value, or one for all
    width: float | None = None,  # squared width of the kernel; None: from the frames
) -> Smoother:
    """The smooth function that approximates `targets` at `x`."""
    noise = torch.as_tensor(noise, dtype=x.dtype, device=x.device).expand(len(x))
    chosen = torch.randperm(len(x), generator=generator)[:CENTRES].sort().values.to(x.device)
    centres = x[chosen]
    width = width or WIDTH * spread(x) or 1.0
    kernel = _kernel(centres, centres, width).double()
    if len(centres) == len(x):  # no approximation
        kernel.diagonal().add_(noise[chosen])
        solved = torch.cholesky_solve(targets[chosen].double(), torch.linalg.cholesky(kernel))
        return Smoother(centres, solved.to(targets), width)
    values, vectors = torch.linalg.eigh(kernel)
    kept = values > RANK_FLOOR * values[-1]
    features = vectors[:, kept] / values[kept].sqrt()
    seen = _kernel(x, centres, width).double() @ features
    weighted = seen.T / noise.double()
    system = weighted @ seen + torch.eye(seen.shape[1], dtype=seen.dtype, device=seen.device)
    solved = features @ torch.linalg.solve(system, weighted @ targets.double())
    return Smoother(centres, solved.to(targets), width)


def fit_beyond(
    x: Tensor,  # [F, D]
    targets: Tensor,  # [F, K]
    own: Tensor,  # [F] bool, the frames of the user's motion
    *,
    beyond: float,  # noise variance of other frames' values
    generator: torch.Generator,
    ridge: float = RIDGE,  # noise variance of what the user's frames show besides
    fades: bool = True,  # whether it fades to the mean of the frames that are not the user's
    sizes: Tensor | None = None,  # [F] lengths of values that the targets are a part of; None: of the targets
) -> Sum:
    """A heavily smoothed function of all frames, plus the residual of the user's frames, which fades away from them.

    Far from all frames it is 0, the mean of the user's, or where `fades` is given the mean of the others: the mean of a
    walk is less like other motion. Where no frame is the user's, it is the smoothed function alone.
    """
    order = torch.argsort(own.int(), descending=True, stable=True)  # the user's first, as `Nested` has them
    x, targets, own = x[order], targets[order], own[order]
    size = targets.norm(dim=1) if sizes is None else sizes[order]
    relative = size / size[~own].square().mean().sqrt().clamp(min=torch.finfo(size.dtype).tiny)
    others = targets[~own] if fades else torch.zeros_like(targets[:1])
    mean = Constant(others.mean(0))
    around = fit_smoother(x, targets - mean.values, generator=generator, noise=beyond * relative.clamp(min=LEAST))
    common = Sum((mean, around))
    if not own.any():
        return common
    reach = spread(x[own]) or 1.0
    width = math.sqrt(around.width * WIDTH * reach)  # wide, yet not so wide that small motion is flat within it
    besides = fit_smoother(x[own], targets[own] - common(x[own]), generator=generator, noise=ridge, width=width)
    besides = replace(besides, reach=reach)
    if len(x) > CENTRES:
        return Sum((mean, Sum((around, besides))))
    besides = replace(besides, centres=around.centres[: len(besides.centres)])  # the same, but held once
    return Sum((mean, Nested(around, besides)))


def spread(x: Tensor) -> float:
    """The mean squared distance between points [F, D]."""
    return float(2 * (x - x.mean(0)).square().sum(1).mean())


def _kernel(a: Tensor, b: Tensor, width: float) -> Tensor:
    return _exponents(a, b, width).exp_()


def _exponents(a: Tensor, b: Tensor, width: float) -> Tensor:
    """The exponents -|a - b|^2 / width [A, B] in one product, as most of a regression's time goes here."""
    left = torch.cat([a, a.square().sum(1, keepdim=True), torch.ones_like(a[:, :1])], dim=1)
    right = torch.cat([2 * b, -torch.ones_like(b[:, :1]), -b.square().sum(1, keepdim=True)], dim=1)
    return (left @ (right / width).T).clamp_(max=0)
