"""Removes invisible variation from a branch: whole channels, and single blendshapes of the others.

A blendshape below what is visible is rounding of the recording. Training its coefficient like any other would let the
MLP's weights grow without bound as its texels shrink.
"""

import torch
from torch import Tensor

from mua.channels import COARSE_TEXELS, FINE_TEXELS
from mua.student.model import Branch

LEVEL_GAINS = (COARSE_TEXELS, COARSE_TEXELS, FINE_TEXELS)  # of LL, D3, D2 over texels: a level doubles constants


@torch.no_grad()
def freeze_channels(
    branch: Branch,
    flat: Tensor,  # [F, M] coefficients, changed in place
    still: Tensor,  # [C] bool
) -> None:
    """Set blendshapes and coefficients of channels to zero; they get no gradient then, and stay at their mean."""
    branch.silence(still)
    for level in branch.split(flat):
        level[:, still] = 0


@torch.no_grad()
def drop_negligible(
    branch: Branch,
    flat: Tensor,  # [F, M] coefficients, changed in place
    least: Tensor,  # [C] that a channel has to vary by to be seen
) -> None:
    """Set to zero the blendshapes that visibly change no texel of any frame, and their coefficients."""
    for level, peak, gain, basis in zip(branch.split(flat), _peaks(branch), LEVEL_GAINS, _bases(branch), strict=True):
        negligible = level.abs().amax(0) * peak < gain * least[:, None]  # [C, R]
        level[:, negligible] = 0
        for own in basis:
            own[negligible] = 0


def _peaks(branch: Branch) -> tuple[Tensor, ...]:
    """The largest sample of every blendshape [C, R] of LL, D3, D2."""
    details = ((detail.h.abs().amax(-1) * detail.w.abs().amax(-1)).amax(0) for detail in (branch.d3, branch.d2))
    return branch.ll_basis.abs().amax((2, 3)), *details


def _bases(branch: Branch) -> tuple[tuple[Tensor, ...], ...]:
    """Views of the blendshapes [C, R, ...] of LL, D3, D2; a detail level has those of three bands, as factors."""
    return (branch.ll_basis,), *((*detail.h, *detail.w) for detail in (branch.d3, branch.d2))
