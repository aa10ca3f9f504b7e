"""How large the numbers may become that a file decodes to: refused where single precision would not hold their squares.

Section 10.4 of schemas/README.md.
"""

import numpy as np

from mua.arrays import Array
from mua.asset.flatbuffer import FormatError
from mua.avatar.model import Branch, Coarse, Mlp, Wavelet
from mua.limits import MAGNITUDE
from mua.pose.encoding import Components


def require_bounded(components: Components, wavelet: Wavelet, coarse: Coarse, branches: dict[str, Branch]) -> None:
    """Raises FormatError with code `value` where a pose may lead to numbers beyond MAGNITUDE."""
    inputs = largest(components.ranges) + largest(components.margins)
    found = _network(coarse.mlp, inputs, "coarse.mlp")
    _require("coarse", largest(coarse.mean) + len(coarse.basis) * found * largest(coarse.basis))
    for name, branch in branches.items():
        _require(name, _texture(branch, wavelet, _network(branch.mlp, inputs, f"{name}.mlp")))


def largest(values: Array) -> float:
    """The largest magnitude; 0 of none."""
    return float(max(values.max(initial=0), -values.min(initial=0)))


def _network(mlp: Mlp, inputs: float, path: str) -> float:
    found = inputs
    for layer in mlp:
        rows = np.abs(layer.weight).sum(axis=1, dtype=np.float64)
        found = float(rows.max(initial=0)) * found + largest(layer.bias)
        _require(path, found)
    return found


def _texture(branch: Branch, wavelet: Wavelet, coefficient: float) -> float:
    low, high = (float(np.abs(taps).sum()) for taps in (wavelet.rec_lo, wavelet.rec_hi))
    found = largest(branch.ll_mean) + branch.ranks[0] * coefficient * largest(branch.ll_basis)
    for level in range(wavelet.levels):
        found *= low * low
        if level < len(branch.details):
            band = branch.details[level]
            detail = largest(band.mean) + branch.ranks[level + 1] * coefficient * largest(band.h) * largest(band.w)
            found += (2 * low + high) * high * detail
    return found


def _require(path: str, reached: float) -> None:
    if not reached <= MAGNITUDE:
        raise FormatError("value", path, f"the numbers that follow from it may exceed {MAGNITUDE:.2g}")
