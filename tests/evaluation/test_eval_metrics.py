"""The metrics of mua-eval against formulas written out here."""

import math
from pathlib import Path

import numpy as np
import pytest
import torch
from scipy.signal import convolve2d
from torch import nn
from torch.nn import functional
from torchmetrics.functional.image import lpips as perceptual

from mua.arrays import Array
from mua.errors import InputError
from mua.evaluation.metrics import Scores, compare, mean
from mua.splatting.perceptual import Lpips

SIZE = 180
FLOAT_BOUND = 2e-5  # float32 convolutions of 121 taps, variances as differences of near squares, over C2 = 9e-4
STABLE = (0.01**2, 0.03**2)  # C1, C2 for a range of 1
SCALES = (0.0448, 0.2856, 0.3001, 0.2363, 0.1333)  # exponents of the five scales (Wang et al. 2003)
ALEXNET = ((3, 64, 11, 4, 2), (64, 192, 5, 1, 2), (192, 384, 3, 1, 1), (384, 256, 3, 1, 1), (256, 256, 3, 1, 1))


def pictures(noise: float = 0.1) -> tuple[Array, Array]:
    """A smooth image with edges and the same with noise."""
    rng = np.random.default_rng(0)
    y, x = np.mgrid[:SIZE, :SIZE] / SIZE
    truth = np.stack([x, y, 0.5 + 0.4 * np.sign(np.sin(20 * x + 9 * y))], axis=2)
    image = np.clip(truth + noise * rng.standard_normal(truth.shape), 0, 1)
    return image.astype(np.float32), truth.astype(np.float32)


def similarity(a: Array, b: Array) -> tuple[float, float]:
    """Mean SSIM, borders mirrored, and mean contrast-structure inside them, of one channel (Wang et al. 2004)."""
    taps = np.exp(-(np.arange(-5, 6) ** 2) / (2 * 1.5**2))
    window = np.outer(taps, taps) / taps.sum() ** 2
    a, b = (np.pad(m.astype(float), 5, mode="reflect") for m in (a, b))
    ma, mb, aa, bb, ab = (convolve2d(m, window, mode="valid") for m in (a, b, a * a, b * b, a * b))
    c1, c2 = STABLE
    structure = (2 * (ab - ma * mb) + c2) / (aa - ma**2 + bb - mb**2 + c2)
    whole = (2 * ma * mb + c1) / (ma**2 + mb**2 + c1) * structure
    return float(whole.mean()), float(structure[5:-5, 5:-5].mean())


def channels(image: Array) -> list[Array]:
    return [image[..., c] for c in range(3)]


def test_psnr_is_that_of_the_mean_square() -> None:
    image, truth = pictures()
    expected = -10 * np.log10(np.mean((image.astype(float) - truth) ** 2))
    assert compare(image, truth)[0].psnr == pytest.approx(expected, abs=1e-4)
    grey = np.full((SIZE, SIZE, 3), 0.5, np.float32)
    assert compare(grey + np.float32(0.1), grey)[0].psnr == pytest.approx(20, abs=1e-4)


def test_ssim_agrees_with_its_formula() -> None:
    image, truth = pictures()
    expected = np.mean([similarity(a, b)[0] for a, b in zip(channels(image), channels(truth), strict=True)])
    assert expected < 0.9
    assert compare(image, truth)[0].ssim == pytest.approx(expected, abs=FLOAT_BOUND)


def test_ms_ssim_agrees_with_its_formula() -> None:
    image, truth = pictures()
    product = 1.0
    for scale, exponent in enumerate(SCALES):
        pairs = [similarity(a, b) for a, b in zip(channels(image), channels(truth), strict=True)]
        factor = np.mean(pairs, axis=0)[0 if scale == len(SCALES) - 1 else 1]
        product *= factor**exponent
        even = image.shape[0] // 2 * 2
        image, truth = (
            m[:even, :even].reshape(even // 2, 2, even // 2, 2, 3).mean(axis=(1, 3)) for m in (image, truth)
        )
    assert compare(*pictures())[0].ms_ssim == pytest.approx(product, abs=FLOAT_BOUND)
    assert product < 0.99


def hunt_lab(rgb: Array) -> Array:
    """L a b of linear sRGB, a and b scaled by the Hunt effect (Andersson et al. 2020)."""
    to_xyz = np.array(
        [
            [10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
            [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
            [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382],
        ]
    )
    white = to_xyz.sum(axis=1)
    ratio = to_xyz @ rgb / white
    delta = 6 / 29
    f = np.where(ratio > delta**3, np.cbrt(ratio), ratio / (3 * delta**2) + 4 / 29)
    lightness = 116 * f[1] - 16
    return np.array([lightness, 0.01 * lightness * 500 * (f[0] - f[1]), 0.01 * lightness * 200 * (f[1] - f[2])])


def distance(a: Array, b: Array) -> float:
    """HyAB to the power of 0.7."""
    difference = hunt_lab(a) - hunt_lab(b)
    return float((abs(difference[0]) + np.hypot(*difference[1:])) ** 0.7)


def flip_of_plain(a: Array, b: Array) -> float:
    """FLIP of two plain colours, sRGB: there is nothing to filter and no edge, so that colour alone counts."""
    a, b = (np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4) for c in (a, b))
    most = distance(np.array([0.0, 1, 0]), np.array([0.0, 0, 1]))
    found, knee = distance(a, b), 0.4 * most
    return 0.95 * found / knee if found < knee else 0.95 + 0.05 * (found - knee) / (most - knee)


@pytest.mark.parametrize(
    ("a", "b"), [((0.5, 0.5, 0.5), (0.55, 0.5, 0.45)), ((0.9, 0.1, 0.1), (0.1, 0.1, 0.9)), ((0, 0, 0), (1, 1, 1))]
)
def test_flip_of_plain_colours_agrees_with_its_formula(a: tuple[float, ...], b: tuple[float, ...]) -> None:
    plain = [np.broadcast_to(np.array(c, np.float32), (SIZE, SIZE, 3)).copy() for c in (a, b)]
    scores, shown = compare(*plain)
    middle = shown[SIZE // 2, SIZE // 2]
    assert middle == pytest.approx(flip_of_plain(np.array(a), np.array(b)), abs=2e-3)
    assert scores.flip == pytest.approx(shown.astype(float).mean(), abs=1e-6)


def test_nothing_differs_from_itself() -> None:
    _, truth = pictures()
    scores, shown = compare(truth, truth)
    assert scores.psnr == math.inf
    assert (scores.ssim, scores.ms_ssim) == (pytest.approx(1, abs=1e-6), pytest.approx(1, abs=1e-6))
    assert scores.flip == 0
    assert not shown.any()
    assert math.isnan(scores.lpips)


def test_flip_shows_where() -> None:
    _, truth = pictures()
    image = truth.copy()
    image[100:110, 40:50] = 1 - image[100:110, 40:50]
    _, shown = compare(image, truth)
    assert shown.shape == truth.shape[:2]
    row, column = np.unravel_index(shown.argmax(), shown.shape)
    assert 95 <= row < 115
    assert 35 <= column < 55


def test_means_are_by_metric() -> None:
    found = mean([Scores(30, 0.9, 0.8, 0.1, math.nan), Scores(40, 0.7, 0.6, 0.3, math.nan)])
    assert (found.psnr, found.ssim, found.ms_ssim, found.flip) == (
        35,
        pytest.approx(0.8),
        pytest.approx(0.7),
        pytest.approx(0.2),
    )
    assert math.isnan(found.lpips)
    assert math.isnan(mean([]).psnr)


@pytest.fixture
def weights(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Random weights in the shape of torchvision's AlexNet, and its layers where torchvision would make them."""
    generator = torch.Generator().manual_seed(0)

    def layers(net: str, pretrained: bool) -> nn.Sequential:
        assert (net, pretrained) == ("alexnet", False)  # nothing is downloaded
        pool, convs = nn.MaxPool2d(3, 2), [nn.Conv2d(i, o, k, s, p) for i, o, k, s, p in ALEXNET]
        after = [[nn.ReLU(), pool], [nn.ReLU(), pool], [nn.ReLU()], [nn.ReLU()], [nn.ReLU(), pool]]
        return nn.Sequential(*(m for conv, rest in zip(convs, after, strict=True) for m in (conv, *rest)))  # type: ignore[misc]

    monkeypatch.setattr(perceptual, "_get_tv_model_features", layers)
    state = {}
    for place, (i, o, k, _, _) in zip((0, 3, 6, 8, 10), ALEXNET, strict=True):
        state[f"features.{place}.weight"] = torch.randn(o, i, k, k, generator=generator) / math.sqrt(i * k * k)
        state[f"features.{place}.bias"] = 0.1 * torch.randn(o, generator=generator)
    path = tmp_path / "alexnet.pth"
    torch.save({**state, "classifier.1.weight": torch.zeros(1)}, path)
    return path


def by_hand(image: Array, truth: Array, state: dict[str, torch.Tensor], net: Lpips) -> float:
    """LPIPS written out (Zhang et al. 2018): unit features, squared differences, linear layers, means."""
    shift, scale = torch.tensor([-0.030, -0.088, -0.188]), torch.tensor([0.458, 0.448, 0.450])
    x = [((2 * torch.from_numpy(m) - 1 - shift) / scale).permute(2, 0, 1)[None] for m in (image, truth)]
    total = 0.0
    for layer, (place, (_, _, _, stride, pad)) in enumerate(zip((0, 3, 6, 8, 10), ALEXNET, strict=True)):
        if layer in (1, 2):
            x = [functional.max_pool2d(m, 3, 2) for m in x]
        weight, bias = state[f"features.{place}.weight"], state[f"features.{place}.bias"]
        x = [functional.relu(functional.conv2d(m, weight, bias, stride, pad)) for m in x]
        unit = [m / torch.sqrt(m.square().sum(1, keepdim=True) + 1e-8) for m in x]
        linear = net._net.lins[layer].model[-1].weight
        total += float(((unit[0] - unit[1]).square() * linear.reshape(1, -1, 1, 1)).sum(1).mean())  # type: ignore[operator]
    return 1000 * total


def test_lpips_agrees_with_its_formula(weights: Path) -> None:
    image, truth = pictures()
    net = Lpips(weights)
    assert net.network == "alex"
    expected = by_hand(image, truth, torch.load(weights, weights_only=True), net)
    assert compare(image, truth, lpips=net)[0].lpips == pytest.approx(expected, rel=1e-4)
    assert expected > 0.1
    assert compare(truth, truth, lpips=net)[0].lpips == 0


def test_weights_that_do_not_fit_are_refused(weights: Path, tmp_path: Path) -> None:
    state = torch.load(weights, weights_only=True)
    bad = tmp_path / "bad.pth"
    with pytest.raises(InputError, match=r"bad\.pth: No such file"):
        Lpips(bad)
    bad.write_bytes(b"nothing of use")
    with pytest.raises(InputError, match=r"bad\.pth: is no file of weights"):
        Lpips(bad)
    torch.save([1, 2], bad)
    with pytest.raises(InputError, match=r"holds a list, expected weights by name"):
        Lpips(bad)
    torch.save({"features.0.weight": torch.zeros(4, 3)}, bad)
    with pytest.raises(InputError, match=r"features\.0\.weight is \[4, 3\], expected AlexNet's or VGG16's"):
        Lpips(bad)
    torch.save({name: value for name, value in state.items() if name != "features.8.bias"}, bad)
    with pytest.raises(InputError, match=r"features\.8\.bias is missing or of another shape than alex's"):
        Lpips(bad)


def test_without_torchvision_lpips_says_so(weights: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(net: str, pretrained: bool) -> nn.Sequential:
        raise ModuleNotFoundError("Torchvision is not installed.")

    monkeypatch.setattr(perceptual, "_get_tv_model_features", missing)
    with pytest.raises(InputError, match="torchvision is not installed"):
        Lpips(weights)
