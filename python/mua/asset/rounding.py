"""Round an avatar's numbers to what an image shows, so that they deflate to a fraction: multiples of powers of two.

Every step follows from that of its channel: a basis is rounded to what moves a texel as far, a weight to what moves
its basis as far. Multiples of a power of two are exact as f16, so that a reader has nothing to do.
"""

from dataclasses import replace

import numpy as np

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.model import Branch, Coarse, DetailBand, Layer
from mua.channels import APPEARANCE, ATTRIBUTES, CHANNELS, GEOMETRY
from mua.rig.expressions import Expressions

# Steps of the static offset, measured in docs/research/storage.md; that of an offset is of the figure's height.
STEPS = {"offset": 2.0**-16, "rotation": 2.0**-8, "scale": 2.0**-7, "opacity": 2.0**-6, "SH": 2.0**-8}
LL, DETAILS, MEANS, WEIGHTS, MESH = 1.0, 0.25, 1.0, 0.03, 4.0  # times the channel's step, of what each is a part of
COARSEST = 1.0  # step, of what hardly counts
LL_GAIN = 4.0  # of a coefficient of LL to one of the finest detail, by which weights are compared


def rounded(avatar: Avatar) -> Avatar:
    """The same avatar with its bases, its static offset, the last layers of its MLPs and its expressions in steps.

    What a triangle map gives back, and what a person reads, stays as it is.
    """
    height = float(np.ptp(avatar.coarse.mean, axis=0).max(initial=0)) or 1.0
    steps = channel_steps(height)
    return replace(
        avatar,
        coarse=_coarse(avatar.coarse, MESH * steps[0]),
        geometry=_branch(avatar.geometry, steps[GEOMETRY]),
        appearance=_branch(avatar.appearance, steps[APPEARANCE]),
        rig=replace(avatar.rig, expressions=_expressions(avatar.rig.expressions, MESH * steps[0])),
    )


def _expressions(expressions: Expressions | None, step: float) -> Expressions | None:
    return expressions and replace(expressions, offsets=in_steps(expressions.offsets, step))


def channel_steps(height: float) -> Array:
    """Steps [23] of the static offset of a figure of so many metres."""
    steps = np.zeros(CHANNELS)
    for name, channels in ATTRIBUTES.items():
        steps[channels] = STEPS[name]
    steps[ATTRIBUTES["offset"]] *= height
    return steps


def in_steps(values: Array, steps: Array | float) -> Array:
    """Multiples of the powers of two at or below `steps`, which broadcast over the values."""
    powers = np.exp2(np.floor(np.log2(steps)))
    return np.asarray(np.rint(values.astype(np.float64) / powers) * powers, dtype=np.float32)


def _coarse(coarse: Coarse, step: float) -> Coarse:
    """Coefficients of the mesh are about 1."""
    return replace(coarse, basis=in_steps(coarse.basis, step))


def _branch(
    branch: Branch,
    steps: Array,  # [C]
) -> Branch:
    *hidden, last = branch.mlp
    weight = in_steps(last.weight, _at_most(WEIGHTS / _reach(branch, steps))[:, None])
    return replace(
        branch,
        mlp=(*hidden, Layer(weight, last.bias)),
        ll_basis=in_steps(branch.ll_basis, LL * steps[:, None, None, None]),
        details=tuple(_detail(band, steps[None, :, None, None]) for band in branch.details),
        static=in_steps(branch.static, steps[:, None]),
    )


def _detail(
    band: DetailBand,
    steps: Array,  # [1, C, 1, 1]
) -> DetailBand:
    """An error in one factor counts as much as the other is large."""
    return DetailBand(
        mean=in_steps(band.mean, MEANS * steps),
        h=in_steps(band.h, _at_most(DETAILS * steps / _nonzero(_rms(band.w)))),
        w=in_steps(band.w, _at_most(DETAILS * steps / _nonzero(_rms(band.h)))),
    )


def _reach(branch: Branch, steps: Array) -> Array:
    """By how many steps of its channel each coefficient moves a texel, [C R of LL + C R of each detail]."""
    parts = [_rms(branch.ll_basis.reshape(*branch.ll_basis.shape[:2], -1)) / LL_GAIN]
    for level, band in enumerate(branch.details):
        product = _rms(band.h) * _rms(band.w)  # [3, C, R, 1]
        parts.append(np.sqrt((product**2).sum(axis=0)) / (LL_GAIN / 2 ** (level + 1)))
    return _nonzero(np.concatenate([(part[..., 0] / steps[:, None]).ravel() for part in parts]))


def _rms(values: Array) -> Array:
    """Along the last axis, which stays."""
    return np.asarray(np.sqrt(np.mean(values.astype(np.float64) ** 2, axis=-1, keepdims=True)))


def _nonzero(values: Array) -> Array:
    return np.maximum(values, np.finfo(np.float32).tiny)


def _at_most(steps: Array) -> Array:
    return np.minimum(steps, COARSEST)
