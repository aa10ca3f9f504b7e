"""Closed-form blendshapes: truncated SVD for LL, coupled CP by alternating least squares for the detail bands.

Everything works on one channel at a time, so that memory does not depend on the number of channels.
CP by alternating least squares: Kolda and Bader 2009, https://doi.org/10.1137/07070111X; its momentum: Mitchell, Ye and
De Sterck 2020, https://doi.org/10.1002/nla.2297; the subspace iteration behind the SVD: Halko, Martinsson and Tropp
2011, https://doi.org/10.1137/090771806.
"""

import math
from dataclasses import dataclass

import torch
from torch import Tensor

OVERSAMPLING = 16
POWER_ITERATIONS = 3
COMPRESSING = 1  # of these where an approximation follows whose error is twenty times as large
PROXIMAL = 1e-5  # weight of the previous factor in an update, relative to the Gram matrix's mean diagonal


@dataclass(frozen=True, eq=False)
class Blendshapes:
    """A linear model of one channel of LL: samples = coefficients @ basis, coefficients of unit variance."""

    coefficients: Tensor  # [F, R]
    basis: Tensor  # [R, P]


@dataclass(frozen=True, eq=False)
class Factors:
    """A coupled CP model of the three detail bands of one channel: X[f, s] = sum_r a[f, r] h[s, r] (x) w[s, r]."""

    coefficients: Tensor  # [F, R]
    h: Tensor  # [3, R, n]
    w: Tensor  # [3, R, n]

    def basis(self) -> Tensor:
        """The blendshapes [R, 3 n n] that the factors stand for."""
        return torch.einsum("sri,srj->rsij", self.h, self.w).flatten(1)


def frame_weights(
    frames: Tensor,  # [F, ...]
    weights: Tensor | None,  # [F] weight of each frame; None: equal
) -> Tensor:
    """The weights [F] with a mean of one."""
    if weights is None:
        return torch.ones(len(frames), dtype=frames.dtype, device=frames.device)
    return (weights / weights.mean()).to(frames)


def truncated_svd(
    x: Tensor,  # [F, P]
    rank: int,
    *,
    generator: torch.Generator,
    iterations: int = POWER_ITERATIONS,
) -> tuple[Tensor, Tensor, Tensor]:
    """The leading K = min(rank, F, P) singular triplets u [F, K], s [K], v [K, P], by subspace iteration."""
    probe = torch.randn(x.shape[1], min(rank + OVERSAMPLING, *x.shape), generator=generator).to(x)
    span = torch.linalg.qr(x @ probe).Q
    for _ in range(iterations):
        span = torch.linalg.qr(x @ torch.linalg.qr(x.T @ span).Q).Q
    u, s, v = torch.linalg.svd(span.T @ x, full_matrices=False)
    keep = min(rank, *x.shape)
    return span @ u[:, :keep], s[:keep], v[:keep]


def blendshapes(
    x: Tensor,  # [F, P] samples about their mean
    rank: int,
    *,
    generator: torch.Generator,
    worth: Tensor | None = None,  # [P], above zero: weight of each sample's error; None: equal
) -> Blendshapes:
    """The best linear blendshapes of a channel; with fewer frames or samples than `rank`, the rest is zero."""
    u, s, v = truncated_svd(x if worth is None else x * worth, rank, generator=generator)
    spread = len(x) ** 0.5
    basis = v * (s / spread)[:, None]
    if worth is not None:
        basis = basis / worth
    coefficients = torch.nn.functional.pad(u * spread, (0, rank - len(s)))
    return Blendshapes(coefficients, torch.nn.functional.pad(basis, (0, 0, 0, rank - len(s))))


def separable_blendshapes(
    x: Tensor,  # [F, 3, n, n] samples about their mean
    rank: int,
    *,
    sweeps: int,
    generator: torch.Generator,
    worth: Tensor | None = None,  # [n, n], above zero: weight of each sample's error; None: equal
) -> Factors:
    """Separable blendshapes of the three bands of a channel by `sweeps` rounds of alternating least squares.

    A model of rank R spans at most R directions over frames, so the sweeps run on the leading 2 R of them, which is
    several times cheaper.
    """
    u, s, v = truncated_svd(
        (x if worth is None else x * worth).flatten(1), 2 * rank, generator=generator, iterations=COMPRESSING
    )
    compressed = (s[:, None] * v).unflatten(1, x.shape[1:])
    if worth is not None:
        compressed = compressed / worth
    factors = alternate(compressed, start_from_modes(compressed, rank), sweeps=sweeps, worth=worth)
    coefficients = u @ factors.coefficients
    return _balance(Factors(coefficients, factors.h, factors.w))


def start_from_modes(
    modes: Tensor,  # [K, 3, n, n] orthogonal modes, largest first
    rank: int,
) -> Factors:
    """Split every mode into separable terms by an SVD per band and keep the `rank` terms of most energy.

    Term p of a mode takes the p-th singular pair of each band, as the bands share one coefficient.
    """
    u, s, v = torch.linalg.svd(modes)
    energy = s.square().sum(1)  # [K, n]
    best = energy.flatten().topk(min(rank, energy.numel())).indices
    mode, term = best // energy.shape[1], best % energy.shape[1]
    root = s[mode, :, term].sqrt()[..., None]  # [R, 3, 1]
    h = (u[mode, :, :, term] * root).transpose(0, 1)
    w = (v[mode, :, term, :] * root).transpose(0, 1)
    missing = rank - len(best)
    coefficients = (torch.arange(len(modes), device=mode.device)[:, None] == mode).to(modes)
    return Factors(_pad(coefficients, 1, missing), _pad(h, 1, missing), _pad(w, 1, missing))


def alternate(
    x: Tensor,  # [F, 3, n, n]
    factors: Factors,
    *,
    sweeps: int,
    worth: Tensor | None = None,  # [n, n]
) -> Factors:
    """Rounds of alternating least squares with momentum: each starts ahead of where the last one ended.

    A round that raises the error is dropped, and the momentum begins anew.
    """
    previous, least, run = factors, math.inf, 0
    for _ in range(sweeps):
        swept = sweep(x, _ahead(factors, previous, run / (run + 3)), worth)
        error = _misfit(x, swept, worth)
        if run and error > least:
            run = 0
        else:
            previous, factors, least, run = factors, swept, error, run + 1
    return factors


def _ahead(factors: Factors, previous: Factors, momentum: float) -> Factors:
    """The factors moved on by a part of the last step."""
    pairs = zip(vars(factors).values(), vars(previous).values(), strict=True)
    return Factors(*(own + momentum * (own - before) for own, before in pairs))


def _misfit(x: Tensor, factors: Factors, worth: Tensor | None) -> float:
    """The sum of squares that a model leaves of `x` [F, 3, n, n]."""
    left = x.flatten(1) - factors.coefficients @ factors.basis()
    return float((left if worth is None else left.unflatten(1, x.shape[1:]) * worth).square().sum())


def sweep(
    x: Tensor,  # [F, 3, n, n]
    factors: Factors,
    worth: Tensor | None = None,  # [n, n]
) -> Factors:
    """One round of alternating least squares: coefficients, then rows, then columns; the error never rises."""
    a = fit_coefficients(x, factors, worth)
    y = torch.einsum("fr,fp->rp", a, x.flatten(1)).unflatten(1, x.shape[1:])
    gram = _gram(a.T)
    h = _fit_lines(y, factors.w, factors.h, gram=gram, worth=worth)
    w = _fit_lines(y.mT, h, factors.w, gram=gram, worth=None if worth is None else worth.T)
    return _balance(Factors(a, h, w))


def fit_coefficients(
    x: Tensor,  # [F, 3, n, n]
    factors: Factors,
    worth: Tensor | None = None,  # [n, n]
) -> Tensor:
    """The coefficients [F, R] that fit `x` best for given rows and columns."""
    if worth is None:
        right = factors.basis() @ x.flatten(1).T
        return _update(right, (_gram(factors.h) * _gram(factors.w)).sum(0), factors.coefficients.T).T
    basis = (factors.basis().unflatten(1, x.shape[1:]) * worth).flatten(1)
    return _update(basis @ (x * worth).flatten(1).T, _gram(basis), factors.coefficients.T).T


def _fit_lines(
    y: Tensor,  # [R, 3, n, n] samples times coefficients, summed over frames
    across: Tensor,  # [3, R, n] the factors along the last axis of `y`
    previous: Tensor,  # [3, R, n]
    *,
    gram: Tensor,  # [R, R] of the coefficients
    worth: Tensor | None,  # [n, n]
) -> Tensor:
    """The factors [3, R, n] along the last axis of `y` but one. Where samples differ in worth, so do lines."""
    if worth is None:
        return _update(torch.einsum("rsij,srj->sri", y, across), gram * _gram(across), previous)
    squares = worth.double().square()
    right = torch.einsum("rsij,srj->sir", y * squares.to(y), across)[..., None]
    grams = gram * torch.einsum("ij,srj,sqj->sirq", squares, across.double(), across.double())
    return _update(right, grams, previous.mT[..., None])[..., 0].mT


def _gram(rows: Tensor) -> Tensor:
    """Inner products of rows [..., R, n] in double precision: their eigenvalues span more than single holds."""
    rows = rows.double()
    return rows @ rows.transpose(-1, -2)


def _update(
    right: Tensor,  # [..., R, M]
    gram: Tensor,  # [..., R, R] double; overwritten, because one for each line of samples is large
    previous: Tensor,  # [..., R, M]
) -> Tensor:
    """Solve gram x = right, held to `previous` by a proximal term: well-posed for any rank, still a descent step."""
    diagonal = gram.diagonal(dim1=-2, dim2=-1)
    pull = PROXIMAL * diagonal.mean(-1, keepdim=True) + torch.finfo(gram.dtype).tiny
    diagonal.add_(pull)
    factor = torch.linalg.cholesky(gram)
    return torch.cholesky_solve(right + pull[..., None] * previous, factor).to(right)


def _balance(factors: Factors) -> Factors:
    """Give every term coefficients of unit variance and rows and columns of equal length; the product stays."""
    tiny = torch.finfo(factors.h.dtype).tiny
    spread = factors.coefficients.square().mean(0).sqrt()
    rows, columns = (f.square().sum((0, 2)).sqrt() for f in (factors.h, factors.w))
    length = (spread * rows * columns).sqrt()
    safe = [torch.where(size > tiny, size, torch.ones_like(size)) for size in (spread, rows, columns)]
    return Factors(
        factors.coefficients / safe[0],
        factors.h * (length / safe[1])[:, None],
        factors.w * (length / safe[2])[:, None],
    )


def _pad(x: Tensor, dim: int, count: int) -> Tensor:
    shape = list(x.shape)
    shape[dim] = count
    return torch.cat([x, x.new_zeros(shape)], dim=dim)
