"""Batched 2-D discrete wavelet transforms in torch: PyWavelets' mode `periodization`, which halves even sizes exactly.

Along one axis of length n a level of the transform is linear and periodic, so it is a product with an [n, n] matrix
whose rows are shifted filters. The matrices are built once and cached: at texture sizes a dense product is several
times faster than a strided convolution on a CPU, runs on any device and dtype, and composes (two low-pass levels are
one matrix).
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from mua.arrays import Array
from mua.channels import DYNAMIC_LEVELS, STATIC_LEVELS
from mua.errors import InputError
from mua.filters import filters


class Bands(NamedTuple):
    """The subbands of F frames that vary with the frame; detail bands in the order of pywt's (cH, cV, cD)."""

    ll: Tensor  # [F, C, n, n]
    d3: Tensor  # [F, 3, C, n, n]
    d2: Tensor  # [F, 3, C, 2n, 2n]

    def of(self, channels: slice) -> "Bands":
        """Subbands of some of the channels."""
        return Bands(self.ll[:, channels], self.d3[:, :, channels], self.d2[:, :, channels])


def wavedec2(
    x: Tensor,  # [..., H, W]
    wavelet: str,
    levels: int,
) -> tuple[Tensor, list[Tensor]]:
    """Split images into the low-pass subband [..., H / 2^levels, W / 2^levels] and the detail levels, coarse first.

    A detail level is [..., 3, h, w] in the order (cH, cV, cD) of pywt: high-pass along H, along W, along both.
    Raises InputError where H or W cannot be halved `levels` times.
    """
    _check_divisible(x, levels)
    details: list[Tensor] = []
    for _ in range(levels):
        h, w = x.shape[-2] // 2, x.shape[-1] // 2
        y = _both_axes(x, _analysis_matrix(wavelet, 2 * h), _analysis_matrix(wavelet, 2 * w))
        details.append(torch.stack([y[..., h:, :w], y[..., :h, w:], y[..., h:, w:]], dim=-3))
        x = y[..., :h, :w]
    return x, details[::-1]


def dynamic_subbands(
    x: Tensor,  # [..., C, H, W]
    wavelet: str,
) -> Bands:
    """The subbands of textures that vary with the frame; a texture alone has no leading axes."""
    ll, details = wavedec2(analyse_lowpass(x, wavelet, STATIC_LEVELS), wavelet, DYNAMIC_LEVELS)
    return Bands(ll, *(level.transpose(-4, -3).contiguous() for level in details))


def waverec2(
    ll: Tensor,  # [..., h, w] low-pass subband
    details: Sequence[Tensor],  # coarse first, each [..., 3, h, w], h and w doubling from one to the next
    wavelet: str,
) -> Tensor:
    """Rebuild images [..., H, W] from the subbands of `wavedec2`; the inverse of it.

    Raises InputError where a detail level does not have the size of the image built up to it.
    """
    for level in details:
        if level.shape[-3:] != (3, *ll.shape[-2:]):
            raise InputError(
                f"waverec2: a detail level has shape {tuple(level.shape)}, "
                f"expected [..., 3, {ll.shape[-2]}, {ll.shape[-1]}]"
            )
        rows, columns = ll.shape[-2:]
        horizontal, vertical, diagonal = level.unbind(-3)
        top, bottom = torch.cat([ll, vertical], dim=-1), torch.cat([horizontal, diagonal], dim=-1)
        quadrants = torch.cat([top, bottom], dim=-2)
        ll = _both_axes(quadrants, _synthesis_matrix(wavelet, 2 * rows), _synthesis_matrix(wavelet, 2 * columns))
    return ll


def analyse_lowpass(
    x: Tensor,  # [..., H, W]
    wavelet: str,
    levels: int,
) -> Tensor:
    """The low-pass subband [..., H / 2^levels, W / 2^levels] alone: what `wavedec2` returns first, without the details.

    Raises InputError where H or W cannot be halved `levels` times.
    """
    _check_divisible(x, levels)
    rows, columns = x.shape[-2:]
    return _both_axes(
        x, _lowpass_analysis_matrix(wavelet, rows, levels), _lowpass_analysis_matrix(wavelet, columns, levels)
    )


def synthesise_lowpass(
    ll: Tensor,  # [..., h, w]
    wavelet: str,
    levels: int,
) -> Tensor:
    """The images [..., h 2^levels, w 2^levels] of a low-pass subband whose details of `levels` levels are all zero."""
    rows, columns = ll.shape[-2:]
    return _both_axes(
        ll, _lowpass_synthesis_matrix(wavelet, rows, levels), _lowpass_synthesis_matrix(wavelet, columns, levels)
    )


def lines_of_texture(wavelet: str, n: int, levels: int) -> tuple[Array, Array]:
    """What n low-pass and n high-pass samples each add, along one axis, to n 2^levels texels: two [n 2^levels, n]."""
    first = _synthesis_matrix(wavelet, 2 * n)
    lines = _lowpass_synthesis_matrix(wavelet, 2 * n, levels - 1) @ first
    return lines[:, :n], lines[:, n:]


def _both_axes(
    x: Tensor,  # [..., H, W]
    rows: Array,  # [H', H]
    columns: Array,  # [W', W]
) -> Tensor:
    """The images [..., H', W'] of a separable linear map."""
    left = torch.as_tensor(rows, dtype=x.dtype, device=x.device)
    right = torch.as_tensor(columns, dtype=x.dtype, device=x.device)
    return left @ (x @ right.T)


def _check_divisible(x: Tensor, levels: int) -> None:
    rows, columns = x.shape[-2:]
    if rows % 2**levels or columns % 2**levels:
        raise InputError(
            f"wavelet transform: size {rows} x {columns} cannot be halved {levels} times, "
            f"expected multiples of {2**levels}"
        )


@lru_cache(maxsize=64)
def _analysis_matrix(wavelet: str, n: int) -> Array:
    """[n, n] float64: n / 2 low-pass rows, then as many high-pass; row o of taps f is sum_j f[j] x[2 o + L / 2 - j]."""
    bank = filters(wavelet)
    if bank.dec_lo is None or bank.dec_hi is None:
        return np.linalg.inv(_synthesis_matrix(wavelet, n))
    matrix, length = np.zeros((n, n)), len(bank.dec_lo)
    output, tap = np.meshgrid(np.arange(n // 2), np.arange(length), indexing="ij")
    source = (2 * output + length // 2 - tap) % n
    np.add.at(matrix, (output, source), bank.dec_lo[tap])
    np.add.at(matrix, (output + n // 2, source), bank.dec_hi[tap])
    return matrix


@lru_cache(maxsize=64)
def _synthesis_matrix(wavelet: str, n: int) -> Array:
    """[n, n] float64, the inverse of the analysis: coefficient o adds r[k] to output 2 o + k + 1 - L / 2."""
    bank = filters(wavelet)
    matrix, length = np.zeros((n, n)), len(bank.rec_lo)
    coefficient, tap = np.meshgrid(np.arange(n // 2), np.arange(length), indexing="ij")
    target = (2 * coefficient + tap + 1 - length // 2) % n
    np.add.at(matrix, (target, coefficient), bank.rec_lo[tap])
    np.add.at(matrix, (target, coefficient + n // 2), bank.rec_hi[tap])
    return matrix


@lru_cache(maxsize=64)
def _lowpass_analysis_matrix(wavelet: str, n: int, levels: int) -> Array:
    """[n / 2^levels, n] float64: the low-pass halves of `levels` analysis steps as one product."""
    matrix = np.eye(n)
    for level in range(levels):
        size = n >> level
        matrix = _analysis_matrix(wavelet, size)[: size // 2] @ matrix
    return matrix


@lru_cache(maxsize=64)
def _lowpass_synthesis_matrix(wavelet: str, n: int, levels: int) -> Array:
    """[n 2^levels, n] float64: the low-pass halves of `levels` synthesis steps as one product."""
    matrix = np.eye(n)
    for level in range(levels):
        size = n << level
        matrix = _synthesis_matrix(wavelet, 2 * size)[:, :size] @ matrix
    return matrix
