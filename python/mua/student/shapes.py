"""A student's arrays as shapes without numbers, to count what it costs before it is trained."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from mua.arrays import Array
from mua.avatar.model import Branch, Coarse, DetailBand, Layer, Mlp, Wavelet
from mua.channels import APPEARANCE, COARSE_TEXELS, FINE_TEXELS, GEOMETRY, LEVELS
from mua.filters import WAVELET, filters
from mua.pose.encoding import Components, Normalization
from mua.student.settings import Ranks, Settings


@dataclass(frozen=True)
class Body:
    """What the cost of a student follows from beside its settings."""

    descriptor: int = 0  # numbers of the motion descriptor
    inputs: int = 0  # components of it that the MLPs read
    vertices: int = 0
    texels: int = 0  # valid ones
    wavelet: str = WAVELET


@dataclass(frozen=True, eq=False)
class Outline:
    """The parts of an avatar that `mua.asset.count` counts; their arrays take no memory."""

    components: Components
    coarse: Coarse
    geometry: Branch
    appearance: Branch
    wavelet: Wavelet


def outline(settings: Settings, body: Body) -> Outline:
    """The student of these settings on a body."""
    normalization = Normalization(_blank(body.descriptor), _blank(body.descriptor))
    directions, ranges = _blank(body.inputs, body.descriptor), _blank(2, body.inputs)
    return Outline(
        Components(normalization, directions, ranges, _blank(body.inputs)),
        Coarse(
            _mlp(body, settings, settings.components),
            _blank(body.vertices, 3),
            _blank(settings.components, body.vertices, 3),
        ),
        _branch(settings, settings.geometry, GEOMETRY.stop - GEOMETRY.start, body),
        _branch(settings, settings.appearance, APPEARANCE.stop - APPEARANCE.start, body),
        wavelet_of(body.wavelet),
    )


def wavelet_of(name: str) -> Wavelet:
    """The synthesis of a student's textures by the wavelet of this name."""
    bank = filters(name)
    return Wavelet(name, LEVELS, bank.rec_lo, bank.rec_hi)


def _branch(settings: Settings, ranks: Ranks, channels: int, body: Body) -> Branch:
    coarse, fine = settings.texels // COARSE_TEXELS, settings.texels // FINE_TEXELS
    return Branch(
        mlp=_mlp(body, settings, channels * ranks.total),
        ll_mean=_blank(channels, coarse, coarse),
        ll_basis=_blank(channels, ranks.ll, coarse, coarse),
        details=tuple(_detail(channels, rank, side) for rank, side in ((ranks.d3, coarse), (ranks.d2, fine))),
        static=_blank(channels, body.texels),
    )


def _detail(channels: int, rank: int, side: int) -> DetailBand:
    factor = _blank(3, channels, rank, side)
    return DetailBand(_blank(3, channels, side, side), factor, factor)


def _mlp(body: Body, settings: Settings, outputs: int) -> Mlp:
    widths = (body.inputs, settings.hidden, settings.hidden, outputs)
    return tuple(Layer(_blank(n, m), _blank(n)) for m, n in pairwise(widths))


def _blank(*shape: int) -> Array:
    return np.broadcast_to(np.float32(0), shape)
