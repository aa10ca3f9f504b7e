"""The student's sizes and mean texture; test_export.py and test_distil.py hold its forward pass against decode()."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from synthetic_student import random_student

from mua.pose.descriptor import groups_of
from mua.pose.encoding import PoseEncoding
from mua.student.model import Student, build_mlp
from mua.student.settings import PAPER_SIZES, PRESETS, Settings, preset

FLOAT32 = float(np.finfo(np.float32).eps)


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
            inputs=encoding.width,
            vertices=vertices,
            texels=torch.zeros(texels, dtype=torch.long),
            wavelet="bior4.4",
        )
    held = {name: tensor.numel() for name, tensor in student.state_dict().items() if tensor.is_floating_point()}
    groups = groups_of(encoding)
    held["directions"] = sum(int((groups == group).sum()) ** 2 for group in set(groups))  # the others are 0
    return sum(held.values())


def test_the_papers_setting_fits_the_papers_parameter_count() -> None:
    encoding = PoseEncoding(joints=tuple(range(1, 61)), rate=30.0)
    # 5,514 template vertices, 300 K splats (paper) and a skeleton of 60 encoded joints
    settings = replace(preset("paper"), **vars(PAPER_SIZES))
    assert parameters(settings, vertices=5514, texels=300_000, encoding=encoding) <= 26.67e6


def test_mlps_have_two_hidden_layers() -> None:
    widths = [layer.out_features for layer in build_mlp(3, 5, 2) if isinstance(layer, torch.nn.Linear)]
    assert widths == [5, 5, 2]


@pytest.mark.parametrize("settings", PRESETS.values(), ids=PRESETS)
def test_preset_sizes_halve_four_times(settings: Settings) -> None:
    assert settings.texels % 16 == 0
