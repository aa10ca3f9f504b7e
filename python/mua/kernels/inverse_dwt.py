"""One level of the periodised 2D wavelet synthesis, full or low-pass only, and the static offset at its end.

In one dimension x[m] = sum_k lo[m - 2k + L/2 - 1] a[k] + hi[m - 2k + L/2 - 1] d[k], indices of x modulo 2n: the phase
of PyWavelets' mode "periodization", where a[k] is centred on sample 2k and d[k] on 2k + 1.
"""

import numpy as np

from mua.arrays import Array


def inverse_dwt(
    ll: Array,  # [C, n, n]
    details: Array | None,  # [3, C, n, n] high-pass along rows' axis, along columns' axis, along both; None: zeros
    rec_lo: Array,  # [L], L even
    rec_hi: Array,  # [L]
) -> Array:
    """The next finer approximation [C, 2n, 2n]."""
    if details is None:
        return _upsample(_upsample(ll, rec_lo, 2), rec_lo, 1)
    along_rows, along_columns, along_both = details
    low = _upsample(ll, rec_lo, 2) + _upsample(along_columns, rec_hi, 2)
    high = _upsample(along_rows, rec_lo, 2) + _upsample(along_both, rec_hi, 2)
    return _upsample(low, rec_lo, 1) + _upsample(high, rec_hi, 1)


def add_static(
    fine: Array,  # [C, H, W]
    texels: Array,  # [N] row * W + column
    static_offset: Array,  # [C, N]
) -> Array:
    """The texture at the valid texels, [C, N], with the static offset of the finest levels."""
    rows, columns = np.divmod(texels, fine.shape[2])
    return np.asarray(fine[:, rows, columns] + static_offset)


def _upsample(
    band: Array,  # [C, p, q]
    taps: Array,  # [L]
    axis: int,  # 1 or 2
) -> Array:
    """Put zeros between the samples along `axis` and filter circularly, one output phase at a time."""
    shape = list(band.shape)
    shape[axis] *= 2
    fine = np.zeros(shape, dtype=band.dtype)
    phases = [fine[:, p::2] if axis == 1 else fine[:, :, p::2] for p in (0, 1)]
    centre = len(taps) // 2 - 1
    for t in np.flatnonzero(taps):
        step, phase = divmod(int(t) - centre, 2)
        phases[phase] += band.dtype.type(taps[t]) * np.roll(band, step, axis)
    return fine
