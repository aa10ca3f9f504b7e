"""Targets of the coefficient MLPs: the joint principal directions of all blendshape coefficients of a branch.

Coefficients are first expressed so that a squared error in them is the squared error in the texture that they stand
for; the few hundred directions that matter are regressed, and the linear map back is folded into the MLP's last layer.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import torch
from torch import Tensor

from mua.channels import ATTRIBUTES
from mua.student.factorize import frame_weights, truncated_svd
from mua.student.model import Branch, outer_products

# Smaller variation is invisible, in each attribute's unit (metres on a person, quaternion, log scale, logit, SH).
LEAST_SPREAD = {"offset": 1e-5, "rotation": 1e-4, "scale": 1e-4, "opacity": 1e-3, "SH": 1e-4}
GRAM_RIDGE = 1e-6
ROUNDING = 2.0**-12  # rounding of a recording's half-precision differences; directions of less variance are noise


@dataclass(frozen=True, eq=False)
class Targets:
    """F frames of K joint coordinates; coefficients = coordinates @ expand."""

    coordinates: Tensor  # [F, K] in units of the weighted texture
    expand: Tensor  # [K, M]


def channel_weights(
    variance: Tensor,  # [C] over training frames and texels
    channels: slice,  # the branch's channels among the 23
    *,
    size: float = 1.0,  # size of the figure over that of a person
) -> Tensor:
    """The weight [C] of each channel's error: one over the spread of its attribute.

    The channels of an attribute share a unit, hence a weight; attributes come to count alike. The paper's loss over raw
    channels would all but ignore offsets, which are metres beside logits.
    """
    weights, least = torch.empty_like(variance), least_spread(channels, size=size).to(variance)
    for _, own in _attributes(channels):
        weights[own] = 1 / variance[own].mean().sqrt().maximum(least[own])
    return weights


def still_channels(
    variance: Tensor,  # [C] over training frames and texels
    channels: slice,  # the branch's channels among the 23
    *,
    size: float = 1.0,  # size of the figure over that of a person
) -> Tensor:
    """Channels [C] that hardly vary, whose blendshapes would hold only rounding."""
    return variance.sqrt() < least_spread(channels, size=size).to(variance)


def least_spread(
    channels: slice,  # the branch's channels among the 23
    *,
    size: float = 1.0,  # size of the figure over that of a person
) -> Tensor:
    """The least visible variation of each channel [C], in its own unit."""
    least = torch.empty(channels.stop - channels.start)
    for name, own in _attributes(channels):
        least[own] = LEAST_SPREAD[name] * (size if name == "offset" else 1.0)
    return least


def _attributes(channels: slice) -> Iterator[tuple[str, slice]]:
    """The attributes that lie within `channels`, and where in it."""
    for name, where in ATTRIBUTES.items():
        if channels.start <= where.start and where.stop <= channels.stop:
            yield name, slice(where.start - channels.start, where.stop - channels.start)


@torch.no_grad()
def joint_targets(
    branch: Branch,
    flat: Tensor,  # [F, M] coefficients
    weights: Tensor,  # [C]
    *,
    rank: int,
    generator: torch.Generator,
    frames: Tensor | None = None,  # [F] how much each frame counts
) -> Targets:
    """The leading `rank` joint directions of a branch's coefficients, by their worth in the weighted texture.

    Fewer where the rest is below the rounding of what was recorded.
    """
    bases = (
        branch.ll_basis.flatten(2),
        outer_products(branch.d3.h, branch.d3.w),
        outer_products(branch.d2.h, branch.d2.w),
    )
    alphas = branch.split(flat)
    roots = [_root(basis, weights) for basis in bases]
    worth = [torch.einsum("fcr,crk->fck", alpha, root.to(alpha)) for alpha, root in zip(alphas, roots, strict=True)]
    roots_of_weights = frame_weights(flat, frames).sqrt()[:, None]
    together = torch.cat([level.flatten(1) for level in worth], dim=1)
    u, s, v = truncated_svd(together * roots_of_weights, rank, generator=generator)
    kept = max(int((s > ROUNDING * s[0]).sum()), 1)
    u, s, v = u[:, :kept], s[:kept], v[:kept]
    parts = branch.split(v)
    expand = [
        torch.linalg.solve_triangular(root, part.transpose(0, 1).double(), upper=False, left=False).transpose(0, 1)
        for root, part in zip(roots, parts, strict=True)
    ]
    return Targets(u * s / roots_of_weights, torch.cat([part.flatten(1) for part in expand], dim=1).to(u))


def _root(
    basis: Tensor,  # [C, R, P]
    weights: Tensor,  # [C]
) -> Tensor:
    """The Cholesky roots L [C, R, R], double, of the weighted Gram matrices: |alpha L| is the norm of alpha's texture.

    A ridge keeps them invertible where terms are alike; a channel without blendshapes gets the identity.
    """
    weighted = (basis * weights[:, None, None]).double()
    gram = weighted @ weighted.transpose(1, 2)
    size = gram.diagonal(dim1=1, dim2=2).mean(1)
    ridge = torch.where(size > 0, GRAM_RIDGE * size, 1)
    return torch.linalg.cholesky(gram + ridge[:, None, None] * torch.eye(gram.shape[1]).to(gram))
