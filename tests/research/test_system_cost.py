"""What a compared system costs at the setting of the paper equals sums by hand."""

from dataclasses import replace

import pytest
import torch

from mua.bench.random_avatar import ENCODING
from mua.filters import WAVELET
from mua.student.settings import PAPER_SIZES, preset
from mua_research.system import Sizes
from mua_research.systems import SYSTEMS

# The paper's setting with the family's 5,514 vertices replaced by the stand-in's, see mua.bench.random_avatar.
INPUTS, HIDDEN, VERTICES, VALID, TAPS = 3 * (9 + 6 * 53), 384, 5508, 300_000, 4


def mlp_size(outputs: int) -> tuple[int, int]:
    """Parameters and operations of two hidden layers."""
    weights = INPUTS * HIDDEN + HIDDEN * HIDDEN + HIDDEN * outputs
    return weights + 2 * HIDDEN + outputs, 2 * weights


def by_hand(name: str) -> tuple[int, int]:
    """Parameters and operations of the texture's part at the paper's setting."""
    c, n, full = 23, VALID, 23 * VALID
    alphas = 11 * 192 + 12 * 128, 23 * 128, 23 * 96
    ll, d3, d2 = 48 * 48, 3 * 48 * 48, 3 * 96 * 96
    bands = c * (ll + d3 + d2)  # the mean
    synthesis = 2 * c * 2 * TAPS * (96**2 + 192**2) + 2 * c * 3 * TAPS * (192**2 + 384**2) + full
    blend_ll = 2 * ll * alphas[0]
    blend_details = 2 * (3 * alphas[1] * (48 + 48 * 48) + 3 * alphas[2] * (96 + 96 * 96))
    factors = 3 * 2 * (48 * alphas[1] + 96 * alphas[2])
    conv = 25 * (6 * 32 + 32 * 64 + 64 * 128)  # weights of three layers of 5 x 5
    bias = 32 + 64 + 128
    line = 5 * (88 * 256 + 256 * 256 + 256 * 256)  # 64 projected and 24 encoded features
    lines = {s: 3 * 64 + 64 + 2 * s * s + 2 * (line + 3 * 256) + 257 * 69 for s in (48, 96)}
    line_flops = {s: 2 * (s * s * (3 * 64 + 2 * 88) + s * 2 * line + 69 * 256 * (s + s * s)) for s in (48, 96)}
    if name == "pca-only":
        size, cost = mlp_size(128)
        return size + 128 * full + full, cost + 2 * 128 * full + full
    if name == "full-blendshapes":
        size, cost = mlp_size(128)
        return 2 * size + 128 * full + full, 2 * cost + 2 * 128 * full + full
    if name == "single-level":
        terms = 11 * 384, 12 * 256
        sizes = [mlp_size(term) for term in terms]
        products = sum(terms) * (768 + n)
        return sum(s for s, _ in sizes) + sum(terms) * 2 * 768 + full, sum(f for _, f in sizes) + 2 * products + full
    if name == "linear":
        grid = 64 * c * 64 * 64
        return 64 * INPUTS + 64 + grid + full, 2 * (64 * INPUTS + grid) + full
    if name == "2d-conv+2d-conv":
        details = 2 * (2 * (conv + bias) + 129 * 3 * c)
        detail_flops = 2 * (48 * 48 + 96 * 96) * (2 * conv + 128 * 3 * c)
        size, cost = conv + bias + 129 * c + details, 2 * ll * (conv + 128 * c) + detail_flops
    elif name == "2d-conv+blendshapes":
        sizes = [mlp_size(channels * (128 + 96)) for channels in (11, 12)]
        size = sum(s for s, _ in sizes) + factors + conv + bias + 129 * c
        cost = sum(f for _, f in sizes) + blend_details + 2 * ll * (conv + 128 * c)
    elif name == "blendshapes+1d-conv":
        sizes = [mlp_size(outputs) for outputs in (11 * 192, 12 * 128)]
        size = sum(s for s, _ in sizes) + ll * alphas[0] + sum(lines.values())
        cost = sum(f for _, f in sizes) + blend_ll + sum(line_flops.values())
    else:
        sizes = [mlp_size(outputs) for outputs in (11 * (192 + 224), 12 * (128 + 224))]
        size = sum(s for s, _ in sizes) + ll * alphas[0] + factors
        cost = sum(f for _, f in sizes) + blend_ll + blend_details
    return size + bands + full, cost + synthesis


@pytest.mark.parametrize("name", SYSTEMS)
def test_costs_at_the_paper_setting_equal_sums_by_hand(name: str) -> None:
    settings = replace(preset("paper"), **vars(PAPER_SIZES))
    sizes = Sizes(settings, ENCODING, INPUTS, VERTICES, torch.arange(VALID), WAVELET)
    system = SYSTEMS[name](sizes)
    mesh_size, mesh_cost = mlp_size(128)
    size, cost = by_hand(name)
    assert system.parameters == size + mesh_size + 129 * 3 * VERTICES
    assert system.flops == cost + mesh_cost + 2 * 128 * 3 * VERTICES
