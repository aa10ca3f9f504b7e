"""Wavelet, coarse mesh and branches of a file's tree: every shape relation and range checked."""

import numpy as np

from mua.asset.flatbuffer import FormatError, Tree, refuse
from mua.asset.tensors import reals, some_reals
from mua.avatar.model import Branch, Coarse, DetailBand, Layer, Mlp, Wavelet
from mua.limits import LARGEST_TAP, MAX_TAPS


def read_wavelet(tree: Tree) -> Wavelet:
    low, high = tree["rec_lo"], tree["rec_hi"]
    if low.size != high.size or low.size % 2 or not 2 <= low.size <= MAX_TAPS:
        refuse("wavelet.rec_lo", f"{low.size} and {high.size} taps, expected an even number of each, 2 to {MAX_TAPS}")
    if not (np.isfinite(low).all() and np.isfinite(high).all()):
        raise FormatError("finite", "wavelet.rec_lo", "a value is not finite")
    largest = max(np.abs(low).max(), np.abs(high).max())
    if largest > LARGEST_TAP:
        refuse("wavelet.rec_lo", f"a tap of {largest:.4g}, expected {-LARGEST_TAP:g} to {LARGEST_TAP:g}")
    return Wavelet(name=tree["name"], levels=tree["levels"], rec_lo=low, rec_hi=high)


def _mlp(layers: list[Tree], path: str, first: int, last: int) -> Mlp:
    mlp: list[Layer] = []
    width = first
    for i, layer in enumerate(layers):
        weight = reals(layer["weight"], f"{path}[{i}].weight", (None, width))
        width = len(weight)
        mlp.append(Layer(weight=weight, bias=reals(layer["bias"], f"{path}[{i}].bias", (width,))))
    if not mlp or width != last:
        raise FormatError("shape", path, f"{len(mlp)} layers with {width} outputs, expected {last}")
    return tuple(mlp)


def read_coarse(tree: Tree, inputs: int) -> Coarse:
    mean = reals(tree["mean"], "coarse.mean", (None, 3))
    basis = some_reals(tree["basis"], "coarse.basis", (None, len(mean), 3), axis=0)
    return Coarse(mlp=_mlp(tree["mlp"], "coarse.mlp", inputs, len(basis)), mean=mean, basis=basis)


def read_branch(tree: Tree, path: str, channels: int, *, count: int, inputs: int, size: int) -> Branch:
    """One branch over `count` texels with LL of `size`, driven by so many components."""
    basis = some_reals(tree["ll_basis"], f"{path}.ll_basis", (channels, None, size, size), axis=1)
    details = tuple(
        _detail(band, f"{path}.details[{i}]", channels, size << i) for i, band in enumerate(tree["details"])
    )
    outputs = channels * (basis.shape[1] + sum(band.h.shape[2] for band in details))
    return Branch(
        mlp=_mlp(tree["mlp"], f"{path}.mlp", inputs, outputs),
        ll_mean=reals(tree["ll_mean"], f"{path}.ll_mean", (channels, size, size)),
        ll_basis=basis,
        details=details,
        static=reals(tree["static_offset"], f"{path}.static_offset", (channels, count)),
    )


def _detail(tree: Tree, path: str, channels: int, size: int) -> DetailBand:
    h = some_reals(tree["h"], f"{path}.h", (3, channels, None, size), axis=2)
    return DetailBand(
        mean=reals(tree["mean"], f"{path}.mean", (3, channels, size, size)),
        h=h,
        w=reals(tree["w"], f"{path}.w", h.shape),
    )
