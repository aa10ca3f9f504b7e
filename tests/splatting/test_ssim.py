"""The likeness that trainings descend, against torchmetrics."""

import pytest
import torch
from torchmetrics.functional.image import structural_similarity_index_measure

from mua.splatting.ssim import structural_similarity

BOUND = 1e-4  # rounding of float32; SSIM divides variances as small as 1e-4, which are differences of squares


def pictures(height: int, width: int) -> tuple[torch.Tensor, torch.Tensor]:
    generator = torch.Generator().manual_seed(height)
    truth = torch.rand(height, width, 3, generator=generator)
    return (truth + 0.2 * torch.randn(height, width, 3, generator=generator)).clamp(0, 1), truth


@pytest.mark.parametrize(("height", "width"), [(31, 40), (11, 17)])
def test_ssim_is_that_of_torchmetrics(height: int, width: int) -> None:
    image, truth = pictures(height, width)
    one, other = (picture.permute(2, 0, 1)[None] for picture in (image, truth))
    wanted = structural_similarity_index_measure(one, other, data_range=1.0)
    assert isinstance(wanted, torch.Tensor)
    assert float(structural_similarity(image, truth)) == pytest.approx(float(wanted), abs=BOUND)


def test_ssim_of_a_picture_with_itself_is_one_at_any_size() -> None:
    for size in ((1, 1), (3, 20), (5, 20), (12, 12)):
        image, _ = pictures(*size)
        assert float(structural_similarity(image, image)) == pytest.approx(1, abs=BOUND)


def test_ssim_can_be_descended() -> None:
    image, truth = pictures(20, 20)
    image.requires_grad_(True)
    before = structural_similarity(image, truth)
    (gradient,) = torch.autograd.grad(before, image)
    assert structural_similarity(image + gradient, truth) > before
