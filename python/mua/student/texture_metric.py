"""Subbands in units of the texture, so that bases which fit them best also do so in the texture.

Along either axis, the samples of a band are multiplied by the symmetric root of the Gram matrix of what each adds to a
texture. Bands count as orthogonal to each other. Of an orthogonal wavelet all roots are the identity.
"""

from functools import lru_cache

import numpy as np
import torch
from torch import Tensor

from mua.arrays import Array
from mua.channels import LEVELS
from mua.student.model import Branch, Detail
from mua.wavelets import Bands, lines_of_texture


def in_texture(bands: Bands, wavelet: str) -> Bands:
    """The subbands [F, C, ...] in units of the texture."""
    low, high = _roots(bands.ll, wavelet, LEVELS)
    fine_low, fine_high = _roots(bands.d2, wavelet, LEVELS - 1)
    return Bands(
        low @ bands.ll @ low,
        torch.stack([high, low, high])[:, None] @ bands.d3 @ torch.stack([low, high, high])[:, None],
        torch.stack([fine_high, fine_low, fine_high])[:, None]
        @ bands.d2
        @ torch.stack([fine_low, fine_high, fine_high])[:, None],
    )


@torch.no_grad()
def to_subbands(branch: Branch, channel: int, wavelet: str) -> None:
    """Turn one channel's means and bases, fitted in units of the texture, to those of the subbands."""
    low, high = (torch.linalg.inv(root) for root in _roots(branch.ll_mean, wavelet, LEVELS))
    branch.ll_mean[channel] = low @ branch.ll_mean[channel] @ low
    branch.ll_basis[channel] = low @ branch.ll_basis[channel] @ low
    _turn(branch.d3, channel, low, high)
    low, high = (torch.linalg.inv(root) for root in _roots(branch.d2.mean, wavelet, LEVELS - 1))
    _turn(branch.d2, channel, low, high)


def _turn(detail: Detail, channel: int, low: Tensor, high: Tensor) -> None:
    rows, columns = torch.stack([high, low, high]), torch.stack([low, high, high])
    detail.mean[:, channel] = rows @ detail.mean[:, channel] @ columns
    detail.h[:, channel] = detail.h[:, channel] @ rows
    detail.w[:, channel] = detail.w[:, channel] @ columns


def _roots(like: Tensor, wavelet: str, levels: int) -> tuple[Tensor, Tensor]:
    """The roots [n, n] of low-pass and high-pass lines of a band's size and device, `levels` above the texture."""
    low, high = (torch.from_numpy(root).to(like) for root in _computed(wavelet, like.shape[-1], levels))
    return low, high


@lru_cache(maxsize=16)
def _computed(wavelet: str, n: int, levels: int) -> tuple[Array, Array]:
    low, high = (_root(lines) for lines in lines_of_texture(wavelet, n, levels))
    return low, high


def _root(
    lines: Array,  # [n 2^levels, n] what a unit of each sample adds to a line of texels
) -> Array:
    values, vectors = np.linalg.eigh(lines.T @ lines)
    return np.asarray((vectors * np.sqrt(values)) @ vectors.T)
