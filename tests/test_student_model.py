"""The student's forward pass against the paper's formulas spelt out in numpy and PyWavelets."""

import numpy as np
import pytest
import pywt
import torch
from synthetic_student import INPUTS, SIZE, VERTICES, bands_of_frames, random_student, valid_texels

from mua.channels import CHANNELS, GEOMETRY
from mua.errors import InputError
from mua.pose.encoding import PoseEncoding
from mua.student.model import Alphas, Branch, Student, build_mlp
from mua.student.settings import PRESETS, Settings, preset

FLOAT32 = float(np.finfo(np.float32).eps)


def random_alphas(branch: Branch, frames: int) -> Alphas:
    generator = torch.Generator().manual_seed(3)
    return branch.split(torch.randn(frames, branch.channels * branch.ranks.total, generator=generator))


def test_subbands_are_mean_plus_blendshapes() -> None:
    branch = random_student().geometry
    alphas = random_alphas(branch, 3)
    bands = branch.synthesize(alphas)
    f, s, c = 2, 1, 4
    ll = branch.ll_mean[c] + sum(a * shape for a, shape in zip(alphas.ll[f, c], branch.ll_basis[c], strict=True))
    terms = zip(alphas.d2[f, c], branch.d2.h[s, c], branch.d2.w[s, c], strict=True)
    d2 = branch.d2.mean[s, c] + sum(a * torch.outer(h, w) for a, h, w in terms)
    assert torch.allclose(bands.ll[f, c], ll, atol=100 * FLOAT32)
    assert torch.allclose(bands.d2[f, s, c], d2, atol=100 * FLOAT32)


def test_mlp_output_is_ll_then_d3_then_d2_each_row_major() -> None:
    branch = random_student().geometry
    flat = torch.arange(branch.channels * branch.ranks.total, dtype=torch.float32)[None]
    alphas = branch.split(flat)
    assert alphas.ll[0, 1, 0] == branch.ranks.ll
    assert alphas.d3[0, 0, 0] == branch.channels * branch.ranks.ll
    assert torch.equal(alphas.flat(), flat)


def test_texture_is_pywts_inverse_plus_the_static_offset() -> None:
    student = random_student()
    _, bands = bands_of_frames(2)
    frame, channel = 1, 17
    d3, d2 = bands.d3[frame, :, channel].double().numpy(), bands.d2[frame, :, channel].double().numpy()
    zero = [tuple(np.zeros((3, SIZE >> level, SIZE >> level))) for level in (2, 1)]
    coefficients = [bands.ll[frame, channel].double().numpy(), tuple(d3), tuple(d2), *zero]
    image = pywt.waverec2(coefficients, "bior4.4", mode="periodization")
    expected = image.reshape(-1)[valid_texels()] + student.static[channel].double().numpy()
    found = student.texture(bands)[frame, :, channel].numpy()
    assert np.abs(found - expected).max() < 100 * FLOAT32 * np.abs(image).max()


def test_descriptors_are_normalised_before_the_first_layer() -> None:
    student = random_student()
    descriptors = torch.randn(4, INPUTS, generator=torch.Generator().manual_seed(0))
    inputs = (descriptors - student.mean) / student.scale
    assert torch.equal(student.coefficients(descriptors)[0].flat(), student.geometry.mlp(inputs))
    assert student.mesh(descriptors).shape == (4, VERTICES, 3)


def test_all_channels_are_geometry_then_appearance() -> None:
    student = random_student()
    descriptors = torch.randn(2, INPUTS, generator=torch.Generator().manual_seed(0))
    bands, geometry = student.predict(descriptors), student.geometry(student.normalize(descriptors))
    assert bands.ll.shape[1] == CHANNELS
    assert torch.equal(bands.of(GEOMETRY).d3, geometry.d3)


def test_mean_lowpass_is_the_texture_of_zero_coefficients() -> None:
    student = random_student()
    zero = tuple(
        branch.split(torch.zeros(1, branch.channels * branch.ranks.total))
        for branch in (student.geometry, student.appearance)
    )
    texture = student.texture(student.synthesize((zero[0], zero[1])))[0].T
    assert torch.allclose(student.mean_lowpass(), texture - student.static, atol=100 * FLOAT32)


def parameters(settings: Settings, *, vertices: int, texels: int, encoding: PoseEncoding) -> int:
    """Stored numbers of a student, counted from its own tensors without allocating them."""
    with torch.device("meta"):
        student = Student(
            settings,
            encoding=encoding,
            vertices=vertices,
            texels=torch.zeros(texels, dtype=torch.long),
            wavelet="bior4.4",
        )
    return sum(tensor.numel() for tensor in student.state_dict().values() if tensor.is_floating_point())


def test_the_papers_setting_fits_the_papers_parameter_count() -> None:
    encoding = PoseEncoding(joints=tuple(range(1, 61)), rate=30.0)
    # 5,514 template vertices, 300 K splats (paper) and a skeleton of 60 encoded joints
    assert parameters(preset("paper"), vertices=5514, texels=300_000, encoding=encoding) <= 26.67e6


def test_mlps_have_two_hidden_layers() -> None:
    widths = [layer.out_features for layer in build_mlp(3, 5, 2) if isinstance(layer, torch.nn.Linear)]
    assert widths == [5, 5, 2]


@pytest.mark.parametrize("settings", PRESETS.values(), ids=PRESETS)
def test_preset_sizes_halve_four_times(settings: Settings) -> None:
    assert settings.texels % 16 == 0


def test_rejects_an_unknown_preset() -> None:
    with pytest.raises(InputError, match="'huge' is unknown, expected one of tiny, preview, paper"):
        preset("huge")
