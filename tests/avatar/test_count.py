"""Counts against the paper's published figures and against a count by hand."""

from dataclasses import replace

from synthetic_avatar import synthetic_avatar

from mua.asset.count import flops, parameters
from mua.pose.encoding import PoseEncoding
from mua.student.settings import PAPER_SIZES, preset
from mua.student.shapes import Body, Outline, outline

PAPER_PARAMETERS = 26.67e6  # paper, Tab. Comparison
PAPER_FLOPS = 0.52e9
PAPER_TEXELS = 300_000  # paper, Animatable Coarse Geometry
PAPER_INPUTS = 981  # as many components as the descriptor has numbers: the most that there can be
PAPER_WAVELET = "bior4.4"  # which it does not state
PAPER_VERTICES = 5_514  # template of the family's released character


def paper_avatar() -> Outline:
    descriptor = PoseEncoding(joints=tuple(range(1, 54)), rate=25).width
    settings = replace(preset("paper"), **vars(PAPER_SIZES))
    return outline(settings, Body(descriptor, PAPER_INPUTS, PAPER_VERTICES, PAPER_TEXELS, PAPER_WAVELET))


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
