"""The filters of wavelets by name: our own, and those of PyWavelets."""

from typing import NamedTuple

import numpy as np
import pywt

from mua.arrays import Array
from mua.errors import InputError

SPLINE = "spline3"  # quadratic splines
# The one of new recordings: its 4 taps hold more of a texture at a quarter of its size than the 10 of bior4.4
# (docs/research/ranks.md).
WAVELET = SPLINE


class Filters(NamedTuple):
    """Low-pass and high-pass taps of a wavelet; without those of its analysis, that is the inverse of its synthesis."""

    rec_lo: Array  # [L] float64, L even
    rec_hi: Array  # [L] float64
    dec_lo: Array | None = None  # [L] float64
    dec_hi: Array | None = None  # [L] float64


def filters(wavelet: str) -> Filters:
    """The filters of `spline3` or of a discrete wavelet of PyWavelets; raises InputError for any other name."""
    if wavelet == SPLINE:
        low = np.array([1.0, 3.0, 3.0, 1.0]) / np.sqrt(32)
        return Filters(low, low * [1, -1, 1, -1])  # orthogonal to all shifts of the low-pass filter by two
    if wavelet not in pywt.wavelist(kind="discrete"):
        raise InputError(
            f"wavelet: {wavelet!r} is unknown, expected {SPLINE!r} or one of PyWavelets' such as 'bior4.4'"
        )
    bank = pywt.Wavelet(wavelet)
    return Filters(*(np.array(taps) for taps in (bank.rec_lo, bank.rec_hi, bank.dec_lo, bank.dec_hi)))
