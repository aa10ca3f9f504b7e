"""Filter taps, and the bound of an upsampled texel."""

import numpy as np
import pywt

from mua.arrays import Array


def taps(name: str) -> tuple[Array, Array]:
    wavelet = pywt.Wavelet(name)
    return np.array(wavelet.rec_lo), np.array(wavelet.rec_hi)


def upsampling_bound(filtered: Array, largest: float, offset: float) -> float:
    """What the shader may lose: taps rounded once, and a sum of `reach` products rounded along each of two axes."""
    gain = np.abs(filtered).sum(axis=0).max() ** 2
    return float(np.finfo(np.float32).eps * (2 * (len(filtered) + 2) * gain * largest + offset))
