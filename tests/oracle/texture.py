"""Networks, and the images that they blend: sections 4 and 5."""

import numpy as np
from oracle.file import Array, Record
from oracle.texels import Texels


def network(layers: list[Record], x: Array) -> Array:
    """4.1"""
    for layer in layers[:-1]:
        x = np.maximum(layer.weight @ x + layer.bias, 0)
    return np.asarray(layers[-1].weight @ x + layers[-1].bias)


def canonical_vertices(coarse: Record, x: Array) -> Array:
    """4.2: v [V, 3]."""
    return np.asarray(coarse.mean + np.tensordot(network(coarse.mlp, x), coarse.basis, axes=1))


def coefficients(branch: Record, x: Array) -> list[Array]:
    """4.3: alpha [C, R], then alpha_b [C, R_b] of each detail."""
    ranks = np.array([branch.ll_basis.shape[1]] + [band.h.shape[2] for band in branch.details])
    parts = np.split(network(branch.mlp, x), np.cumsum(len(branch.ll_mean) * ranks)[:-1])
    return [part.reshape(len(branch.ll_mean), -1) for part in parts]


def subbands(branch: Record, x: Array) -> tuple[Array, list[Array]]:
    """5.1: LL [C, n, n], then D_b [3, C, n 2^b, n 2^b] of each detail."""
    alpha, *alphas = coefficients(branch, x)
    bands = zip(branch.details, alphas, strict=True)
    details = [band.mean + np.einsum("cr,scri,scrj->scij", a, band.h, band.w) for band, a in bands]
    return branch.ll_mean + np.einsum("cr,crij->cij", alpha, branch.ll_basis), details


def up(taps: Array, samples: Array, axis: int) -> Array:
    """5.2, along an axis."""
    a = np.moveaxis(samples, axis, 0)
    result = np.zeros((2 * len(a), *a.shape[1:]))
    for q, tap in enumerate(taps):
        result[(2 * np.arange(len(a)) + q - len(taps) // 2 + 1) % len(result)] += tap * a
    return np.moveaxis(result, 0, axis)


def image(wavelet: Record, branch: Record, x: Array) -> Array:
    """5.2: A_levels [C, size, size]."""
    lo, hi = wavelet.rec_lo, wavelet.rec_hi
    a, details = subbands(branch, x)
    for level in range(wavelet.levels):
        a = up(lo, up(lo, a, 2), 1)
        if level < len(details):
            rows, columns, both = details[level]
            a = a + up(hi, up(lo, rows, 2), 1) + up(lo, up(hi, columns, 2), 1) + up(hi, up(hi, both, 2), 1)
    return a


def at_texels(avatar: Record, x: Array, texels: Texels, level: int) -> Array:
    """5.3: T [N, 23] at a level of detail, geometry first."""
    a = np.concatenate([image(avatar.wavelet, branch, x) for branch in (avatar.geometry, avatar.appearance)])
    for _ in range(level):  # 9.4
        a = (a[:, ::2, ::2] + a[:, ::2, 1::2] + a[:, 1::2, ::2] + a[:, 1::2, 1::2]) / 4
    return (a.reshape(len(a), -1)[:, texels.texels] + texels.static_offset).T
