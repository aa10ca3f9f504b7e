"""Counts against the paper's published figures and against a count by hand."""

import dataclasses
import itertools

import numpy as np
import pywt
from synthetic_avatar import synthetic_avatar

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.count import flops, parameters
from mua.avatar.model import Branch, Coarse, DetailBand, Layer, Mlp, Wavelet
from mua.pose.encoding import Components, Normalization, PoseEncoding
from mua.student.settings import Ranks, preset

PAPER = preset("paper")
PAPER_PARAMETERS = 26.67e6  # paper, Tab. Comparison
PAPER_FLOPS = 0.52e9
PAPER_TEXELS = 300_000  # paper, Animatable Coarse Geometry
PAPER_INPUTS = 981  # as many components as the descriptor has numbers: the most that there can be
PAPER_VERTICES = 5_514  # template of the family's released character


def blank(*shape: int) -> Array:
    """Zeros that take no memory."""
    return np.broadcast_to(np.float32(0), shape)


def mlp(*sizes: int) -> Mlp:
    return tuple(Layer(blank(n, m), blank(n)) for m, n in itertools.pairwise(sizes))


def paper_branch(channels: int, ranks: Ranks, inputs: int) -> Branch:
    details = tuple(
        DetailBand(blank(3, channels, n, n), blank(3, channels, r, n), blank(3, channels, r, n))
        for n, r in ((48, ranks.d3), (96, ranks.d2))
    )
    return Branch(
        mlp=mlp(inputs, PAPER.hidden, PAPER.hidden, channels * ranks.total),
        ll_mean=blank(channels, 48, 48),
        ll_basis=blank(channels, ranks.ll, 48, 48),
        details=details,
        static=blank(channels, PAPER_TEXELS),
    )


def paper_avatar() -> Avatar:
    encoding = PoseEncoding(joints=tuple(range(1, 54)), rate=25)
    taps = pywt.Wavelet("bior4.4")
    return dataclasses.replace(
        synthetic_avatar(),
        encoding=encoding,
        components=Components(
            Normalization(blank(encoding.width), blank(encoding.width)),
            blank(PAPER_INPUTS, encoding.width),
            blank(2, PAPER_INPUTS),
            blank(PAPER_INPUTS),
        ),
        coarse=Coarse(
            mlp(PAPER_INPUTS, PAPER.hidden, PAPER.hidden, PAPER.components),
            blank(PAPER_VERTICES, 3),
            blank(PAPER.components, PAPER_VERTICES, 3),
        ),
        geometry=paper_branch(11, PAPER.geometry, PAPER_INPUTS),
        appearance=paper_branch(12, PAPER.appearance, PAPER_INPUTS),
        wavelet=Wavelet("bior4.4", 4, np.array(taps.rec_lo), np.array(taps.rec_hi)),
    )


def test_paper_setting_costs_no_more_than_published() -> None:
    avatar = paper_avatar()
    assert 0.8 * PAPER_PARAMETERS < sum(parameters(avatar).values()) <= PAPER_PARAMETERS
    assert 0.8 * PAPER_FLOPS < sum(flops(avatar).values()) <= PAPER_FLOPS


def test_flops_of_the_synthetic_avatar_match_a_count_by_hand() -> None:
    spent = flops(synthetic_avatar())
    # LL 2 x 2 of rank 4 on 11 + 12 channels
    assert spent["LL blend"] == 2 * 23 * 4 * 4
    # per band and channel: alpha h (R n) and h w (R n n); D3 rank 3 on 2 x 2, D2 rank 2 on 4 x 4
    assert spent["detail blend"] == 2 * 23 * 3 * ((3 * 2 + 3 * 4) + (2 * 4 + 2 * 16))
    # 2 -> 4 -> 8 with four bands, 8 -> 16 -> 32 low-pass, 10 taps
    assert spent["inverse DWT"] == 2 * 23 * (20 * (16 + 64) + 10 * (256 + 1024) * 3 // 4)
    assert spent["static offset"] == 23 * 676
