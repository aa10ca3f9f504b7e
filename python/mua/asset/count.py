"""What an avatar costs, counted from the avatar itself: parameters and floating-point operations of a frame."""

from typing import Protocol

import numpy as np

from mua.avatar.model import Branch, Coarse, Mlp, Wavelet
from mua.pose.encoding import Components


class Counted(Protocol):
    """What is counted of an avatar."""

    @property
    def components(self) -> Components: ...
    @property
    def coarse(self) -> Coarse: ...
    @property
    def geometry(self) -> Branch: ...
    @property
    def appearance(self) -> Branch: ...
    @property
    def wavelet(self) -> Wavelet: ...


def parameters(avatar: Counted) -> dict[str, int]:
    """Learnt numbers by part; their sum is the paper's Param column (Tab. Comparison).

    Components of one joint are 0 for all others: what is 0 in them is stored, but is no parameter.
    """
    branches, components = (avatar.geometry, avatar.appearance), avatar.components
    return {
        "components of the pose": int(np.count_nonzero(components.directions)) + 3 * len(components.margins),
        "coefficient MLPs": sum(_weights(mlp) for mlp in (avatar.coarse.mlp, *(b.mlp for b in branches))),
        "PCA mesh": avatar.coarse.mean.size + avatar.coarse.basis.size,
        "LL bases": sum(b.ll_mean.size + b.ll_basis.size for b in branches),
        "detail bases": sum(d.mean.size + d.h.size + d.w.size for b in branches for d in b.details),
        "static offset": sum(b.static.size for b in branches),
    }


def flops(avatar: Counted) -> dict[str, int]:
    """Floating-point operations of one frame by stage, a multiply-add as two.

    Counted is what turns a motion descriptor into a Gaussian texture and a mesh; posing and rasterising are not,
    as in the paper (Sec. Metrics).
    """
    branches = (avatar.geometry, avatar.appearance)
    taps = len(avatar.wavelet.rec_lo)
    mlps = (avatar.coarse.mlp, *(b.mlp for b in branches))
    return {
        "components of the pose": 2 * avatar.components.directions.size,
        "coefficient MLPs": 2 * sum(layer.weight.size for mlp in mlps for layer in mlp),
        "PCA mesh": 2 * avatar.coarse.basis.size,
        "LL blend": 2 * sum(b.ll_basis.size for b in branches),
        "detail blend": 2 * sum(_outer_products(b) for b in branches),
        "inverse DWT": sum(_inverse_dwt(b, avatar.wavelet.levels, taps) for b in branches),
        "static offset": sum(b.static.size for b in branches),
    }


def stored_bytes(value: object) -> int:
    """Bytes of all vectors below one part of a loaded file's tree, packed ones as they stand in the file."""
    return unpacked_bytes(value) - _saved(value)


def unpacked_bytes(value: object) -> int:
    """The same once they are unpacked."""
    if isinstance(value, dict):
        return sum(unpacked_bytes(child) for name, child in value.items() if name != "_at")
    if isinstance(value, list):
        return sum(unpacked_bytes(child) for child in value)
    return int(getattr(value, "nbytes", 0))


def _saved(value: object) -> int:
    """Bytes that packing saves below one part."""
    if isinstance(value, dict):
        own = value["data"].nbytes - value["_stored"] if "_stored" in value else 0
        return own + sum(_saved(child) for child in value.values())
    return sum(_saved(child) for child in value) if isinstance(value, list) else 0


def _weights(mlp: Mlp) -> int:
    return sum(layer.weight.size + layer.bias.size for layer in mlp)


def _outer_products(branch: Branch) -> int:
    """Multiply-adds of sum_r alpha h (x) w: the scaled h, then one matrix product for each band and channel."""
    return sum(band.h.size + band.h.size * band.w.shape[-1] for band in branch.details)


def _inverse_dwt(branch: Branch, levels: int, taps: int) -> int:
    dynamic = len(branch.details)
    return synthesis(branch.channels, branch.ll_mean.shape[-1], dynamic, levels, taps=taps)


def synthesis(channels: int, side: int, dynamic: int, levels: int, *, taps: int) -> int:
    """Operations of the wavelet synthesis from LL of a side on, the first `dynamic` of its levels with details.

    Half of the taps meet each output sample of each input band. With an output side of n, four bands cost n^2 taps
    multiply-adds for the columns and as many for the rows; the low-pass band alone costs n (n / 2) (taps / 2) and then
    n^2 taps / 2.
    """
    sides = side << np.arange(1, levels + 1)
    full, low = sides[:dynamic] ** 2, sides[dynamic:] ** 2
    return 2 * int(channels * (2 * taps * full.sum() + taps * low.sum() * 3 // 4))
